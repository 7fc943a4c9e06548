// Embree 3.13 or 4 behind the interface of version 4, as far as this room uses it. Version 4 hands the flags of a query as
// optional arguments, where version 3 has a context.
#pragma once

#if GONIOCHROME_EMBREE == 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace goniochrome::rays {

#if GONIOCHROME_EMBREE == 4

using RayQuery = RTCIntersectArguments;
inline RayQuery ray_query(bool coherent) {
  RayQuery query;
  rtcInitIntersectArguments(&query);
  query.flags = coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
  return query;
}
inline void intersect(RTCScene scene, RayQuery query, RTCRayHit& ray) {
  rtcIntersect1(scene, &ray, &query);
}
inline void intersect(RTCScene scene, RayQuery query, const int* valid, RTCRayHit8& rays) {
  rtcIntersect8(valid, scene, &rays, &query);
}
// An occluded query takes arguments of another type with the same flags.
inline RTCOccludedArguments occluded_query(const RayQuery& query) {
  RTCOccludedArguments occluded;
  rtcInitOccludedArguments(&occluded);
  occluded.flags = query.flags;
  return occluded;
}
inline void occlude(RTCScene scene, const RayQuery& query, RTCRay& ray) {
  RTCOccludedArguments occluded = occluded_query(query);
  rtcOccluded1(scene, &ray, &occluded);
}
inline void occlude(RTCScene scene, const RayQuery& query, const int* valid, RTCRay8& rays) {
  RTCOccludedArguments occluded = occluded_query(query);
  rtcOccluded8(valid, scene, &rays, &occluded);
}

#else

using RayQuery = RTCIntersectContext;
inline RayQuery ray_query(bool coherent) {
  RayQuery query;
  rtcInitIntersectContext(&query);
  if (coherent) query.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  return query;
}
inline void intersect(RTCScene scene, RayQuery query, RTCRayHit& ray) {
  rtcIntersect1(scene, &query, &ray);
}
inline void intersect(RTCScene scene, RayQuery query, const int* valid, RTCRayHit8& rays) {
  rtcIntersect8(valid, scene, &query, &rays);
}
inline void occlude(RTCScene scene, RayQuery query, RTCRay& ray) {
  rtcOccluded1(scene, &query, &ray);
}
inline void occlude(RTCScene scene, RayQuery query, const int* valid, RTCRay8& rays) {
  rtcOccluded8(valid, scene, &query, &rays);
}

#endif

}  // namespace goniochrome::rays
