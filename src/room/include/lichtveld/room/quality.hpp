// The finest light map that a machine can renew often enough.
#pragma once

#include <chrono>
#include <functional>

#include "lichtveld/gpu/device.hpp"
#include "lichtveld/lightfield/engine.hpp"
#include "lichtveld/scene/scene.hpp"

namespace lichtveld::room {

// Times what a step of the first movable body costs from coarse to fine on this device, by that engine, and
// returns `settings` with the size and PSFs of the finest one that takes at most `budget`; the coarsest one if
// none does. Ends early once stopped() is true.
lightfield::Settings finest_within(std::chrono::milliseconds budget, const lightfield::Engine& engine,
                                   const gpu::Device& device, const scene::Scene& scene,
                                   lightfield::Settings settings, const std::function<bool()>& stopped);

}  // namespace lichtveld::room
