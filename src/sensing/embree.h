// SPDX-License-Identifier: BSD-3-Clause
//
// Embree 3 or 4, whichever is installed: this is the only file that knows which. From 4 on, what a query asks for
// stands in arguments of the call; in 3 it is part of the context.
#pragma once

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace curtain {

/// What Embree hands on to the callbacks of a query; what they need stands behind it, in a struct that begins with
/// this.
#if RTC_VERSION_MAJOR >= 4
using EmbreeContext = RTCRayQueryContext;
#else
using EmbreeContext = RTCIntersectContext;
#endif

/// For rays that are near each other.
inline void initCoherent(EmbreeContext& context) {
#if RTC_VERSION_MAJOR >= 4
  rtcInitRayQueryContext(&context);
#else
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
#endif
}

/// First hits of eight rays near each other.
///   valid  -1 for each ray that counts, 0 for others; aligned to 32 bytes, as packet
inline void intersectCoherent(const int* valid, RTCScene scene, EmbreeContext& context, RTCRayHit8& packet) {
#if RTC_VERSION_MAJOR >= 4
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  arguments.context = &context;
  rtcIntersect8(valid, scene, &packet, &arguments);
#else
  rtcIntersect8(valid, scene, &context, &packet);
#endif
}

}  // namespace curtain
