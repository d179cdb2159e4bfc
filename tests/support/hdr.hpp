// Skies as Radiance pictures, written without runs.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <sstream>
#include <string>

namespace lichtveld::testing {

inline std::string hdr(int width, int height, const std::function<glm::vec3(int column, int row)>& radiance) {
  std::ostringstream head;
  head << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " << height << " +X " << width << "\n";
  std::string file = head.str();
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column) {
      const glm::vec3 colour = radiance(column, row);
      int exponent = 0;
      const float most = std::max({colour.r, colour.g, colour.b});
      const float scale = most > 0 ? std::frexp(most, &exponent) * 256 / most : 0;
      for (int channel = 0; channel < 3; ++channel)
        file += static_cast<char>(static_cast<std::uint8_t>(colour[channel] * scale));
      file += static_cast<char>(most > 0 ? exponent + 128 : 0);
    }
  return file;
}

}  // namespace lichtveld::testing
