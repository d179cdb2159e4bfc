// Embree 3 (Debian 12) or 4 (Ubuntu 24.04, Debian 13), which differ in how a query is made.
#pragma once

#include <glm/glm.hpp>
#include <memory>

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>

namespace lichtveld::scene {
using QueryContext = RTCRayQueryContext;
inline void init(QueryContext& context) {
  rtcInitRayQueryContext(&context);
}
inline void intersect(RTCScene scene, QueryContext& context, RTCRayHit& ray) {
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = &context;
  rtcIntersect1(scene, &ray, &arguments);
}
// Rays of nearly one direction, or from one place, are found up to three times as fast together.
inline void intersect(RTCScene scene, QueryContext& context, const int* active, RTCRayHit16& rays) {
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = &context;
  arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  rtcIntersect16(active, scene, &rays, &arguments);
}
inline void occluded(RTCScene scene, QueryContext& context, const int* active, RTCRay16& rays) {
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.context = &context;
  arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  rtcOccluded16(active, scene, &rays, &arguments);
}
}  // namespace lichtveld::scene

#else
#include <embree3/rtcore.h>

namespace lichtveld::scene {
using QueryContext = RTCIntersectContext;
inline void init(QueryContext& context) {
  rtcInitIntersectContext(&context);
}
inline void intersect(RTCScene scene, QueryContext& context, RTCRayHit& ray) {
  rtcIntersect1(scene, &context, &ray);
}
// Rays of nearly one direction, or from one place, are found up to three times as fast together.
inline void intersect(RTCScene scene, QueryContext& context, const int* active, RTCRayHit16& rays) {
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect16(active, scene, &context, &rays);
}
inline void occluded(RTCScene scene, QueryContext& context, const int* active, RTCRay16& rays) {
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcOccluded16(active, scene, &context, &rays);
}
}  // namespace lichtveld::scene

#endif

namespace lichtveld::scene {

// A ray that has hit nothing yet and looks so many lengths of its direction far.
inline RTCRayHit ray_along(const glm::vec3& from, const glm::vec3& direction, float reach) {
  RTCRayHit ray{};
  ray.ray.org_x = from.x;
  ray.ray.org_y = from.y;
  ray.ray.org_z = from.z;
  ray.ray.dir_x = direction.x;
  ray.ray.dir_y = direction.y;
  ray.ray.dir_z = direction.z;
  ray.ray.tfar = reach;
  ray.ray.mask = ~0u;
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  return ray;
}

struct ReleaseEmbree {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
  void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
};
using EmbreeDevice = std::unique_ptr<RTCDeviceTy, ReleaseEmbree>;
using EmbreeTree = std::unique_ptr<RTCSceneTy, ReleaseEmbree>;
using EmbreeGeometry = std::unique_ptr<RTCGeometryTy, ReleaseEmbree>;

}  // namespace lichtveld::scene
