#include "embree_scene.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>

namespace lichtveld::reference {
namespace {

// How far behind its receiver a ray starts, in units of the scene's radius and measured across the receiver's
// face, so that what lies on it is in front. Coinciding faces and the places of rays on them are rounded apart
// by some 1e-7 (32-bit coordinates in the unit sphere), and receivers are lifted by 1e-6. The start lies on the
// ray's own line: that way no ray slips below the wall that a floor ends at.
constexpr float start_behind = 3e-6f;
// Rays that graze start no farther back than at this cosine. They carry 1e-4 of the light.
constexpr float grazing_cosine = 0.01f;

// A surface lies on the receiver if their faces look at each other within this cosine. Others that a ray meets
// before its receiver, such as the outside of a thin wall beside it, are behind it.
constexpr float facing_cosine = 0.99f;

// What the filter needs to know about a ray.
struct Query : scene::QueryContext {
  Query(const Geometry& geometry, const Receiver& from, float behind)
      : geometry(geometry), from(from), behind(behind) {
    scene::init(*this);
  }
  const Geometry& geometry;
  const Receiver& from;
  float behind;  // how far behind its receiver the ray starts
  // What lies on the receiver counts; backs of one-sided surfaces do.
  bool contact = true, backs = false;
};

// Passes through backs of one-sided surfaces, through the receiver's own triangle, and through what is behind
// it.
void refuse_unseen(const RTCFilterFunctionNArguments* arguments) {
  const auto& query = *static_cast<const Query*>(arguments->context);
  const std::uint32_t triangle = RTCHitN_primID(arguments->hit, arguments->N, 0);
  const glm::vec3 direction(RTCRayN_dir_x(arguments->ray, arguments->N, 0),
                            RTCRayN_dir_y(arguments->ray, arguments->N, 0),
                            RTCRayN_dir_z(arguments->ray, arguments->N, 0));
  const bool before_receiver = RTCRayN_tfar(arguments->ray, arguments->N, 0) <= query.behind;
  const bool lies_on_it =
      query.contact && glm::dot(query.geometry.face(triangle), query.from.face) < -facing_cosine;
  if (triangle == query.from.triangle || (!query.backs && query.geometry.is_transparent(triangle, direction)) ||
      (before_receiver && !lies_on_it))
    arguments->valid[0] = 0;
}

void require_success(RTCDevice device, const Geometry& geometry) {
  const RTCError error = rtcGetDeviceError(device);
  if (error == RTC_ERROR_NONE) return;
  throw std::runtime_error("Embree cannot build its tree over " + std::to_string(geometry.triangles()) +
                           " triangles" +
                           (error == RTC_ERROR_OUT_OF_MEMORY ? ": out of memory; try a simpler scene"
                                                             : " (error " + std::to_string(error) + ")"));
}

template <typename T>
void fill(RTCGeometry target, RTCBufferType type, RTCFormat format, std::size_t bytes,
          const std::vector<T>& source, RTCDevice device, const Geometry& geometry) {
  void* buffer = rtcSetNewGeometryBuffer(target, type, 0, format, bytes, source.size() * sizeof(T) / bytes);
  require_success(device, geometry);
  std::copy(source.begin(), source.end(), static_cast<T*>(buffer));
}

RTCRayHit traced(RTCScene scene, Query& query, const glm::vec3& direction) {
  const glm::vec3 start = query.from.position - query.behind * direction;
  auto ray = scene::ray_along(start, direction, std::numeric_limits<float>::infinity());
  scene::intersect(scene, query, ray);
  return ray;
}

bool hits(const RTCRayHit& ray) {
  return ray.hit.geomID != RTC_INVALID_GEOMETRY_ID;
}

}  // namespace

EmbreeScene::EmbreeScene(const Geometry& geometry)
    : geometry_(geometry),
      // One thread builds the tree, so that coinciding triangles are met in the same order every time.
      device_(rtcNewDevice("threads=1")),
      scene_(device_ ? rtcNewScene(device_.get()) : nullptr) {
  if (!scene_)
    throw std::runtime_error("Embree does not start: error " +
                             std::to_string(rtcGetDeviceError(device_.get())));
  rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);  // no gaps along shared edges
  const scene::EmbreeGeometry triangles(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
  fill(triangles.get(), RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, sizeof(glm::vec3), geometry.positions(),
       device_.get(), geometry);
  fill(triangles.get(), RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), geometry.indices(),
       device_.get(), geometry);
  rtcSetGeometryIntersectFilterFunction(triangles.get(), refuse_unseen);
  rtcCommitGeometry(triangles.get());
  rtcAttachGeometry(scene_.get(), triangles.get());
  rtcCommitScene(scene_.get());
  require_success(device_.get(), geometry);
}

std::optional<Hit> EmbreeScene::nearest(const Receiver& from, const glm::vec3& direction) const {
  const float back = start_behind / std::max(glm::dot(direction, from.face), grazing_cosine);
  Query query(geometry_, from, back);
  auto ray = traced(scene_.get(), query, direction);
  if (hits(ray) && ray.ray.tfar <= back && is_one_sheet(from, ray.hit.primID)) {
    query.contact = false;
    ray = traced(scene_.get(), query, direction);
  }
  if (!hits(ray)) return std::nullopt;
  return Hit{ray.hit.primID, {ray.hit.u, ray.hit.v}};
}

bool EmbreeScene::is_one_sheet(const Receiver& from, std::uint32_t triangle) const {
  if (!scene::of_one_node(geometry_.scene(), from.triangle, triangle)) return false;
  Query query(geometry_, from, start_behind);
  query.contact = false;
  query.backs = true;
  const auto ray = traced(scene_.get(), query, from.face);
  if (!hits(ray) || glm::dot(geometry_.face(ray.hit.primID), from.face) <= 0) return true;
  // The back of another sheet has a front in the same place, and nothing was left there.
  query.backs = false;
  const auto front = traced(scene_.get(), query, from.face);
  return hits(front) && front.ray.tfar <= ray.ray.tfar + start_behind;
}

}  // namespace lichtveld::reference
