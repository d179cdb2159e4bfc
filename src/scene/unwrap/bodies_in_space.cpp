#include "bodies_in_space.hpp"

#include <boost/geometry.hpp>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <limits>

namespace lichtveld::scene {
namespace {

namespace geometry = boost::geometry;
using Point = geometry::model::point<double, 3, geometry::cs::cartesian>;
using BoxInSpace = geometry::model::box<Point>;

Point point(const glm::dvec3& at) {
  return {at.x, at.y, at.z};
}

// Of a body, where a node shows it.
BoxInSpace box_of(const Bodies& bodies, std::size_t body, const glm::dmat4& world) {
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
  for (unsigned corner = 0; corner < 8; ++corner) {
    glm::dvec4 at(0, 0, 0, 1);
    for (int axis = 0; axis < 3; ++axis) at[axis] = (corner >> axis & 1 ? bodies.max : bodies.min)[body][axis];
    const glm::dvec3 place = world * at;
    low = glm::min(low, place);
    high = glm::max(high, place);
  }
  return {point(low), point(high)};
}

}  // namespace

BodiesInSpace::BodiesInSpace(const Meshes& meshes, std::span<const glm::vec3> others) {
  std::vector<Point> points;
  for (const auto& place : others) points.push_back(point(place));
  for (const auto& [number, mesh] : meshes) {
    std::vector<Corners> all;
    for (const auto& sheet : mesh.sheets)
      all.insert(all.end(), sheet.corners.begin(),
                 sheet.corners.begin() + static_cast<std::ptrdiff_t>(sheet.fronts));
    auto& [bodies, places, alone] = meshes_[number];
    places = welded(all);
    bodies = find_bodies(all, places);
    for (const auto& use : mesh.uses)
      for (std::size_t body = 0; body < bodies.closed.size(); ++body)
        points.push_back(point((use.world * glm::dvec4((bodies.min[body] + bodies.max[body]) / 2.0f, 1))));
  }
  const geometry::index::rtree<Point, geometry::index::rstar<16>> tree(points);
  for (const auto& [number, mesh] : meshes) {
    auto& [bodies, places, alone] = meshes_[number];
    alone.assign(bodies.closed.size(), true);
    for (const auto& use : mesh.uses)
      for (std::size_t body = 0; body < bodies.closed.size(); ++body) {
        if (!bodies.closed[body] || !alone[body]) continue;
        std::size_t inside = 0;  // its own middle among them
        for (auto found = tree.qbegin(geometry::index::within(box_of(bodies, body, use.world)));
             found != tree.qend() && inside < 2; ++found)
          ++inside;
        alone[body] = inside < 2;
      }
  }
}

}  // namespace lichtveld::scene
