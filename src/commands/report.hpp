// What a bake says of itself, as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "lichtveld/gpu/device.hpp"
#include "lichtveld/lightfield/light_field.hpp"
#include "lichtveld/lightfield/settings.hpp"

namespace lichtveld::commands {

nlohmann::ordered_json report(const gpu::Device& device, const std::string& method,
                              const lightfield::Settings& settings, const lightfield::Solution& solution,
                              const gpu::Times& times, double total_ms);

}  // namespace lichtveld::commands
