#include "atlas_packing.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace lichtveld::scene {
namespace {

constexpr std::uint32_t largest_atlas = 4096;

std::vector<Rectangle> rectangles_of(const std::vector<Spot>& spots, double density, std::uint32_t size) {
  std::vector<Rectangle> rectangles;
  const auto texels = [&](double metres) {
    const double wanted = std::round(metres * density);
    return static_cast<std::uint32_t>(std::clamp(wanted, 1.0, 2.0 * size)) + gutter;
  };
  for (const auto& spot : spots)
    rectangles.push_back(
        {texels(spot.chart->extent.x * spot.scale), texels(spot.chart->extent.y * spot.scale)});
  return rectangles;
}

bool fit(const std::vector<Spot>& spots, double density, Atlas& atlas) {
  auto rectangles = rectangles_of(spots, density, atlas.size);
  if (!pack(rectangles, atlas.size)) return false;
  atlas.density = density;
  atlas.rectangles = std::move(rectangles);
  return true;
}

}  // namespace

Atlas packed(const std::vector<Spot>& spots, const UnwrapOptions& options) {
  double longest = 0;
  for (const auto& spot : spots)
    longest = std::max({longest, spot.chart->extent.x * spot.scale, spot.chart->extent.y * spot.scale});
  for (Atlas atlas{.size = options.size, .density = 0, .rectangles = {}}; atlas.size <= largest_atlas;
       atlas.size *= 2) {
    if (options.texels_per_metre > 0) {
      if (fit(spots, options.texels_per_metre, atlas)) return atlas;
      continue;
    }
    double low = 0, high = atlas.size / longest;
    if (!fit(spots, low, atlas)) continue;
    constexpr int steps = 20;
    for (int step = 0; step < steps; ++step) {
      const double middle = (low + high) / 2;
      (fit(spots, middle, atlas) ? low : high) = middle;
    }
    return atlas;
  }
  throw SceneError("its " + std::to_string(spots.size()) + " charts find no room in an atlas of " +
                   std::to_string(largest_atlas) + " x " + std::to_string(largest_atlas) +
                   " texels: simplify it" +
                   (options.texels_per_metre > 0 ? ", or ask for fewer texels a metre" : ""));
}

glm::vec2 in_atlas(const Chart& chart, const Rectangle& rectangle, const glm::dvec2& place,
                   std::uint32_t size) {
  const glm::dvec2 texels(rectangle.width - gutter, rectangle.height - gutter);
  const glm::dvec2 corner = glm::dvec2(rectangle.x, rectangle.y) + double{gutter} / 2;
  glm::dvec2 share(0.5);
  for (int axis = 0; axis < 2; ++axis)
    if (chart.extent[axis] > 0) {
      share[axis] = place[axis] / chart.extent[axis];
      if (texels[axis] <= 1)
        share[axis] += 0.5 - (chart.flat[0][0][axis] + chart.flat[0][1][axis] + chart.flat[0][2][axis]) / 3 /
                                 chart.extent[axis];
    }
  return (corner + share * texels) / static_cast<double>(size);
}

double coverage_of(const Atlas& atlas) {
  double filled = 0;
  for (const auto& rectangle : atlas.rectangles)
    filled += static_cast<double>(rectangle.width - gutter) * (rectangle.height - gutter);
  return filled / atlas.size / atlas.size;
}

}  // namespace lichtveld::scene
