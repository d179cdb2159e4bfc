// What the methods of `lichtveld bake` share.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "lichtveld/lightfield/choice.hpp"
#include "lichtveld/lightfield/shown.hpp"
#include "light_options.hpp"
#include "options.hpp"

namespace lichtveld::commands {

struct BakeOptions {
  std::string scene, out, gltf, png, report, dump, lights_apart;
  LightOptions lights;
  bool keep_uv = false;
  std::uint32_t dump_psf = 0;
  std::vector<std::string> moves;
  bool live = false;
  Method method;
  gpu::DeviceOptions device;
  CaptureOptions capture;
  lightfield::Settings settings;
  std::optional<double> error;  // rel_rmse to expect; by a size and directions that are to be chosen,
  lightfield::Forecast::Fixed fixed = {};  // but for these
  std::uint32_t spp = 256;                 // of the reference
};

// A scene and where its movable nodes are to go, in order.
struct BakeJob {
  scene::Scene scene;
  struct NodeMove {
    std::uint32_t body;
    glm::vec3 by;  // [m]
  };
  std::vector<NodeMove> moves;
  scene::Scales scales;  // of its lights, which --live comes to after the moves

  scene::Offsets at_rest() const { return scene::Offsets(scene.bodies.size(), glm::vec3(0)); }
  scene::Offsets moved() const;  // every move made
};

struct Baked {
  std::uint32_t size;  // texels a side
  std::vector<glm::vec4> irradiance;
  std::optional<lightfield::Shown> shown;  // if options.png asks for it
  struct OfLight {
    std::string light;
    std::vector<glm::vec4> irradiance;
  };
  std::vector<OfLight> apart;  // if options.lights_apart asks for them; together they are `irradiance`
  nlohmann::ordered_json report;
};

// By an engine of the light field; by path tracing.
Baked bake_light_field(const BakeOptions& options, const BakeJob& job);
Baked bake_reference(const BakeOptions& options, const BakeJob& job);

}  // namespace lichtveld::commands
