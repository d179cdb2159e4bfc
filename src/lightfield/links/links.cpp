#include "links/links.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "core/convergence.hpp"

namespace lichtveld::lightfield {

Links::Links(const gpu::Device& device, const scene::Scene& scene, const Settings& settings)
    : LightField(scene, settings.direct.value_or(Direct::exact)),
      device_((check_on(device, settings), device)),
      begun_(device.times().so_far()),
      settings_(settings),
      links_(device, scene, settings),
      brdf_(device),
      tone_map_(device),
      over_(device, scene, links_.records()),
      gather_(device, links_.table()) {}

bool Links::compute(Light before, const Moves& moves, const Enough& enough, Solution& solution) {
  if (before == Light::unknown || before == Light::moved) links_.link(offsets(), scales(), moves, solution);
  return converge(before, enough, solution);
}

double Links::error_estimate() const {
  auto half = gpu::download<glm::vec4>(device_, links_.map().half_difference);
  links_.direct().add_half_difference(half);
  return split_half_error(irradiance(), half);
}

void Links::start(Solution& solution) {
  gpu::Frame frame(device_, {"links", "start"});
  gather_.start(frame, links_);
  frame.submit_and_wait();
  if (!links_.direct().is_exact()) return;
  solution.bounces = 1;
  note_change(solution);
}

void Links::bounce(Solution& solution) {
  gpu::Frame frame(device_, {"links", fmt::format("bounce {}", solution.bounces + 1), "all directions"});
  gather_.bounce(frame, links_);
  frame.submit_and_wait();
  ++solution.bounces;
  note_change(solution);
}

void Links::note_change(Solution& solution) const {
  const auto change = gather_.change(links_.table());
  solution.residual = bound_on_missing(change.most, links_.records().highest_albedo(), change.mean);
}

// What players see while things move: direct light as it is, and a bounce over a part of the directions, which
// leaves of the others what surfaces reflected some steps ago. It says nothing about what is missing.
void Links::part_bounce(Solution& solution) {
  const auto parts = static_cast<std::uint32_t>(settings_.links.step_bounces * DirectionSet::parts);
  gpu::Frame frame(device_, {"links", fmt::format("bounce {}", solution.bounces + 1),
                             fmt::format("{} parts of the directions from {}", parts, next_part_)});
  gather_.part_bounce(frame, links_, next_part_, parts);
  frame.submit_and_wait();
  next_part_ = (next_part_ + parts) % DirectionSet::parts;
  solution.residual = std::numeric_limits<double>::infinity();
  ++solution.bounces;
}

// As many bounces as are asked for; or until the bound is met, or falls no more, for rounding. True if that is
// it.
bool Links::converge(Light before, const Enough& enough, Solution& solution) {
  if (settings_.bounces) {
    links_.sum_direct();
    start(solution);
    while (solution.bounces < *settings_.bounces) bounce(solution);
    return true;
  }
  if (before == Light::unknown) start(solution);
  if (before == Light::moved) {
    const auto step_bounces = settings_.links.step_bounces;
    if (step_bounces < 1) part_bounce(solution);
    while (static_cast<float>(solution.bounces) < step_bounces) bounce(solution);
    if (enough(solution.bounces)) return false;
  }
  links_.sum_direct();
  return bounce_until_converged(
      solution, [&] { bounce(solution); }, enough);
}

Shown Links::shown(const Adaptation& adaptation) {
  over_.put(irradiance_view());
  gpu::Frame frame(device_, {"links", "present"});
  brdf_.record(frame, links_.map());
  links_.find_shown(frame);
  tone_map_.record(frame, links_.map(), over_, adaptation);
  frame.submit_and_wait();
  return tone_map_.shown(links_.map());
}

}  // namespace lichtveld::lightfield
