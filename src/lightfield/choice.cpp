#include "lichtveld/lightfield/choice.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <stdexcept>
#include <vector>

#include "lichtveld/lightfield/directions.hpp"
#include "lichtveld/progress/progress.hpp"
#include "lichtveld/scene/atlas.hpp"
#include "lichtveld/scene/motion.hpp"

namespace lichtveld::lightfield {

namespace {

using Milliseconds = std::chrono::duration<double, std::milli>;

// Trials, cheapest first: one is had with more directions, and that with more texels.
constexpr std::array sizes_tried = {128u, 256u};
constexpr std::array directions_tried = {24u, 96u};
constexpr std::array<Quality, 3> trials_made = {{{sizes_tried[0], directions_tried[0]},
                                                 {sizes_tried[0], directions_tried[1]},
                                                 {sizes_tried[1], directions_tried[1]}}};
// Drivers compile on the first use.
constexpr Quality warm_up{64, 8};
// The next trial, which costs up to four times as much, is left out after one that took so long.
constexpr Milliseconds long_trial(1500);
// To choose from.
constexpr std::array sizes = {64u, 128u, 256u, 512u, 1024u};
constexpr std::array directions = {24u, 96u, 384u, 1536u};
// Where no second size was tried: of a texel's light, at the first.
constexpr double usual_error_of_texels = 0.05;
// The first map of a room that people wait for.
constexpr Milliseconds longest_first(10'000);
// Of what a trial with many directions takes at least so much is theirs, however busy the machine was during
// the other: that more of them cost nothing is never so.
constexpr double least_of_directions = 0.05;
// A choice that takes that much longer than was thought is thought over.
constexpr double allowed_excess = 1.1;

// Four texels of a map around a place of one that is twice as fine, as players' browsers blend them. Nothing
// where not all are valid.
std::optional<glm::vec3> blended(const std::vector<glm::vec4>& map, std::uint32_t size, std::uint32_t fine_x,
                                 std::uint32_t fine_y) {
  const glm::vec2 at = (glm::vec2(fine_x, fine_y) + 0.5f) / 2.0f - 0.5f;
  const glm::vec2 corner = glm::floor(at), share = at - corner;
  glm::vec3 sum(0);
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 2; ++i) {
      const int x = static_cast<int>(corner.x) + i, y = static_cast<int>(corner.y) + j;
      if (x < 0 || y < 0 || x >= static_cast<int>(size) || y >= static_cast<int>(size)) return {};
      const glm::vec4& texel = map[static_cast<std::size_t>(y) * size + static_cast<std::size_t>(x)];
      if (texel.a == 0) return {};
      sum += glm::vec3(texel) * (i == 1 ? share.x : 1 - share.x) * (j == 1 ? share.y : 1 - share.y);
    }
  return sum;
}

// rel_rmse of what a map shows between its texels, by one that is twice as fine.
double error_between(const std::vector<glm::vec4>& map, const std::vector<glm::vec4>& finer,
                     std::uint32_t size) {
  double squares = 0, sum = 0, texels = 0;
  for (std::uint32_t y = 0; y < 2 * size; ++y)
    for (std::uint32_t x = 0; x < 2 * size; ++x) {
      const glm::vec4& truth = finer[std::size_t{y} * 2 * size + x];
      const auto shown = truth.a > 0 ? blended(map, size, x, y) : std::nullopt;
      if (!shown) continue;
      const glm::vec3 apart = *shown - glm::vec3(truth);
      squares += glm::dot(apart, apart) / 3;
      sum += (truth.r + truth.g + truth.b) / 3;
      ++texels;
    }
  return sum > 0 ? std::sqrt(squares * texels) / sum : 0;
}

bool fits(const scene::Scene& scene, std::uint32_t size) {
  try {
    scene::check_atlas(scene, size);
    return true;
  } catch (const scene::SceneError&) {
    return false;
  }
}

}  // namespace

struct Forecast::Trial {
  Quality quality;
  double first_ms, step_ms;
  double error;  // Solution::error_estimate
  std::vector<glm::vec4> irradiance;
};

double Forecast::Cost::at(const Quality& quality) const {
  const double texels = double{1} * quality.size * quality.size;
  return constant + of_texels * texels + of_links * texels * quality.psf;
}

Forecast::Forecast(const Engine& engine, const gpu::Device& device, const scene::Scene& scene,
                   const Settings& settings, const Fixed& fixed, const std::function<bool()>& stopped)
    : engine_(engine), device_(device), scene_(scene), settings_(settings), stopped_(stopped) {
  for (const auto size : sizes)
    for (const auto psf : directions) {
      const Quality choice{fixed.size.value_or(size), fixed.psf.value_or(psf)};
      if (std::ranges::find(choices_, choice) == choices_.end()) choices_.push_back(choice);
    }
  // Charts may overlap where texels are large. If they always do, whoever checks it says so.
  std::map<std::uint32_t, bool> fitting;
  for (const auto& choice : choices_)
    if (!fixed.size && !fitting.contains(choice.size)) fitting[choice.size] = fits(scene, choice.size);
  const auto overlaps = [&](const Quality& choice) {
    return fitting.contains(choice.size) && !fitting[choice.size];
  };
  if (!std::ranges::all_of(choices_, overlaps)) std::erase_if(choices_, overlaps);
  if (!stopped_()) try_out(warm_up);
  auto trials = try_all();
  if (trials.empty())
    trials.push_back({.quality = {1, 1}, .first_ms = 0, .step_ms = 0, .error = 0, .irradiance = {}});
  first_ = fit(trials, &Trial::first_ms);
  step_ = fit(trials, &Trial::step_ms);
  const bool both = trials.size() > 1;
  error_of_directions_ = trials[both ? 1 : 0].error;
  if (!both) error_of_directions_ *= std::sqrt(double{directions_tried[0]} / directions_tried[1]);
  if (both && trials[1].error > 0)
    falls_by_ = std::clamp(std::log(trials[0].error / trials[1].error) /
                               std::log(double{directions_tried[1]} / directions_tried[0]),
                           0.5, 1.0);
  error_of_texels_ = usual_error_of_texels;
  if (trials.size() == trials_made.size()) {
    // Both maps' directions are off by chance, too.
    const double apart = error_between(trials[1].irradiance, trials[2].irradiance, sizes_tried[0]);
    const double chance = trials[1].error * trials[1].error + trials[2].error * trials[2].error;
    error_of_texels_ = std::sqrt(std::max(apart * apart - chance, apart * apart / 16));
  }
}

// Cheapest first, as far as they go.
std::vector<Forecast::Trial> Forecast::try_all() {
  progress::Work work("trials", trials_made.size());
  std::vector<Trial> trials;
  for (const auto& quality : trials_made) {
    if (stopped_() || (!trials.empty() && trials.back().first_ms > long_trial.count())) break;
    try {
      trials.push_back(try_out(quality));
      work.done();
    } catch (const std::runtime_error&) {  // larger ones do not fit either
      break;
    }
  }
  return trials;
}

Forecast::Trial Forecast::try_out(const Quality& quality) {
  light_.reset();  // before another one takes memory
  Settings settings = settings_;
  settings.size = quality.size;
  settings.psf = quality.psf;
  auto start = std::chrono::steady_clock::now();
  const auto took = [&] { return Milliseconds(std::chrono::steady_clock::now() - start).count(); };
  auto light = engine_.make(device_, scene_, settings);
  scene::Offsets offsets(scene_.bodies.size(), glm::vec3(0));
  const double error = light->settle().error_estimate;
  Trial trial{
      .quality = quality, .first_ms = took(), .step_ms = 0, .error = error, .irradiance = light->irradiance()};
  light->shown();
  for (const float way : {1.0f, 2.0f, 3.0f}) {
    if (scene_.bodies.size() == 1) break;  // only what moves is ever renewed
    if (way > 1 && trial.step_ms > long_trial.count()) break;
    offsets[1].x = way * scene::step_length(scene_);
    start = std::chrono::steady_clock::now();
    light->place(offsets);
    light->step([](std::uint32_t) { return true; });
    light->shown();
    trial.step_ms = way > 1 ? std::min(trial.step_ms, took()) : took();
  }
  light_ = std::move(light);
  light_quality_ = quality;
  light_step_ms_ = trial.step_ms;
  return trial;
}

// From trials_made, of which the first alone may have been made, or the first two.
Forecast::Cost Forecast::fit(std::span<const Trial> trials, double Trial::*time) {
  const Quality& least = trials[0].quality;
  const double texels = double{1} * least.size * least.size, a = trials[0].*time;
  if (trials.size() == 1) return {.of_links = a / (texels * least.psf)};
  const double b = trials[1].*time, more_directions = directions_tried[1] - directions_tried[0];
  Cost cost{.of_links =
                std::max((b - a) / more_directions, least_of_directions * b / directions_tried[1]) / texels};
  if (trials.size() == 2) {
    cost.of_texels = std::max(a / texels - cost.of_links * least.psf, 0.0);
    return cost;
  }
  const double more_texels = double{1} * sizes_tried[1] * sizes_tried[1] - texels;
  cost.of_texels = std::max((trials[2].*time - b) / more_texels - cost.of_links * directions_tried[1], 0.0);
  cost.constant = std::max(b - cost.at(trials[1].quality), 0.0);
  return cost;
}

Expectation Forecast::of(const Quality& quality) const {
  const double by_directions =
      error_of_directions_ * std::pow(double{directions_tried[1]} / quality.psf, falls_by_);
  const double by_texels = error_of_texels_ * sizes_tried[0] / quality.size;
  return {.quality = quality,
          .error = std::hypot(by_directions, by_texels),
          .error_of_directions = by_directions,
          .first_ms = first_.at(quality),
          .step_ms = step_.at(quality)};
}

std::vector<Expectation> Forecast::all() const {
  std::vector<Expectation> all;
  for (const auto& choice : choices_) all.push_back(of(choice));
  std::ranges::sort(all, {}, &Expectation::error);
  return all;
}

Expectation Forecast::finest_within(std::chrono::milliseconds step) {
  auto expected = all();
  const double budget = static_cast<double>(step.count());
  const auto in_time = [&](const Expectation& some) {
    return some.step_ms <= budget && some.first_ms <= longest_first.count();
  };
  const auto best = [&] {
    const auto found = std::ranges::find_if(expected, in_time);
    return found != expected.end() ? found : std::ranges::min_element(expected, {}, &Expectation::step_ms);
  };
  std::vector<Quality> tried;
  for (auto found = best();; found = best()) {
    if (stopped_() || std::ranges::find(tried, found->quality) != tried.end()) return *found;
    tried.push_back(found->quality);
    try {
      const double took = step_tried(found->quality), off = took / found->step_ms;
      if (took > budget * allowed_excess)
        for (auto& some : expected)
          if (std::ranges::find(tried, some.quality) == tried.end()) some.step_ms *= off;
      found->step_ms = took;
      if (took <= budget * allowed_excess) return *found;
    } catch (const std::runtime_error&) {  // it does not fit
      if (expected.size() == 1) throw;
      expected.erase(found);
    }
  }
}

// As the light that was made last took, or by another trial.
double Forecast::step_tried(const Quality& quality) {
  if (!light_ || light_quality_ != quality) try_out(quality);
  return light_step_ms_;
}

std::unique_ptr<LightField> Forecast::take(const Quality& quality) {
  return light_ && light_quality_ == quality ? std::move(light_) : nullptr;
}

Expectation Forecast::quickest_for(double error) {
  light_.reset();
  for (auto expected = all();;) {
    // The least error comes first.
    auto best = expected.begin();
    for (auto some = expected.begin(); some != expected.end(); ++some)
      if (some->error <= error && some->first_ms < best->first_ms) best = some;
    try {
      Settings settings = settings_;
      settings.size = best->quality.size;
      settings.psf = best->quality.psf;
      engine_.make(device_, scene_, settings);
      return *best;
    } catch (const std::runtime_error&) {  // it does not fit
      if (expected.size() == 1) throw;
      expected.erase(best);
    }
  }
}

const Engine& suited(std::span<const Engine* const> engines, const gpu::Device& device,
                     const scene::Scene& scene, const Settings& settings) {
  if (engines.empty()) throw std::invalid_argument("no engine to choose from");
  if (engines.size() == 1 || device.summary().type == vk::to_string(vk::PhysicalDeviceType::eCpu))
    return *engines.back();
  return tried(engines, device, scene, settings);
}

const Engine& tried(std::span<const Engine* const> engines, const gpu::Device& device,
                    const scene::Scene& scene, const Settings& settings) {
  if (engines.empty()) throw std::invalid_argument("no engine to choose from");
  const Engine* best = nullptr;
  double least = 0;
  for (const Engine* engine : engines) {
    if (engines.size() > 1 && engine == &lightfield::engines().front()) continue;  // renders all at each step
    const auto expected = [&]() -> std::optional<Expectation> {
      try {
        Forecast forecast(*engine, device, scene, settings, {}, [] { return false; });
        return forecast.of({settings.size, engine->psf});
      } catch (const std::runtime_error& error) {
        spdlog::info("not --method {}: {}", engine->name, error.what());
        return {};
      }
    }();
    if (!expected) continue;
    spdlog::info("--method {}: a step in {:.1f} ms, {:.2g} % off by its directions", engine->name,
                 expected->step_ms, 100 * expected->error_of_directions);
    // Four times the directions halve the error.
    const double merit = expected->step_ms * expected->error_of_directions * expected->error_of_directions;
    if (best != nullptr && merit >= least) continue;
    best = engine;
    least = merit;
  }
  return best != nullptr ? *best : *engines.back();
}

}  // namespace lichtveld::lightfield
