// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The one place that knows which Embree this is: 3.13 (Debian 12), or 4.x (Debian 13), in which the
// flags of a query are in arguments of its own. CMake defines GLIDAR_EMBREE_4.

#include <glidar/render/lanes.hpp>

#ifdef GLIDAR_EMBREE_4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace glidar::embree {

/// Rays and hits of all lanes, in Embree's order of arrays.
using RayHits = RTCRayHit16;
static_assert(kLanes == 16);

/// What a query hands through Embree to filter functions.
#ifdef GLIDAR_EMBREE_4
using QueryContext = RTCRayQueryContext;
#else
using QueryContext = RTCIntersectContext;
#endif

/// Sets the context to Embree's defaults. Every context starts with it.
void init_context(QueryContext& context);

/// Intersects a packet of 16 rays that run alike, those whose `valid` is -1.
void intersect_packet(RTCScene scene, QueryContext& context, const int* valid, RTCRayHit16& rays);

/// Intersects the lanes whose `valid` is -1, as one packet of 16 where the processor has registers
/// that wide, else as two of 8. The rays should run alike.
void intersect(RTCScene scene, QueryContext& context, bool has_wide_packets,
               const Lanes<int>& valid, RayHits& rays);

}  // namespace glidar::embree
