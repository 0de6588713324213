// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Differences between Embree 3.13 (Debian 12) and 4 (Debian 13). CMake defines GLIDAR_EMBREE_4.

#ifdef GLIDAR_EMBREE_4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace glidar::bench {

/// Intersects a packet of 16 similar rays, those whose `valid` is -1.
inline void intersect_packet(RTCScene scene, const int* valid, RTCRayHit16& rays) {
#ifdef GLIDAR_EMBREE_4
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  rtcIntersect16(valid, scene, &rays, &arguments);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect16(valid, scene, &context, &rays);
#endif
}

}  // namespace glidar::bench
