// Embree 3 (Debian 12) or 4 (Ubuntu 24.04, Debian 13), which differ in how a query is made.
#pragma once

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>

namespace lichtveld::reference {
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
}  // namespace lichtveld::reference

#else
#include <embree3/rtcore.h>

namespace lichtveld::reference {
using QueryContext = RTCIntersectContext;
inline void init(QueryContext& context) {
  rtcInitIntersectContext(&context);
}
inline void intersect(RTCScene scene, QueryContext& context, RTCRayHit& ray) {
  rtcIntersect1(scene, &context, &ray);
}
}  // namespace lichtveld::reference

#endif
