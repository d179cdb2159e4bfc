// Which cells of a raster a triangle in the plane holds. Cell (i, j)'s centre is (i + 0.5, j + 0.5).
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <utility>

namespace lichtveld::scene {

class FlatTriangle {
 public:
  // Nothing where the corners span no area.
  static std::optional<FlatTriangle> of(const std::array<glm::dvec2, 3>& corners);

  // Calls each(i, j) for the cells whose centres lie at least `margin` inside, row by row, of those in [0,
  // size) both ways where a size is given. Of a margin below 0 all that are no farther outside, and beyond
  // corners some that are.
  template <typename Each>
  void for_cells(double margin, std::optional<std::int64_t> size, const Each& each) const {
    const std::int64_t none = std::numeric_limits<std::int64_t>::min();
    const std::int64_t least = size ? 0 : none, end = size.value_or(std::numeric_limits<std::int64_t>::max());
    const auto [first, last] = rows(margin, least, end);
    for (std::int64_t j = first; j < last; ++j) {
      const auto [begin, until] = columns(j, margin, least, end);
      for (std::int64_t i = begin; i < until; ++i) each(i, j);
    }
  }

 private:
  using Range = std::pair<std::int64_t, std::int64_t>;  // [begin, end)

  Range rows(double margin, std::int64_t least, std::int64_t end) const;
  Range columns(std::int64_t row, double margin, std::int64_t least, std::int64_t end) const;

  std::array<glm::dvec3, 3> edges_;  // half-planes n.(x, y) + d >= 0, (n, d), whose unit normals point inwards
  glm::dvec2 min_{0}, max_{0};
};

}  // namespace lichtveld::scene
