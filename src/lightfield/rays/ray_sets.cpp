#include "rays/ray_sets.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

namespace lichtveld::lightfield {

namespace {

using std::numbers::pi;

// Malley's method over Shirley and Chiu 1997, "A Low Distortion Map Between Disk and Square".
glm::vec3 cosine_distributed(const glm::dvec2& point) {
  const double x = 2 * point.x - 1, y = 2 * point.y - 1;
  const bool wide = std::abs(x) > std::abs(y);
  const double radius = wide ? x : y;
  const double angle = wide ? pi / 4 * y / x : y != 0 ? pi / 2 - pi / 4 * x / y : 0;
  return {radius * std::cos(angle), radius * std::sin(angle), std::sqrt(std::max(0.0, 1 - radius * radius))};
}

// A lattice of so many points in the unit square, which goes on beyond its edges (Sloan and Joe 1994, "Lattice
// Methods for Multiple Integration", rank 1), of all such the one whose points keep farthest apart.
struct Lattice {
  explicit Lattice(std::uint32_t points);

  std::uint32_t points;
  std::uint32_t step = 1;  // point i is (i, i * step) / points
  glm::dvec2 u{0}, v{0};   // the two shortest ways from point to point

 private:
  glm::dvec2 way(std::uint32_t i, std::uint32_t with) const {
    const glm::dvec2 at = glm::dvec2(i, std::uint64_t{i} * with % points) / static_cast<double>(points);
    return at - glm::round(at);
  }
};

Lattice::Lattice(std::uint32_t count) : points(count) {
  double best = 0;
  for (std::uint32_t with = 1; with < points; ++with) {
    if (std::gcd(with, points) != 1) continue;
    double shortest = 2;
    for (std::uint32_t i = 1; i < points && shortest > best; ++i) {
      const auto apart = way(i, with);
      shortest = std::min(shortest, glm::dot(apart, apart));
    }
    if (shortest <= best) continue;
    best = shortest;
    step = with;
  }
  u = {1, 0};
  v = {0, 1};
  for (std::uint32_t i = 1; i < points; ++i) {
    const auto apart = way(i, step);
    if (glm::length(apart) < glm::length(u)) u = apart;
  }
  for (std::uint32_t i = 1; i < points; ++i) {
    const auto apart = way(i, step);
    const bool aside = std::abs(u.x * apart.y - u.y * apart.x) > 0.5 / points;
    if (aside && glm::length(apart) < glm::length(v)) v = apart;
  }
}

// A square's points row by row, to and fro: the order in which those of two sets lie next to each other.
void sort_alike(std::span<glm::dvec2> points) {
  const auto rows =
      static_cast<std::size_t>(std::max(std::lround(std::sqrt(static_cast<double>(points.size()))), 1L));
  std::ranges::sort(points, {}, &glm::dvec2::y);
  for (std::size_t row = 0; row < rows; ++row) {
    const auto first = row * points.size() / rows, end = (row + 1) * points.size() / rows;
    std::ranges::sort(points.subspan(first, end - first), {}, &glm::dvec2::x);
  }
}

}  // namespace

RaySets::RaySets(std::uint32_t rays, std::uint32_t sets, std::uint64_t seed) : rays_(rays) {
  std::mt19937_64 bits(seed);
  const auto random = [&] { return static_cast<double>(bits() >> 11) * 0x1p-53; };
  const std::uint32_t of_half[] = {(rays + 1) / 2, rays / 2};
  // Each set is the lattice shifted, so that all of them together are one that is as many times finer.
  const auto side = static_cast<std::uint32_t>(std::lround(std::sqrt(sets)));
  std::vector<glm::dvec2> points(std::size_t{rays} * sets);
  std::uint32_t first = 0;
  for (const auto count : of_half) {
    const Lattice lattice(count);
    const glm::dvec2 shift(random(), random());
    for (std::uint32_t set = 0; set < sets; ++set) {
      const auto of_set = std::span(points).subspan(std::size_t{set} * rays + first, count);
      const glm::dvec2 own =
          shift + (static_cast<double>(set % side) * lattice.u + static_cast<double>(set / side) * lattice.v) /
                      static_cast<double>(side);
      for (std::uint32_t i = 0; i < count; ++i) {
        const glm::dvec2 at = own + glm::dvec2(i, std::uint64_t{i} * lattice.step) / static_cast<double>(count);
        of_set[i] = at - glm::floor(at);
      }
      sort_alike(of_set);
    }
    first += count;
  }
  for (const auto& point : points) directions_.push_back(cosine_distributed(point));
}

}  // namespace lichtveld::lightfield
