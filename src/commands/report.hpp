// What a bake says of itself, as JSON.
#pragma once

#include <nlohmann/json.hpp>

#include "lichtveld/gpu/frame.hpp"
#include "lichtveld/lightfield/settings.hpp"
#include "options.hpp"

namespace lichtveld::commands {

nlohmann::ordered_json report(const gpu::Device& device, Method method, const lightfield::Settings& settings,
                              const lightfield::Solution& solution, const gpu::PassTimes& times,
                              double total_ms);

}  // namespace lichtveld::commands
