// What the command line says of a scene's lights.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "lichtveld/scene/scene.hpp"

namespace lichtveld::commands {

struct LightOptions {
  std::string sky;
  double lumens_per_watt = 1;
  std::vector<std::string> dimmed;  // NAME=SCALE or NAME=R,G,B
};

// --sky and --lumens-per-watt.
void add_light_source_options(CLI::App& command, LightOptions& options);

// These and --light.
void add_light_options(CLI::App& command, LightOptions& options);

// Throws UsageError for what cannot be read.
scene::LoadOptions load_options(const LightOptions& options, const scene::UnwrapOptions& unwrap);

// Throws UsageError for what cannot be read, and as scene::load.
scene::Scene load(const std::string& file, const LightOptions& options, const scene::UnwrapOptions& unwrap);

// By --light; 1 for all others. Throws UsageError, and SceneError for a light that is not there.
scene::Scales scales_of(const scene::Scene& scene, const LightOptions& options);

}  // namespace lichtveld::commands
