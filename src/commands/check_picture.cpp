// The atlas as a picture.
#include <algorithm>
#include <array>
#include <cmath>

#include "check.hpp"

namespace lichtveld::commands {

namespace {

using Colour = std::array<std::uint8_t, 3>;

constexpr Colour nothing = {24, 24, 24}, shared = {255, 0, 0}, without_texel = {255, 255, 255};

// Smaller atlases are enlarged up to this [pixels a side].
constexpr std::uint32_t legible = 1024;
// Texels of so many pixels get a darker edge, so that they can be counted.
constexpr std::uint32_t with_edges = 4;

// Neighbours in number differ most, by the golden ratio; none is red or white.
Colour colour_of(std::uint32_t chart) {
  const double turn = std::fmod(chart * 0.6180339887498949, 1.0),
               dim = std::fmod(chart * 0.7548776662466927, 1.0);
  const double hue = 40 + 260 * turn, value = 0.55 + 0.4 * dim, saturation = 0.6;  // hue [degrees]
  Colour colour;
  for (std::size_t channel = 0; channel < 3; ++channel) {
    const double k = std::fmod(5 - 2 * static_cast<double>(channel) + hue / 60, 6.0);
    const double share = std::clamp(std::min(k, 4 - k), 0.0, 1.0);
    colour[channel] = static_cast<std::uint8_t>(std::lround(255 * value * (1 - saturation * share)));
  }
  return colour;
}

}  // namespace

Picture picture_of(const scene::AtlasFacts& atlas) {
  const std::uint32_t times = std::max(1u, legible / atlas.size), side = times * atlas.size;
  Picture picture{.size = side, .rgba = std::vector<std::uint8_t>(std::size_t{4} * side * side, 255)};
  const auto put = [&](std::int64_t x, std::int64_t y, const Colour& colour) {
    if (x < 0 || y < 0 || x >= side || y >= side) return;
    std::ranges::copy(colour, picture.rgba.begin() + 4 * (y * side + x));
  };
  for (std::uint32_t y = 0; y < side; ++y)
    for (std::uint32_t x = 0; x < side; ++x) {
      const std::size_t texel = std::size_t{y / times} * atlas.size + x / times;
      const std::uint32_t chart = atlas.chart_of[texel];
      Colour colour = atlas.shared.at[texel]                 ? shared
                      : chart == scene::AtlasFacts::no_chart ? nothing
                                                             : colour_of(chart);
      if (times >= with_edges && chart != scene::AtlasFacts::no_chart && (x % times == 0 || y % times == 0))
        for (auto& channel : colour) channel = static_cast<std::uint8_t>(channel * 3 / 4);
      put(x, y, colour);
    }
  // A frame round each chart that would not be seen.
  for (const auto& at : atlas.without_texel) {
    const auto x = static_cast<std::int64_t>(at.x * static_cast<float>(side)),
               y = static_cast<std::int64_t>(at.y * static_cast<float>(side));
    for (std::int64_t i = -2; i <= 2; ++i)
      for (const std::int64_t j : {-2, 2}) put(x + i, y + j, without_texel), put(x + j, y + i, without_texel);
  }
  return picture;
}

}  // namespace lichtveld::commands
