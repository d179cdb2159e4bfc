#include "lichtveld/lightfield/links.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/convergence.hpp"
#include "links/gather.hpp"
#include "links/kept_links.hpp"
#include "passes/brdf.hpp"
#include "passes/tone_map.hpp"

namespace lichtveld::lightfield {

namespace {

// Bounces without progress after which the bound is as low as it gets.
constexpr std::uint32_t patience = 8;

float highest_albedo(const gpu::Device& device, const LightMap& map) {
  float highest = 0;
  for (const auto& a : gpu::download<glm::vec4>(device, map.albedo))
    highest = std::max({highest, a.r, a.g, a.b});
  return highest;
}

}  // namespace

struct Links::Parts {
  Parts(const gpu::Device& device, const scene::Scene& scene, const Settings& settings)
      : device(device),
        settings(settings),
        links(device, scene, settings, times),
        brdf(device),
        tone_map(device),
        albedo(highest_albedo(device, links.map())),
        gather(device, links.table()) {}

  const gpu::Device& device;
  const Settings settings;
  gpu::PassTimes times;
  KeptLinks links;
  Brdf brdf;
  ToneMap tone_map;
  float albedo;  // the highest of the scene
  Gather gather;
  bool lit = false;             // there is light to start from
  bool stepped = false;         // the links have changed since the last bounce
  std::uint32_t next_part = 0;  // of the directions, to bounce over
  Solution solution;            // of the last solve or update

  void link(const std::vector<glm::vec3>& to);
  void start();
  void bounce();
  void part_bounce();
  void converge(const std::function<bool(std::uint32_t)>& enough);
  void present();
};

Links::Links(const gpu::Device& device, const scene::Scene& scene, const Settings& settings) {
  check_on(device, settings);
  parts_ = std::make_unique<Parts>(device, scene, settings);
}

Links::~Links() = default;

Solution Links::solve(const std::vector<glm::vec3>& offsets) {
  Parts& parts = *parts_;
  parts.link(offsets);
  Solution& solution = parts.solution;
  solution.bounces = 0;
  parts.converge([](std::uint32_t) { return false; });
  if (solution.bounces == most_bounces && !parts.settings.bounces) warn_of_no_bound(solution);
  solution.error_estimate = split_half_error(parts.device, parts.links.map());
  parts.present();
  return solution;
}

Solution Links::update(const std::vector<glm::vec3>& offsets,
                       const std::function<bool(std::uint32_t)>& enough) {
  Parts& parts = *parts_;
  Solution& solution = parts.solution;
  solution.bounces = 0;
  if (offsets == parts.links.offsets() && solution.settled) return solution;
  parts.link(offsets);
  parts.converge(enough);
  parts.present();
  return solution;
}

LinkCheck Links::check(std::uint32_t pairs) {
  return parts_->links.check(pairs);
}

std::vector<glm::vec4> Links::irradiance() {
  return gpu::download<glm::vec4>(parts_->device, parts_->links.map().total_irradiance);
}

std::vector<std::uint8_t> Links::presented() {
  return download_presented(parts_->device, parts_->links.map());
}

const gpu::PassTimes& Links::times() const {
  return parts_->times;
}

void Links::Parts::link(const std::vector<glm::vec3>& to) {
  if (to == links.offsets()) return;
  solution.settled = false;
  links.link(to, solution);
  stepped = true;
}

void Links::Parts::start() {
  gpu::Frame frame(device, times);
  gather.start(frame, links);
  frame.submit_and_wait();
  lit = true;
}

void Links::Parts::bounce() {
  gpu::Frame frame(device, times);
  gather.bounce(frame, links);
  frame.submit_and_wait();
  ++solution.bounces;
  const auto change = gather.change(links.table());
  solution.residual = bound_on_missing(change.most, albedo, change.mean);
}

// What serve shows while things move: direct light as it is, and a bounce over a part of the directions, which
// leaves of the others what surfaces reflected some steps ago. It says nothing about what is missing.
void Links::Parts::part_bounce() {
  const auto parts = static_cast<std::uint32_t>(settings.step_bounces * shaders::PARTS);
  gpu::Frame frame(device, times);
  gather.part_bounce(frame, links, next_part, parts);
  frame.submit_and_wait();
  next_part = (next_part + parts) % shaders::PARTS;
  solution.residual = std::numeric_limits<double>::infinity();
  ++solution.bounces;
}

// As many bounces as are asked for; or until the bound is met, or falls no more, for rounding.
void Links::Parts::converge(const std::function<bool(std::uint32_t)>& enough) {
  if (settings.bounces) {
    links.sum_direct();
    start();
    while (solution.bounces < *settings.bounces) bounce();
    solution.settled = true;
    return;
  }
  const bool step = std::exchange(stepped, false) && lit;
  if (!lit) start();
  const auto asked = step ? static_cast<std::uint32_t>(settings.step_bounces) : 0;
  if (step && settings.step_bounces < 1) part_bounce();
  while (solution.bounces < asked) bounce();
  if (solution.bounces > 0 && enough(solution.bounces)) return;
  links.sum_direct();
  double least = std::numeric_limits<double>::infinity();
  std::uint32_t since = 0;
  do {
    bounce();
    since = solution.residual < least ? 0 : since + 1;
    least = std::min(least, solution.residual);
    solution.settled = solution.residual < converged || since == patience || solution.bounces == most_bounces;
  } while (!solution.settled && !enough(solution.bounces));
}

void Links::Parts::present() {
  gpu::Frame frame(device, times);
  brdf.record(frame, links.map());
  links.find_shown(frame);
  tone_map.record(frame, links.map());
  frame.submit_and_wait();
}

}  // namespace lichtveld::lightfield
