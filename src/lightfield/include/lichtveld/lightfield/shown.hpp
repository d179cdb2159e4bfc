// What players see of a room's light.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

namespace lichtveld::lightfield {

// How a map's exposure follows its light, as an eye does. A map's own exposure has the log-average of its
// luminances become middle grey, and its brightest white.
struct Adaptation {
  // What is kept of the exposure of the map before where this one is brighter or darker, 0..1: exp(-time since
  // it / time constant). 0: each map has its own.
  float brighter = 0, darker = 0;
  std::optional<float> fixed = {};  // the luminance that is middle grey, whatever the light [W m^-2 sr^-1]
};

// A map of size * size texels, row 0 on top, in one of these formats.
struct Shown {
  enum class Format {
    srgb8,  // tone-mapped L, sRGB, RGBA of 8 bits each; gutters filled from their charts, black beyond them
  };
  Format format = Format::srgb8;
  std::uint32_t size = 0;
  std::vector<std::uint8_t> bytes = {};
  float average = 1, white = 1;  // the luminances that are shown as middle grey and as white [W m^-2 sr^-1]
  bool adapted = true;           // another map of the same light would have the same exposure
};

// What a radiance looks like there, as sRGB of 0..1: the same operator as of the pass tone_map.
glm::vec3 displayed(const glm::vec3& radiance, const Shown& shown);

}  // namespace lichtveld::lightfield
