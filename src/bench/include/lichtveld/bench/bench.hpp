// Speed against error: every way to compute a light map, timed and compared with the truth; tables and charts
// of it.
#pragma once

#include <string>
#include <vector>

#include "lichtveld/bench/options.hpp"
#include "lichtveld/gpu/device.hpp"
#include "lichtveld/scene/scene.hpp"

namespace lichtveld::bench {

class Bench {
 public:
  // Checks all of it before long work and loads the scenes. Throws std::invalid_argument for settings out of
  // their ranges, scene::SceneError and files::OutputError.
  explicit Bench(Options options);

  // Measures, prints what it finds, and writes it into Options::out.
  void run(const gpu::Device& device) const;

 private:
  struct NamedScene {
    std::string name;
    scene::Scene scene;
  };
  const Options options_;
  std::vector<NamedScene> scenes_;
};

}  // namespace lichtveld::bench
