// Rays through Embree's scenes, 16 at a time, for both of its major versions: Embree 4 has no streams of rays.
//
// Thread safety: any number of threads may cast through a committed scene.
#pragma once

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <cstddef>
#include <cstdint>

namespace kenaf::camera {

inline constexpr std::size_t kPacket = 16;

// -1 where a ray is to be cast, else 0.
struct alignas(64) PacketMask {
  std::int32_t of[kPacket];
};

// Replaces what a ray hit so far by what it hits before that (tfar, geomID, primID, instID). Neighbouring rays should
// go much the same way.
void intersect(RTCScene scene, const PacketMask& cast, RTCRayHit16& rays);

// Sets the tfar of rays that anything stops to -infinity.
void occlude(RTCScene scene, const PacketMask& cast, RTCRay16& rays);

}  // namespace kenaf::camera
