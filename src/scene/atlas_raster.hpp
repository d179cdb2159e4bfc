// The charts on a raster by the rules of graphics hardware, so that exactly those texels are valid that
// geometry_texture draws: corners snapped to 1/256 texel, and a centre that lies on an edge belongs to the
// triangle below or to the right of it (the top-left rule).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <utility>

namespace lichtveld::scene {

constexpr std::int64_t subtexels = 256;

struct Snapped {
  std::int64_t x, y;  // 1/256 texel
};

inline Snapped snapped(glm::vec2 atlas, std::uint32_t size) {
  const glm::dvec2 at = glm::dvec2(atlas) * (static_cast<double>(size) * subtexels);
  return {std::llround(at.x), std::llround(at.y)};
}

// Twice the area of (a, b, p): positive where p lies to the right of a -> b on a raster whose y points down.
inline std::int64_t edge(const Snapped& a, const Snapped& b, const Snapped& p) {
  return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

// Of a triangle that runs clockwise on the raster: a top edge runs right, a left one up.
inline bool is_top_left(const Snapped& a, const Snapped& b) {
  return a.y == b.y ? b.x > a.x : b.y < a.y;
}

inline bool covers(const std::array<Snapped, 3>& p, const Snapped& centre) {
  for (std::size_t k = 0; k < 3; ++k) {
    const Snapped &a = p[k], &b = p[(k + 1) % 3];
    const std::int64_t side = edge(a, b, centre);
    if (side < 0 || (side == 0 && !is_top_left(a, b))) return false;
  }
  return true;
}

// The texels whose centres can lie between two snapped coordinates, as [begin, end).
inline std::pair<std::int64_t, std::int64_t> centres_between(std::int64_t low, std::int64_t high,
                                                             std::uint32_t size) {
  const auto begin = std::clamp<std::int64_t>(low / subtexels - 1, 0, size);
  return {begin, std::clamp<std::int64_t>(high / subtexels + 1, begin, size)};
}

// Of these columns those in which a triangle that runs clockwise can hold a centre of the row at `y`, as
// [begin, end): a sliver from corner to corner has few of them, and there may be millions.
inline std::pair<std::int64_t, std::int64_t> columns_at(const std::array<Snapped, 3>& p, std::int64_t y,
                                                        std::int64_t begin, std::int64_t end) {
  auto low = static_cast<double>(begin), high = static_cast<double>(end);
  for (std::size_t k = 0; k < 3; ++k) {
    const Snapped &a = p[k], &b = p[(k + 1) % 3];
    if (a.y == b.y) continue;
    const auto rise = static_cast<double>(b.y - a.y);
    const double x =
        static_cast<double>(a.x) + static_cast<double>(b.x - a.x) * static_cast<double>(y - a.y) / rise;
    // A column more on either side, for what is rounded.
    if (rise > 0)
      high = std::min(high, std::floor(x / subtexels) + 2);
    else
      low = std::max(low, std::floor(x / subtexels) - 1);
  }
  if (!(low < high)) return {begin, begin};
  return {static_cast<std::int64_t>(low), static_cast<std::int64_t>(high)};
}

// Calls each(column, row) for the texels of an atlas of size * size whose centres a chart's triangle holds.
template <typename Each>
void for_texels(const std::array<glm::vec2, 3>& uv, std::uint32_t size, const Each& each) {
  std::array<Snapped, 3> p;
  for (std::size_t k = 0; k < 3; ++k) p[k] = snapped(uv[k], size);
  const std::int64_t area = edge(p[0], p[1], p[2]);
  const glm::dvec2 a = glm::dvec2(uv[1]) - glm::dvec2(uv[0]), b = glm::dvec2(uv[2]) - glm::dvec2(uv[0]);
  if (area == 0 || a.x * b.y == a.y * b.x) return;
  if (area < 0) std::swap(p[1], p[2]);
  const auto [left, right] = std::minmax({p[0].x, p[1].x, p[2].x});
  const auto [top, bottom] = std::minmax({p[0].y, p[1].y, p[2].y});
  const auto [first_row, end_row] = centres_between(top, bottom, size);
  const auto [first_column, end_column] = centres_between(left, right, size);
  for (std::int64_t j = first_row; j < end_row; ++j) {
    const std::int64_t y = j * subtexels + subtexels / 2;
    const auto [begin, end] = columns_at(p, y, first_column, end_column);
    for (std::int64_t i = begin; i < end; ++i)
      if (covers(p, {i * subtexels + subtexels / 2, y}))
        each(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j));
  }
}

}  // namespace lichtveld::scene
