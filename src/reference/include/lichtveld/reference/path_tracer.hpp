// --method reference: the irradiance of every texel by unbiased path tracing on the CPU. It is the truth that
// the other methods are measured against, and the traditional ray tracing that they are compared with.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "lichtveld/scene/scene.hpp"

namespace lichtveld::reference {

struct Settings {
  std::uint32_t size = 256;                   // atlas, texels a side: 16..4096
  std::optional<std::uint32_t> bounces = {};  // path segments up to the texel, 1 = direct light; empty: all
  std::uint32_t spp = 256;                    // paths a texel: 1..1000000; powers of two from 16 on do best
  std::uint64_t seed = 0;                     // the same seed gives the same bits on any number of threads
  std::uint32_t threads = 0;                  // 0: all cores
};

// size * size texels, row 0 on top.
struct Irradiance {
  std::vector<glm::vec4> texels;      // rgb: E [W m^-2]; a: 1 on valid texels; all 0 elsewhere
  std::vector<float> standard_error;  // of the mean of E's channels [W m^-2]; infinite with a single path
  std::uint32_t texels_valid = 0;
  std::uint64_t rays = 0, misses = 0;  // cosine-distributed ones from texels; those that hit nothing
};

// Throws std::invalid_argument that names the setting out of its range and the range.
void check(const Settings& settings);

// E with body i shifted by offsets[i] [m]; bodies without an offset have not moved. Throws
// std::invalid_argument for settings out of their ranges or offsets that are not finite, and std::runtime_error
// if the scene does not fit into memory.
Irradiance trace(const scene::Scene& scene, const std::vector<glm::vec3>& offsets, const Settings& settings);

}  // namespace lichtveld::reference
