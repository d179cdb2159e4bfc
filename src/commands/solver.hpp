// The methods that run on a device, behind one interface: serve and bench take any.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "lichtveld/gpu/frame.hpp"
#include "lichtveld/lightfield/links.hpp"
#include "options.hpp"

namespace lichtveld::commands {

class Solver {
 public:
  virtual ~Solver() = default;

  // Computes E with body i shifted by offsets[i] [m], one entry a body.
  virtual lightfield::Solution solve(const std::vector<glm::vec3>& offsets) = 0;

  // The next light map of a room where things move: as solve(), or, where a method keeps what it knows, with as
  // many bounces as it takes to settle or until enough(bounces so far).
  using Enough = std::function<bool(std::uint32_t)>;
  virtual lightfield::Solution update(const std::vector<glm::vec3>& offsets, const Enough&) {
    return solve(offsets);
  }

  // As Links::check(); nothing where no links are kept.
  virtual lightfield::LinkCheck check_links(std::uint32_t) { return {}; }

  virtual std::vector<glm::vec4> irradiance() = 0;    // after solve()
  virtual std::vector<std::uint8_t> presented() = 0;  // the same, tone-mapped: sRGB RGBA
  virtual const gpu::PassTimes& times() const = 0;    // since the start
};

// What bench compares with the reference, the published method first: the others are measured against it.
const std::vector<Method>& device_methods();

// The device and the scene must outlive it.
std::unique_ptr<Solver> make_solver(Method method, const gpu::Device& device, const scene::Scene& scene,
                                    const lightfield::Settings& settings);

}  // namespace lichtveld::commands
