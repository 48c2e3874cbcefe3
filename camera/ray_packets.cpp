#include "camera/ray_packets.hpp"

namespace kenaf::camera {

#if RTC_VERSION_MAJOR >= 4

void intersect(RTCScene scene, const PacketMask& cast, RTCRayHit16& rays) {
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  rtcIntersect16(cast.of, scene, &rays, &arguments);
}

void occlude(RTCScene scene, const PacketMask& cast, RTCRay16& rays) {
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  rtcOccluded16(cast.of, scene, &rays, &arguments);
}

#else

namespace {

RTCIntersectContext coherent() {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  return context;
}

}  // namespace

void intersect(RTCScene scene, const PacketMask& cast, RTCRayHit16& rays) {
  RTCIntersectContext context = coherent();
  rtcIntersect16(cast.of, scene, &context, &rays);
}

void occlude(RTCScene scene, const PacketMask& cast, RTCRay16& rays) {
  RTCIntersectContext context = coherent();
  rtcOccluded16(cast.of, scene, &context, &rays);
}

#endif

}  // namespace kenaf::camera
