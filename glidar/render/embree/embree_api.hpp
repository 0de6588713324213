// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The one place that knows which Embree this is. Written for 3.13. In 4.x the header is
// <embree4/rtcore.h>, the context moves into RTCIntersectArguments, the packet calls lose their
// context argument, and filter functions must be allowed by
// RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER or set per geometry as here.

#include <embree3/rtcore.h>

#include <cstdint>

namespace glidar::embree {

/// Packets by width.
template <int kWidth>
struct Packet;

template <>
struct Packet<8> {
  using RayHit = RTCRayHit8;
  static void intersect(const int* valid, RTCScene scene, RTCIntersectContext* context,
                        RayHit* packet) {
    rtcIntersect8(valid, scene, context, packet);
  }
};

template <>
struct Packet<16> {
  using RayHit = RTCRayHit16;
  static void intersect(const int* valid, RTCScene scene, RTCIntersectContext* context,
                        RayHit* packet) {
    rtcIntersect16(valid, scene, context, packet);
  }
};

}  // namespace glidar::embree
