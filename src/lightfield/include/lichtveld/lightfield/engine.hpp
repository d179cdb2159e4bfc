// The ways to compute a light field, by name.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "lichtveld/gpu/device.hpp"
#include "lichtveld/lightfield/light_field.hpp"
#include "lichtveld/lightfield/settings.hpp"
#include "lichtveld/scene/scene.hpp"

namespace lichtveld::lightfield {

struct Engine {
  const char* name;     // of --method
  const char* summary;  // what it does, for --help
  std::uint32_t psf;    // directions that serve it best: error for its time
  // The device and the scene must outlive it. Throws std::invalid_argument for settings out of their ranges and
  // std::runtime_error, where it can before anything large is allocated, if the device cannot hold it.
  std::unique_ptr<LightField> (*make)(const gpu::Device& device, const scene::Scene& scene,
                                      const Settings& settings);
};

// The published method first, which the others are measured against; then, on a CPU, ever better ones.
std::span<const Engine> engines();

// Throws std::invalid_argument that lists the names.
const Engine& engine(std::string_view name);

// engine(name).make(..)
std::unique_ptr<LightField> make_light_field(std::string_view name, const gpu::Device& device,
                                             const scene::Scene& scene, const Settings& settings);

}  // namespace lichtveld::lightfield
