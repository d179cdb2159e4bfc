#include "flat_triangle.hpp"

#include <algorithm>
#include <cmath>

namespace lichtveld::scene {
namespace {

// Far from any raster, and yet a whole number.
std::int64_t whole(double value) {
  constexpr double most = 1e15;
  return static_cast<std::int64_t>(std::clamp(value, -most, most));
}

}  // namespace

std::optional<FlatTriangle> FlatTriangle::of(const std::array<glm::dvec2, 3>& corners) {
  auto p = corners;
  const glm::dvec2 a = p[1] - p[0], b = p[2] - p[0];
  const double area = a.x * b.y - a.y * b.x;
  if (!(std::abs(area) > 0) || !std::isfinite(area)) return std::nullopt;
  if (area < 0) std::swap(p[1], p[2]);
  FlatTriangle result;
  for (std::size_t k = 0; k < 3; ++k) {
    const glm::dvec2 along = p[(k + 1) % 3] - p[k];
    const glm::dvec2 inwards = glm::dvec2(-along.y, along.x) / glm::length(along);
    result.edges_[k] = {inwards, -glm::dot(inwards, p[k])};
  }
  result.min_ = glm::min(glm::min(p[0], p[1]), p[2]);
  result.max_ = glm::max(glm::max(p[0], p[1]), p[2]);
  return result;
}

FlatTriangle::Range FlatTriangle::rows(double margin, std::int64_t least, std::int64_t end) const {
  const double outside = std::max(-margin, 0.0);
  return {std::max(whole(std::floor(min_.y - outside - 0.5)), least),
          std::min(whole(std::ceil(max_.y + outside - 0.5)) + 1, end)};
}

FlatTriangle::Range FlatTriangle::columns(std::int64_t row, double margin, std::int64_t least,
                                          std::int64_t end) const {
  const double y = static_cast<double>(row) + 0.5;
  const double outside = std::max(-margin, 0.0);
  double left = min_.x - outside, right = max_.x + outside;
  for (const glm::dvec3& edge : edges_) {
    const double rest = edge.y * y + edge.z - margin;  // edge.x * x + rest >= 0
    if (edge.x > 0) left = std::max(left, -rest / edge.x);
    if (edge.x < 0) right = std::min(right, -rest / edge.x);
    if (edge.x == 0 && rest < 0) return {0, 0};
  }
  if (!(left <= right)) return {0, 0};
  return {std::max(whole(std::ceil(left - 0.5)), least), std::min(whole(std::floor(right - 0.5)) + 1, end)};
}

}  // namespace lichtveld::scene
