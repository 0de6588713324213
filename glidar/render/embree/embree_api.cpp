// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/embree/embree_api.hpp>

#include <algorithm>

namespace glidar::embree {
namespace {

constexpr std::size_t kHalf = 8;
// RTCRay8 and RTCRay16 are the same arrays of 4-byte numbers, of 8 and of 16 lanes.
constexpr std::size_t kRayArrays = sizeof(RTCRay8) / (kHalf * sizeof(float));
constexpr std::size_t kHitArrays = sizeof(RTCHit8) / (kHalf * sizeof(float));
static_assert(sizeof(RTCRay16) == kRayArrays * kLanes * sizeof(float));
static_assert(sizeof(RTCHit16) == kHitArrays * kLanes * sizeof(float));

void copy_half(const void* from, std::size_t from_lanes, void* to, std::size_t to_lanes,
               std::size_t arrays) {
  for (std::size_t i = 0; i < arrays; ++i) {
    std::copy_n(static_cast<const std::byte*>(from) + i * from_lanes * sizeof(float),
                kHalf * sizeof(float), static_cast<std::byte*>(to) + i * to_lanes * sizeof(float));
  }
}

#ifdef GLIDAR_EMBREE_4
RTCIntersectArguments arguments(QueryContext& context, RTCRayQueryFlags flags) {
  RTCIntersectArguments all;
  rtcInitIntersectArguments(&all);
  all.flags = flags;
  all.context = &context;
  return all;
}
#endif

void intersect_half(RTCScene scene, QueryContext& context, const int* valid, RTCRayHit8& rays) {
#ifdef GLIDAR_EMBREE_4
  RTCIntersectArguments all = arguments(context, RTC_RAY_QUERY_FLAG_COHERENT);
  rtcIntersect8(valid, scene, &rays, &all);
#else
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect8(valid, scene, &context, &rays);
#endif
}

}  // namespace

void init_context(QueryContext& context) {
#ifdef GLIDAR_EMBREE_4
  rtcInitRayQueryContext(&context);
#else
  rtcInitIntersectContext(&context);
#endif
}

void intersect_packet(RTCScene scene, QueryContext& context, const int* valid, RTCRayHit16& rays) {
#ifdef GLIDAR_EMBREE_4
  RTCIntersectArguments all = arguments(context, RTC_RAY_QUERY_FLAG_COHERENT);
  rtcIntersect16(valid, scene, &rays, &all);
#else
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect16(valid, scene, &context, &rays);
#endif
}

void intersect(RTCScene scene, QueryContext& context, bool has_wide_packets,
               const Lanes<int>& valid, RayHits& rays) {
  if (has_wide_packets) {
    intersect_packet(scene, context, valid.at.data(), rays);
    return;
  }
  for (unsigned first = 0; first < kLanes; first += kHalf) {
    RTCRayHit8 half;
    alignas(32) std::array<int, kHalf> half_valid;
    std::copy_n(valid.at.begin() + first, kHalf, half_valid.begin());
    copy_half(&rays.ray.org_x[first], kLanes, &half.ray, kHalf, kRayArrays);
    copy_half(&rays.hit.Ng_x[first], kLanes, &half.hit, kHalf, kHitArrays);
    intersect_half(scene, context, half_valid.data(), half);
    copy_half(&half.ray, kHalf, &rays.ray.org_x[first], kLanes, kRayArrays);
    copy_half(&half.hit, kHalf, &rays.hit.Ng_x[first], kLanes, kHitArrays);
  }
}

}  // namespace glidar::embree
