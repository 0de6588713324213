// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The one place that knows which Embree this is. Written for 3.13. In 4.x the header is
// <embree4/rtcore.h>, the context moves into RTCIntersectArguments and the packet calls lose their
// context argument; filter functions set per geometry, as here, stay.

#include <glidar/render/lanes.hpp>

#include <embree3/rtcore.h>

namespace glidar::embree {

/// Rays and hits of all lanes, in Embree's order of arrays.
using RayHits = RTCRayHit16;
static_assert(kLanes == 16);

/// Intersects the lanes whose `valid` is -1, as one packet of 16 where the processor has registers
/// that wide, else as two of 8.
void intersect(RTCScene scene, RTCIntersectContext& context, bool has_wide_packets,
               const Lanes<int>& valid, RayHits& rays);

}  // namespace glidar::embree
