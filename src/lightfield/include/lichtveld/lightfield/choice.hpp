// Which engine and how fine a light map, where nobody says: by what the device is, and by short trials on it.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <span>

#include "lichtveld/gpu/device.hpp"
#include "lichtveld/lightfield/engine.hpp"
#include "lichtveld/lightfield/settings.hpp"
#include "lichtveld/scene/scene.hpp"

namespace lichtveld::lightfield {

// Of these engines, in the order of engines(), the best one: the last on a CPU, or the only one; on a GPU the
// one whose error falls fastest with time, by a small light map and a step of the first movable body. Throws as
// Engine::make, and std::invalid_argument for none.
const Engine& suited(std::span<const Engine* const> engines, const gpu::Device& device,
                     const scene::Scene& scene, const Settings& settings);

// The same, but tried whatever the device is.
const Engine& tried(std::span<const Engine* const> engines, const gpu::Device& device,
                    const scene::Scene& scene, const Settings& settings);

struct Quality {
  std::uint32_t size, psf;  // as in Settings
  bool operator==(const Quality&) const = default;
};

// What a light map of some quality is expected to be.
struct Expectation {
  Quality quality;
  double error;                // rel_rmse of E as it is seen, between texels too
  double error_of_directions;  // its part that more of them lessen
  double first_ms, step_ms;    // all of its light afresh; and after a move of the first movable body
};

// What an engine's light maps of a scene cost and how far off they are, from trials of a few small ones on this
// device. Time is taken for a + b size^2 + c size^2 psf; the squares of errors add up: of the
// directions, by Solution::error_estimate, and of the texels, by what a map says of a finer one's.
class Forecast {
 public:
  // `fixed`: a size or a number of directions that is not to be chosen. Trials end early once stopped() is
  // true, or where they take long. Throws as Engine::make.
  struct Fixed {
    std::optional<std::uint32_t> size = {}, psf = {};
  };
  Forecast(const Engine& engine, const gpu::Device& device, const scene::Scene& scene, const Settings& settings,
           const Fixed& fixed, const std::function<bool()>& stopped);

  Expectation of(const Quality& quality) const;

  // The least error of all whose step takes at most so long; the quickest one if none does. Is tried before it
  // is taken, for its true time.
  Expectation finest_within(std::chrono::milliseconds step);
  // The quickest first map whose error is at most that; the least error if none is so exact. What does not fit
  // into memory is left out, here and above; throws as Engine::make if nothing fits.
  Expectation quickest_for(double error);

  // The light field of that quality if it was the last to be tried, so that none has to be made again: its
  // light is known where the trial ended. Else none.
  std::unique_ptr<LightField> take(const Quality& quality);

 private:
  struct Trial;
  struct Cost {
    double constant = 0, of_texels = 0, of_links = 0;  // [ms]
    double at(const Quality& quality) const;
  };

  std::vector<Expectation> all() const;  // to choose from, the least error first
  Trial try_out(const Quality& quality);
  std::vector<Trial> try_all();
  double step_tried(const Quality& quality);
  static Cost fit(std::span<const Trial> trials, double Trial::*time);

  const Engine& engine_;
  const gpu::Device& device_;
  const scene::Scene& scene_;
  const Settings settings_;
  const std::function<bool()> stopped_;
  std::vector<Quality> choices_;
  Cost first_, step_;
  double error_of_directions_ = 0;     // at directions_tried_
  double falls_by_ = 0.5;              // its power of their number
  double error_of_texels_ = 0;         // at size_tried_
  std::unique_ptr<LightField> light_;  // of the last trial
  Quality light_quality_ = {};
  double light_step_ms_ = 0;
};

}  // namespace lichtveld::lightfield
