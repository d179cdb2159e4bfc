// --method thesis: virtual light fields as published. Every PSF is rendered afresh in every bounce.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "lichtveld/gpu/frame.hpp"
#include "lichtveld/lightfield/settings.hpp"
#include "lichtveld/scene/scene.hpp"

namespace lichtveld::lightfield {

// Shows the output of a pass: `stage` is the pass' name, with a suffix where it has several outputs.
using StageObserver = std::function<void(const std::string& stage, const gpu::Image& image)>;

class Thesis {
 public:
  // The device and the scene must outlive it. Throws std::invalid_argument for settings out of their ranges and
  // std::runtime_error if the device cannot hold the images.
  Thesis(const gpu::Device& device, const scene::Scene& scene, const Settings& settings);
  ~Thesis();

  // Computes E with body i shifted by offsets[i] [m]; offsets has one entry a body. With an observer, the
  // outputs of each pass are shown for direction `observed` in the first bounce, and at the end.
  Solution solve(const std::vector<glm::vec3>& offsets, const StageObserver& observer = {},
                 std::uint32_t observed = 0);

  // After solve(). size * size texels, row 0 on top.
  std::vector<glm::vec4> irradiance();    // rgb: E [W m^-2]; a: 1 on valid texels
  std::vector<std::uint8_t> presented();  // tone-mapped L, sRGB RGBA, gutters dilated

  // What the passes have cost since the start, by name.
  const gpu::PassTimes& times() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace lichtveld::lightfield
