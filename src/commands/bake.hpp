// What the methods of `lichtveld bake` share.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "options.hpp"

namespace lichtveld::commands {

struct BakeOptions {
  std::string scene, out, png, report, dump;
  std::uint32_t dump_psf = 0;
  std::vector<std::string> moves;
  bool live = false;
  Method method = Method::links;
  gpu::DeviceOptions device;
  lightfield::Settings settings;
  std::uint32_t spp = 256;  // of the reference
};

// A scene and where its movable nodes are to go, in order.
struct BakeJob {
  scene::Scene scene;
  struct NodeMove {
    std::uint32_t body;
    glm::vec3 by;  // [m]
  };
  std::vector<NodeMove> moves;

  std::vector<glm::vec3> at_rest() const { return std::vector<glm::vec3>(scene.bodies.size(), glm::vec3(0)); }
  std::vector<glm::vec3> moved() const;  // every move made
};

struct Baked {
  std::vector<glm::vec4> irradiance;
  std::vector<std::uint8_t> presented;  // sRGB RGBA; empty unless options.png asks for it
  nlohmann::ordered_json report;
};

Baked bake_links(const BakeOptions& options, const BakeJob& job);
Baked bake_thesis(const BakeOptions& options, const BakeJob& job);
Baked bake_reference(const BakeOptions& options, const BakeJob& job);

}  // namespace lichtveld::commands
