#include "lichtveld/scene/ray_index.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "lichtveld/scene/embree.hpp"

namespace lichtveld::scene {

namespace {

// Coordinates within the scene's sphere are rounded by up to 6e-8 of its radius, and what is computed of them
// by a few times as much.
constexpr float skin_of_radius = 2e-6f;
// Surfaces lie on each other if their faces look at each other within this cosine.
constexpr float facing_cosine = 0.99f;
// Whether a body bulges is looked for by all its corners above all its triangles, if these are no more.
constexpr std::size_t most_pairs = 10'000'000;

// Triangles of one body and kind, which Embree numbers afresh.
struct Part {
  std::vector<std::uint32_t> triangles;
};

// What filters need to know about a ray that looks for contact.
struct Query : QueryContext {
  Query() { init(*this); }
  const glm::vec3* face = nullptr;  // of the receiver; null for rays that look for anything
  bool backs = false;               // of one-sided triangles count, too
  std::uint32_t triangle = 0;
};

void refuse_all_but_contact(const RTCFilterFunctionNArguments& of, const Query& query) {
  const auto& part = *static_cast<const Part*>(of.geometryUserPtr);
  const glm::vec3 normal(RTCHitN_Ng_x(of.hit, of.N, 0), RTCHitN_Ng_y(of.hit, of.N, 0),
                         RTCHitN_Ng_z(of.hit, of.N, 0));
  if (part.triangles[RTCHitN_primID(of.hit, of.N, 0)] == query.triangle ||
      glm::dot(normal, *query.face) > -facing_cosine * glm::length(normal))
    of.valid[0] = 0;
}

void refuse_backs(const RTCFilterFunctionNArguments* of) {
  const auto& query = *static_cast<const Query*>(of->context);
  if (query.backs) return;
  for (unsigned int i = 0; i < of->N; ++i) {
    const float facing = RTCHitN_Ng_x(of->hit, of->N, i) * RTCRayN_dir_x(of->ray, of->N, i) +
                         RTCHitN_Ng_y(of->hit, of->N, i) * RTCRayN_dir_y(of->ray, of->N, i) +
                         RTCHitN_Ng_z(of->hit, of->N, i) * RTCRayN_dir_z(of->ray, of->N, i);
    if (facing >= 0) of->valid[i] = 0;
  }
  if (query.face) refuse_all_but_contact(*of, query);
}

void refuse_no_back(const RTCFilterFunctionNArguments* of) {
  const auto& query = *static_cast<const Query*>(of->context);
  if (query.face) refuse_all_but_contact(*of, query);
}

void require_success(RTCDevice device, const Scene& scene) {
  const RTCError error = rtcGetDeviceError(device);
  if (error == RTC_ERROR_NONE) return;
  throw std::runtime_error("Embree cannot build its tree over " + std::to_string(scene.indices.size() / 3) +
                           " triangles" +
                           (error == RTC_ERROR_OUT_OF_MEMORY ? ": out of memory; try a simpler scene"
                                                             : " (error " + std::to_string(error) + ")"));
}

void fill(RTCRay16& to, const RayPacket& rays, const glm::vec3& shift, int (&active)[RayPacket::size]) {
  for (std::uint32_t i = 0; i < RayPacket::size; ++i) {
    active[i] = (rays.lanes >> i & 1) ? -1 : 0;
    to.org_x[i] = rays.x[i] - shift.x;
    to.org_y[i] = rays.y[i] - shift.y;
    to.org_z[i] = rays.z[i] - shift.z;
    to.dir_x[i] = rays.dx[i];
    to.dir_y[i] = rays.dy[i];
    to.dir_z[i] = rays.dz[i];
    to.tnear[i] = 0;
    to.time[i] = 0;
    to.mask[i] = ~0u;
    to.id[i] = i;
    to.flags[i] = 0;
  }
}

}  // namespace

struct RayIndex::Trees {
  Trees(const Scene& scene, const glm::vec3& centre);

  RTCSceneTy* of_body(std::uint32_t body) const { return bodies[body].get(); }

  // Without a number of threads: Embree would hold all of the process to it.
  EmbreeDevice device{rtcNewDevice(nullptr)};
  std::vector<float> positions;  // of Scene::vertices, about the centre, and what Embree reads past the last
  std::vector<std::array<Part, 2>>
      parts;  // of each body: one-sided, double-sided; they must stay where they are
  std::vector<EmbreeTree> bodies;
  // Of each triangle of a body that moves and was looked at: its normal, and how far its body reaches above it
  // and below [m].
  struct Reach {
    glm::vec3 normal{0};
    float above = 0, below = 0;
  };
  std::vector<Reach> reaches;  // by triangle; without a normal: not known

 private:
  void add(RTCScene tree, Part& part, bool double_sided, const Scene& scene);
  void find_reaches(const Scene& scene);
};

RayIndex::Trees::Trees(const Scene& scene, const glm::vec3& centre) : parts(scene.bodies.size()) {
  if (!device)
    throw std::runtime_error("Embree does not start: error " + std::to_string(rtcGetDeviceError(nullptr)));
  positions.reserve(3 * scene.vertices.size() + 1);
  for (const Vertex& vertex : scene.vertices)
    for (int axis = 0; axis < 3; ++axis) positions.push_back(vertex.position[axis] - centre[axis]);
  positions.push_back(0);
  for (const Surface& surface : scene.surfaces) {
    auto& part = parts[surface.body][scene.materials[surface.material].double_sided ? 1 : 0];
    for (std::uint32_t index = 0; index < surface.index_count; index += 3)
      part.triangles.push_back((surface.first_index + index) / 3);
  }
  for (auto& of_body : parts) {
    auto& tree = bodies.emplace_back(rtcNewScene(device.get()));
    require_success(device.get(), scene);
    rtcSetSceneFlags(tree.get(), RTC_SCENE_FLAG_ROBUST);  // no gaps along shared edges
    for (const bool double_sided : {false, true})
      if (auto& part = of_body[double_sided]; !part.triangles.empty())
        add(tree.get(), part, double_sided, scene);
    rtcCommitScene(tree.get());
    require_success(device.get(), scene);
  }
  find_reaches(scene);
}

void RayIndex::Trees::find_reaches(const Scene& scene) {
  reaches.resize(scene.indices.size() / 3);
  std::vector<std::vector<glm::vec3>> corners(parts.size());
  for (const Vertex& vertex : scene.vertices)
    if (vertex.body != 0) corners[vertex.body].push_back(vertex.position);
  for (std::size_t body = 1; body < parts.size(); ++body) {
    const std::size_t triangles = parts[body][0].triangles.size() + parts[body][1].triangles.size();
    if (triangles * corners[body].size() > most_pairs) continue;
    for (const auto& part : parts[body])
      for (const std::uint32_t triangle : part.triangles) {
        const auto corner = [&](std::size_t k) {
          return scene.vertices[scene.indices[3 * std::size_t{triangle} + k]].position;
        };
        const glm::vec3 cross = glm::cross(corner(1) - corner(0), corner(2) - corner(0));
        if (glm::length(cross) <= 0) continue;
        Reach& reach = reaches[triangle];
        reach.normal = glm::normalize(cross);
        for (const auto& place : corners[body]) {
          const float height = glm::dot(reach.normal, place - corner(0));
          reach.above = std::max(reach.above, height);
          reach.below = std::max(reach.below, -height);
        }
      }
  }
}

void RayIndex::Trees::add(RTCScene tree, Part& part, bool double_sided, const Scene& scene) {
  const EmbreeGeometry geometry(rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
  rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, positions.data(), 0,
                             3 * sizeof(float), positions.size() / 3);
  auto* indices = static_cast<std::uint32_t*>(
      rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              3 * sizeof(std::uint32_t), part.triangles.size()));
  require_success(device.get(), scene);
  for (const std::uint32_t triangle : part.triangles)
    for (std::size_t corner = 0; corner < 3; ++corner)
      *indices++ = scene.indices[std::size_t{3} * triangle + corner];
  const auto filter = double_sided ? refuse_no_back : refuse_backs;
  rtcSetGeometryIntersectFilterFunction(geometry.get(), filter);
  if (!double_sided) rtcSetGeometryOccludedFilterFunction(geometry.get(), filter);
  rtcSetGeometryUserData(geometry.get(), &part);
  rtcCommitGeometry(geometry.get());
  rtcAttachGeometryByID(tree, geometry.get(), double_sided);
}

RayIndex::RayIndex(const Scene& scene) : scene_(scene) {
  const Sphere sphere = bounding_sphere(scene);
  centre_ = sphere.centre;
  skin_ = skin_of_radius * sphere.radius;
  trees_ = std::make_unique<Trees>(scene, centre_);
}

RayIndex::~RayIndex() = default;

void RayIndex::nearest(std::uint32_t body, const glm::vec3& offset, const RayPacket& rays,
                       HitPacket& hits) const {
  nearest(body, offset, rays, hits, false);
}

void RayIndex::nearest(std::uint32_t body, const glm::vec3& offset, const RayPacket& rays, HitPacket& hits,
                       bool backs) const {
  alignas(64) int active[RayPacket::size];
  RTCRayHit16 query;
  fill(query.ray, rays, centre_ + offset, active);
  for (std::uint32_t i = 0; i < RayPacket::size; ++i) {
    query.ray.tfar[i] = hits.distance[i];
    query.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
  }
  Query context;
  context.backs = backs;
  intersect(trees_->of_body(body), context, active, query);
  for (std::uint32_t i = 0; i < RayPacket::size; ++i) {
    if (active[i] == 0 || query.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) continue;
    hits.distance[i] = query.ray.tfar[i];
    hits.triangle[i] = trees_->parts[body][query.hit.geomID[i]].triangles[query.hit.primID[i]];
    hits.u[i] = query.hit.u[i];
    hits.v[i] = query.hit.v[i];
    const bool behind =
        query.hit.Ng_x[i] * rays.dx[i] + query.hit.Ng_y[i] * rays.dy[i] + query.hit.Ng_z[i] * rays.dz[i] > 0;
    hits.from_behind = (hits.from_behind & ~(1u << i)) | (behind ? 1u << i : 0u);
  }
}

RayIndex::Sides RayIndex::sides_met(std::uint32_t body, const glm::vec3& offset, const RayPacket& rays) const {
  HitPacket first;
  first.clear(std::numeric_limits<float>::infinity());
  nearest(body, offset, rays, first, true);
  HitPacket front = first;  // what is no farther than that
  front.triangle.fill(HitPacket::none);
  for (float& distance : front.distance) distance += 2 * skin_;
  nearest(body, offset, rays, front, false);
  Sides sides;
  for (std::uint32_t i = 0; i < RayPacket::size; ++i) {
    if (!(rays.lanes >> i & 1) || first.triangle[i] == HitPacket::none) continue;
    (front.triangle[i] == HitPacket::none ? sides.backs : sides.fronts) |= 1u << i;
  }
  return sides;
}

std::uint32_t RayIndex::occluded(std::uint32_t body, const glm::vec3& offset, const RayPacket& rays,
                                 float reach) const {
  alignas(64) int active[RayPacket::size];
  RTCRay16 query;
  fill(query, rays, centre_ + offset, active);
  for (float& tfar : query.tfar) tfar = reach;
  Query context;
  scene::occluded(trees_->of_body(body), context, active, query);
  std::uint32_t found = 0;
  for (std::uint32_t i = 0; i < RayPacket::size; ++i)
    if (active[i] != 0 && query.tfar[i] < 0) found |= 1u << i;
  return found;
}

bool RayIndex::may_meet_own_body(std::uint32_t triangle, const glm::vec3& face) const {
  const auto& reach = trees_->reaches[triangle];
  if (reach.normal == glm::vec3(0)) return true;
  return (glm::dot(reach.normal, face) > 0 ? reach.above : reach.below) > skin_ / 2;
}

bool RayIndex::contact(std::uint32_t body, const glm::vec3& offset, const glm::vec3& place,
                       const glm::vec3& face, std::uint32_t triangle) const {
  const glm::vec3 surface = place - (centre_ + offset);
  Query context;
  const auto look = [&](const glm::vec3& start, float reach) {
    auto ray = ray_along(start, face, reach);
    intersect(trees_->of_body(body), context, ray);
    return ray;
  };
  context.face = &face;
  context.triangle = triangle;
  const RTCHit on_it = look(surface - skin_ * face, 2 * skin_).hit;
  if (on_it.geomID == RTC_INVALID_GEOMETRY_ID) return false;
  if (!of_one_node(scene_, triangle, trees_->parts[body][on_it.geomID].triangles[on_it.primID])) return true;
  // Two faces of a node on each other are where something of it stands on something else of it, if one leaves
  // that going on, and a sheet of two sides if not.
  context.face = nullptr;
  context.backs = true;
  const glm::vec3 above = surface + 2 * skin_ * face;
  const RTCRayHit next = look(above, std::numeric_limits<float>::infinity());
  if (next.hit.geomID == RTC_INVALID_GEOMETRY_ID ||
      next.hit.Ng_x * face.x + next.hit.Ng_y * face.y + next.hit.Ng_z * face.z <= 0)
    return false;
  // The back of another such sheet has a front in the same place, and nothing was left there.
  context.backs = false;
  return look(above, next.ray.tfar + 2 * skin_).hit.geomID == RTC_INVALID_GEOMETRY_ID;
}

}  // namespace lichtveld::scene
