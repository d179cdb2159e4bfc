#include "lichtveld/lightfield/settings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include "lichtveld/lightfield/directions.hpp"

namespace lichtveld::lightfield {

namespace {
constexpr int most_step_bounces = 100;
constexpr std::array parts_of_a_bounce = {0.125f, 0.25f, 0.5f};
}  // namespace

void check(const Settings& settings) {
  if (settings.size < 16 || settings.size > 4096)
    throw std::invalid_argument("a size of " + std::to_string(settings.size) +
                                " texels: it must lie in 16..4096");
  if (settings.psf_size != 0 && (settings.psf_size < 16 || settings.psf_size > 8192))
    throw std::invalid_argument("a PSF raster of " + std::to_string(settings.psf_size) +
                                " pixels: it must lie in 16..8192, or be 0: as fine as the atlas");
  directions(settings.psf);
  if (settings.layers < 1 || settings.layers > most_layers)
    throw std::invalid_argument(std::to_string(settings.layers) + " layers: there must be 1.." +
                                std::to_string(most_layers));
  if (std::ranges::count(parts_of_a_bounce, settings.step_bounces) == 0 &&
      !(settings.step_bounces >= 1 && settings.step_bounces <= most_step_bounces &&
        settings.step_bounces == std::floor(settings.step_bounces)))
    throw std::invalid_argument(
        std::to_string(settings.step_bounces) +
        " bounces a step: there must be 0.125, 0.25, 0.5 or a whole number of them, up to " +
        std::to_string(most_step_bounces));
  if (settings.bounces == 0u)
    throw std::invalid_argument("0 bounces: 1 is direct light alone, 2 adds one reflection");
}

}  // namespace lichtveld::lightfield
