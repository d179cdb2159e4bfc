#include "charts.hpp"

#include <algorithm>
#include <boost/geometry.hpp>
#include <boost/geometry/geometries/multi_point.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/geometries/polygon.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <unordered_map>
#include <unordered_set>

#include "flat_triangle.hpp"
#include "welding.hpp"

namespace lichtveld::scene {
namespace {

// A chart's triangles face its plane within this: nothing is shown with less than 0.7 of its texels.
constexpr double facing_cosine = 0.7;
// And those of a chart of less than so many cells, which is put to its neighbour, within this.
constexpr double joining_cosine = 0.3;
constexpr std::size_t small_chart = 64;
// So many triangles around the first decide which way a chart faces.
constexpr std::size_t deciding = 1000;
// Of a chart's own cells so many may lie on each other before it counts as folded.
constexpr double folded_share = 0.01;
// Of the edges around a chart so many are tried for its turn, the longest first.
constexpr std::size_t tried_edges = 64;

constexpr std::uint32_t none = ~0u;

// Two axes of the plane that a unit vector stands on.
std::array<glm::dvec3, 2> plane_of(const glm::dvec3& normal) {
  const glm::dvec3 size = glm::abs(normal);
  const glm::dvec3 other = size.x <= size.y && size.x <= size.z ? glm::dvec3(1, 0, 0)
                           : size.y <= size.z                   ? glm::dvec3(0, 1, 0)
                                                                : glm::dvec3(0, 0, 1);
  const glm::dvec3 x = glm::normalize(glm::cross(other, normal));
  return {x, glm::cross(normal, x)};
}

// Which cells of their planes charts fill.
class Cells {
 public:
  // How many cells of the triangle [cells] another one of the chart fills already.
  std::size_t held(const FlatTriangle& triangle, std::uint32_t chart) const {
    std::size_t count = 0;
    for_each(triangle, chart, [&](std::uint64_t cell) { count += filled_.contains(cell); });
    return count;
  }
  std::size_t fill(const FlatTriangle& triangle, std::uint32_t chart) {
    std::size_t count = 0;
    for_each(triangle, chart, [&](std::uint64_t cell) {
      filled_.insert(cell);
      ++count;
    });
    return count;
  }

 private:
  template <typename Each>
  static void for_each(const FlatTriangle& triangle, std::uint32_t chart, const Each& each) {
    constexpr double margin = 1e-3;  // neighbours meet at edges that are rounded
    // No chart is so long that it comes round again.
    constexpr std::uint64_t bits = 20, mask = (1u << bits) - 1;
    triangle.for_cells(margin, std::nullopt, [&](std::int64_t i, std::int64_t j) {
      each(std::uint64_t{chart} << 2 * bits | (static_cast<std::uint64_t>(i) & mask) << bits |
           (static_cast<std::uint64_t>(j) & mask));
    });
  }
  struct Hash {
    std::size_t operator()(std::uint64_t cell) const { return mixed(0, cell); }
  };
  std::unordered_set<std::uint64_t, Hash> filled_;
};

struct Extent {
  glm::dvec2 min{std::numeric_limits<double>::infinity()}, max{-std::numeric_limits<double>::infinity()};
  void add(const glm::dvec2& place) { min = glm::min(min, place), max = glm::max(max, place); }
  glm::dvec2 size() const { return max - min; }
};

// A turn in the plane by an angle whose cosine and sine these are.
glm::dvec2 turned(const glm::dvec2& place, const glm::dvec2& by) {
  return {by.x * place.x + by.y * place.y, by.x * place.y - by.y * place.x};
}

// Moves the chart to 0.
void settle(Chart& chart) {
  Extent extent;
  for (const auto& corners : chart.flat)
    for (const auto& place : corners) extent.add(place);
  for (auto& corners : chart.flat)
    for (auto& place : corners) place -= extent.min;
  chart.extent = extent.size();
}

// Turns a chart so that one of the edges around it lies along x and its rectangle is smallest, and wide.
void straighten(Chart& chart) {
  namespace bg = boost::geometry;
  using Point = bg::model::d2::point_xy<double>;
  bg::model::multi_point<Point> points;
  for (const auto& corners : chart.flat)
    for (const auto& place : corners) points.emplace_back(place.x, place.y);
  bg::model::polygon<Point> hull;
  bg::convex_hull(points, hull);
  std::vector<glm::dvec2> around;
  for (const auto& point : hull.outer()) around.emplace_back(point.x(), point.y());
  std::vector<glm::dvec2> edges;
  for (std::size_t i = 0; i + 1 < around.size(); ++i) edges.push_back(around[i + 1] - around[i]);
  std::ranges::stable_sort(edges, std::greater{}, [](const glm::dvec2& edge) { return glm::length(edge); });
  edges.resize(std::min(edges.size(), tried_edges));
  double least = std::numeric_limits<double>::infinity();
  glm::dvec2 best(1, 0);
  for (const auto& edge : edges) {
    if (!(glm::length(edge) > 0)) continue;
    const glm::dvec2 direction = glm::normalize(edge);
    Extent extent;
    for (const auto& place : around) extent.add(turned(place, direction));
    const glm::dvec2 size = extent.size();
    // A hair less is rounding's: the longer edge, which comes first, decides.
    if (size.x * size.y >= least * (1 - 1e-9)) continue;
    least = size.x * size.y;
    best = size.x >= size.y ? direction : glm::dvec2(-direction.y, direction.x);
  }
  for (auto& corners : chart.flat)
    for (auto& place : corners) place = turned(place, best);
  settle(chart);
}

class Charter {
 public:
  Charter(std::span<const Corners> triangles, const ChartLimits& limits)
      : triangles_(triangles),
        limits_(limits),
        places_(welded(triangles)),
        edges_(places_),
        twins_(find_twins(places_)),
        chart_(triangles.size(), none),
        seen_(triangles.size(), none) {}

  std::vector<Chart> find() {
    std::vector<std::uint32_t> order;
    for (std::uint32_t t = 0; t < triangles_.size(); ++t)
      if (twins_.first[t] == t && has_area(triangles_[t])) order.push_back(t);
    std::vector<double> area(triangles_.size());
    for (const auto t : order) area[t] = area_of(triangles_[t]);
    std::ranges::stable_sort(order, std::greater{}, [&](std::uint32_t t) { return area[t]; });
    for (const auto seed : order)
      if (chart_[seed] == none) grow(seed);
    join_small();
    for (std::uint32_t t = 0; t < triangles_.size(); ++t)
      if (const auto first = twins_.first[t]; first != t && chart_[first] != none) add_twin(t, first);
    std::erase_if(charts_, [](const Chart& chart) { return chart.triangles.empty(); });
    for (auto& chart : charts_) straighten(chart);
    return std::move(charts_);
  }

 private:
  // Calls accept(triangle) for a seed and on from those that it accepts, each once.
  template <typename Accept>
  void spread(std::uint32_t seed, const Accept& accept) {
    ++mark_;
    std::vector<std::uint32_t> open = {seed};
    seen_[seed] = mark_;
    for (std::size_t next = 0; next < open.size(); ++next) {
      const std::uint32_t t = open[next];
      if (!accept(t)) continue;
      for (std::size_t k = 0; k < 3; ++k)
        edges_.for_triangles(places_[t][(k + 1) % 3], places_[t][k], [&](std::uint32_t neighbour) {
          if (seen_[neighbour] == mark_ || twins_.first[neighbour] != neighbour || chart_[neighbour] != none ||
              !has_area(triangles_[neighbour]))
            return;
          seen_[neighbour] = mark_;
          open.push_back(neighbour);
        });
    }
  }

  // The mean way that the triangles about the seed face.
  glm::dvec3 axis_about(std::uint32_t seed) {
    const glm::dvec3 first = glm::normalize(cross_of(triangles_[seed]));
    glm::dvec3 sum(0);
    std::size_t count = 0;
    spread(seed, [&](std::uint32_t t) {
      const glm::dvec3 cross = cross_of(triangles_[t]);
      if (count >= deciding || glm::dot(cross, first) < facing_cosine * glm::length(cross)) return false;
      sum += cross;
      ++count;
      return true;
    });
    const glm::dvec3 axis = glm::normalize(sum);
    return glm::dot(axis, first) >= facing_cosine ? axis : first;
  }

  // The plane of a chart, and what it holds so far.
  struct Plane {
    glm::dvec3 axis{0}, origin{0};
    std::array<glm::dvec3, 2> along{};
    Extent extent{};
    std::size_t cells = 0;
  };

  // A triangle as it lies in a plane.
  struct Laid {
    std::array<glm::dvec2, 3> flat;  // [m]
    std::optional<FlatTriangle> cells;
    Extent extent;  // of the chart with it
  };

  // Nothing where it faces the plane too little, makes the chart too long, or lies on what is there.
  std::optional<Laid> laid(std::uint32_t t, std::uint32_t chart, double cosine) const {
    const Plane& plane = planes_[chart];
    const glm::dvec3 cross = cross_of(triangles_[t]);
    if (glm::dot(cross, plane.axis) < cosine * glm::length(cross)) return std::nullopt;
    Laid result;
    result.extent = plane.extent;
    std::array<glm::dvec2, 3> in_cells;
    for (std::size_t k = 0; k < 3; ++k) {
      const glm::dvec3 place = glm::dvec3(triangles_[t][k]) - plane.origin;
      result.flat[k] = {glm::dot(place, plane.along[0]), glm::dot(place, plane.along[1])};
      in_cells[k] = result.flat[k] / limits_.cell;
      result.extent.add(result.flat[k]);
    }
    const glm::dvec2 size = result.extent.size();
    if (!charts_[chart].triangles.empty() && std::max(size.x, size.y) > limits_.longest) return std::nullopt;
    // One of more cells than any atlas has is alone, and takes no time.
    constexpr double most_cells = 1e5;
    if (std::max(size.x, size.y) <= most_cells * limits_.cell) result.cells = FlatTriangle::of(in_cells);
    if (result.cells && cells_.held(*result.cells, chart) > 0) return std::nullopt;
    return result;
  }

  void put(std::uint32_t t, std::uint32_t chart, const Laid& laid) {
    planes_[chart].extent = laid.extent;
    if (laid.cells) planes_[chart].cells += cells_.fill(*laid.cells, chart);
    chart_[t] = chart;
    charts_[chart].triangles.push_back(t);
    charts_[chart].flat.push_back(laid.flat);
  }

  void grow(std::uint32_t seed) {
    const glm::dvec3 axis = axis_about(seed);
    const auto number = static_cast<std::uint32_t>(charts_.size());
    charts_.emplace_back();
    planes_.push_back({axis, glm::dvec3(triangles_[seed][0]), plane_of(axis)});
    spread(seed, [&](std::uint32_t t) {
      const auto found = laid(t, number, facing_cosine);
      if (found) put(t, number, *found);
      return found.has_value();
    });
  }

  // Puts small charts to the neighbours with which they have the most edges, where those take all of them: what
  // is left between charts would be many rectangles of nothing but gutter.
  void join_small() {
    for (std::uint32_t small = 0; small < charts_.size(); ++small) {
      if (planes_[small].cells >= small_chart) continue;
      std::map<std::uint32_t, std::size_t> edges;
      for (const auto t : charts_[small].triangles)
        for (std::size_t k = 0; k < 3; ++k)
          edges_.for_triangles(places_[t][(k + 1) % 3], places_[t][k], [&](std::uint32_t neighbour) {
            if (chart_[neighbour] != none && chart_[neighbour] != small) ++edges[chart_[neighbour]];
          });
      std::vector<std::pair<std::size_t, std::uint32_t>> order;
      for (const auto& [chart, count] : edges) order.emplace_back(count, chart);
      std::ranges::sort(order, std::greater{});
      for (const auto& [count, chart] : order)
        if (joined(small, chart)) break;
    }
  }

  bool joined(std::uint32_t small, std::uint32_t chart) {
    std::vector<Laid> all;
    for (const auto t : charts_[small].triangles) {
      const auto found = laid(t, chart, joining_cosine);
      if (!found) return false;
      all.push_back(*found);
    }
    Extent extent = planes_[chart].extent;
    for (auto& one : all) {
      for (const auto& place : one.flat) extent.add(place);
      one.extent = extent;
    }
    if (std::max(extent.size().x, extent.size().y) > limits_.longest) return false;
    const auto moving = std::move(charts_[small].triangles);
    charts_[small] = {};
    for (std::size_t i = 0; i < moving.size(); ++i) put(moving[i], chart, all[i]);
    return true;
  }

  void add_twin(std::uint32_t t, std::uint32_t first) {
    auto& chart = charts_[chart_[first]];
    if (where_.size() <= first) where_ = positions();
    const auto& flat = chart.flat[where_[first]];
    const std::size_t turn = twins_.turn[t];
    chart.triangles.push_back(t);
    chart.flat.push_back({flat[turn], flat[(turn + 1) % 3], flat[(turn + 2) % 3]});
  }

  // Where in its chart each triangle stands.
  std::vector<std::uint32_t> positions() const {
    std::vector<std::uint32_t> where(triangles_.size());
    for (const auto& chart : charts_)
      for (std::uint32_t i = 0; i < chart.triangles.size(); ++i) where[chart.triangles[i]] = i;
    return where;
  }

  std::span<const Corners> triangles_;
  ChartLimits limits_;
  std::vector<Places> places_;
  Edges edges_;
  Twins twins_;
  std::vector<std::uint32_t> chart_, seen_;  // by triangle: its chart, and in which spread it was met
  std::vector<std::uint32_t> where_;
  std::uint32_t mark_ = 0;
  Cells cells_;
  std::vector<Chart> charts_;
  std::vector<Plane> planes_;  // of each chart
};

// Charts as they lie in coordinates of one's own.
class OwnCharts {
 public:
  OwnCharts(std::span<const Corners> triangles, std::span<const std::array<glm::vec2, 3>> uv,
            const ChartLimits& limits)
      : triangles_(triangles), uv_(uv), limits_(limits), twins_(find_twins(welded(triangles))) {}

  // As large as its surface. Nothing where it has no area, is too long, or folds onto itself.
  std::optional<Chart> of(const std::vector<std::uint32_t>& island) {
    const double scale = scale_of(island);
    if (!(scale > 0)) return std::nullopt;
    Extent extent;
    for (const auto t : island)
      for (const auto& at : uv_[t]) extent.add(glm::dvec2(at) * scale);
    if (std::max(extent.size().x, extent.size().y) > limits_.longest) return std::nullopt;
    Chart chart{.triangles = island, .flat = {}, .extent = {}};
    const glm::dvec2 origin(uv_[island[0]][0]);
    const std::uint32_t number = count_++;
    std::size_t twice = 0, filled = 0;
    for (const auto t : island) {
      std::array<glm::dvec2, 3> flat, in_cells;
      for (std::size_t k = 0; k < 3; ++k) {
        flat[k] = (glm::dvec2(uv_[t][k]) - origin) * scale;
        in_cells[k] = flat[k] / limits_.cell;
      }
      chart.flat.push_back(flat);
      const auto triangle = twins_.first[t] == t ? FlatTriangle::of(in_cells) : std::nullopt;
      if (!triangle) continue;
      twice += cells_.held(*triangle, number);
      filled += cells_.fill(*triangle, number);
    }
    if (static_cast<double>(twice) > folded_share * static_cast<double>(filled)) return std::nullopt;
    settle(chart);
    return chart;
  }

 private:
  // From coordinates to metres; 0 where they have no area for more than a hair of the surface.
  double scale_of(const std::vector<std::uint32_t>& island) const {
    double area = 0, flat_area = 0, lost = 0;
    for (const auto t : island) {
      const glm::dvec2 a(uv_[t][0]), b(uv_[t][1]), c(uv_[t][2]);
      const double flat = std::abs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)) / 2;
      area += area_of(triangles_[t]);
      flat_area += flat;
      if (!(flat > 0)) lost += area_of(triangles_[t]);
    }
    const double scale = std::sqrt(area / flat_area);
    return flat_area > 0 && std::isfinite(scale) && lost <= folded_share * area ? scale : 0;
  }

  std::span<const Corners> triangles_;
  std::span<const std::array<glm::vec2, 3>> uv_;
  ChartLimits limits_;
  Twins twins_;
  Cells cells_;
  std::uint32_t count_ = 0;  // of charts that have been looked at
};

}  // namespace

std::vector<Chart> find_charts(std::span<const Corners> triangles, const ChartLimits& limits) {
  return Charter(triangles, limits).find();
}

std::vector<Chart> charts_of(std::span<const Corners> triangles, std::span<const std::array<glm::vec2, 3>> uv,
                             const ChartLimits& limits, std::size_t& anew) {
  // Corners that have a place and a coordinate in common hang together.
  Numbers<5> numbers;
  std::vector<Places> corners(triangles.size());
  std::vector<bool> finite(triangles.size(), true);
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const glm::vec3& p = triangles[t][k];
      const glm::vec2& at = uv[t][k];
      constexpr float farthest = 1e6f;
      finite[t] = finite[t] && std::abs(at.x) < farthest && std::abs(at.y) < farthest;
      corners[t][k] = numbers.of({p.x, p.y, p.z, at.x, at.y});
    }
  Sets sets(3 * triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t)
    if (finite[t])
      for (std::size_t k = 1; k < 3; ++k) sets.union_set(corners[t][0], corners[t][k]);

  std::vector<std::vector<std::uint32_t>> islands;
  std::vector<std::uint32_t> rest;
  std::unordered_map<std::size_t, std::uint32_t> known;
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    if (!has_area(triangles[t])) continue;
    if (!finite[t]) {
      rest.push_back(t);
      continue;
    }
    const auto [found, is_new] =
        known.try_emplace(sets.find_set(corners[t][0]), static_cast<std::uint32_t>(islands.size()));
    if (is_new) islands.emplace_back();
    islands[found->second].push_back(t);
  }
  OwnCharts own(triangles, uv, limits);
  std::vector<Chart> kept;
  for (const auto& island : islands) {
    if (auto chart = own.of(island))
      kept.push_back(std::move(*chart));
    else
      rest.insert(rest.end(), island.begin(), island.end());
  }
  anew += rest.size();
  std::ranges::sort(rest);
  std::vector<Corners> laid;
  for (const auto t : rest) laid.push_back(triangles[t]);
  for (auto& chart : find_charts(laid, limits)) {
    for (auto& t : chart.triangles) t = rest[t];
    kept.push_back(std::move(chart));
  }
  return kept;
}

}  // namespace lichtveld::scene
