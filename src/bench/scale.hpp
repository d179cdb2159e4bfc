// What light maps cost by how many triangles a room has, and by how many cores there are.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lichtveld/gpu/device.hpp"

namespace lichtveld::bench {

struct ScaleRow {
  std::uint32_t triangles, cores;
  double load_ms, first_ms;    // from the file to a checked scene; from there to all of its light
  double cube_ms, ball_ms;     // medians: a step of a body of 12 triangles, and of one of 5,000
  std::uint64_t resident_mib;  // of the process, then
};

// Of rays as bake has them by default.
std::vector<ScaleRow> time_scale(const gpu::Device& device, std::uint32_t size);

std::string scale_csv(const std::vector<ScaleRow>& rows);
std::string scale_text(const std::vector<ScaleRow>& rows);

}  // namespace lichtveld::bench
