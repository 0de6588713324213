// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "raw_rays.hpp"

namespace glidar::bench {
namespace {

constexpr float kFar = 1e30F;

/// Works for Embree's packets of 8 and 16.
template <class Packet>
void set_lane(Packet& packet, unsigned lane, const RayList::Ray& ray) {
  const Eigen::Vector3f o = ray.origin.cast<float>();
  const Eigen::Vector3f d = ray.direction.cast<float>();
  packet.ray.org_x[lane] = o.x();
  packet.ray.org_y[lane] = o.y();
  packet.ray.org_z[lane] = o.z();
  packet.ray.dir_x[lane] = d.x();
  packet.ray.dir_y[lane] = d.y();
  packet.ray.dir_z[lane] = d.z();
  packet.ray.tnear[lane] = 0.0F;
  packet.ray.tfar[lane] = kFar;
  packet.ray.time[lane] = 0.0F;
  packet.ray.mask[lane] = ~0U;
  packet.ray.id[lane] = lane;
  packet.ray.flags[lane] = 0;
  packet.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
  packet.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
}

template <class Packet>
void store_lane(const Packet& packet, unsigned lane, std::size_t index, HitList& hits) {
  hits.range_m[index] = packet.ray.tfar[lane];
  hits.normal[index] =
      Eigen::Vector3f(packet.hit.Ng_x[lane], packet.hit.Ng_y[lane], packet.hit.Ng_z[lane])
          .normalized();
  hits.instance[index] = packet.hit.geomID[lane];
  hits.primitive[index] = packet.hit.primID[lane];
}

}  // namespace

void HitList::resize(std::size_t count) {
  range_m.resize(count);
  normal.resize(count);
  instance.resize(count);
  primitive.resize(count);
}

RawRays::RawRays(const Mesh& mesh, const RayList& list, unsigned packet_size,
                 const std::string& isa)
    : list_(list),
      packet_size_(packet_size),
      device_(rtcNewDevice(isa.empty() ? nullptr : ("isa=" + isa).c_str())),
      scene_(make_embree_scene(device_, mesh)) {
  hits_.resize(list.rays.size());
}

RawRays::~RawRays() {
  rtcReleaseScene(scene_);
  rtcReleaseDevice(device_);
}

void RawRays::cast() {
  for (std::size_t first = 0; first < list_.rays.size(); first += packet_size_) {
    if (packet_size_ == 16) cast16(first);
    if (packet_size_ == 8) cast8(first);
    if (packet_size_ == 1) cast1(first);
  }
}

#ifdef GLIDAR_EMBREE_4
#define GLIDAR_EMBREE_FLAG(name) RTC_RAY_QUERY_FLAG_##name
#define GLIDAR_EMBREE_CONTEXT(flag)    \
  RTCIntersectArguments context;       \
  rtcInitIntersectArguments(&context); \
  context.flags = (flag);              \
  context.feature_mask = RTC_FEATURE_FLAG_TRIANGLE
#define GLIDAR_EMBREE_CALL(function, valid, packet) (function)(valid, scene_, &(packet), &context)
#else
#define GLIDAR_EMBREE_FLAG(name) RTC_INTERSECT_CONTEXT_FLAG_##name
#define GLIDAR_EMBREE_CONTEXT(flag)  \
  RTCIntersectContext context;       \
  rtcInitIntersectContext(&context); \
  context.flags = (flag)
#define GLIDAR_EMBREE_CALL(function, valid, packet) (function)(valid, scene_, &context, &(packet))
#endif

void RawRays::cast16(std::size_t first) {
  alignas(64) RTCRayHit16 packet;
  alignas(64) int valid[16];
  for (unsigned i = 0; i < 16; ++i) {
    valid[i] = -1;
    set_lane(packet, i, list_.rays[first + i]);
  }
  GLIDAR_EMBREE_CONTEXT(list_.is_coherent ? GLIDAR_EMBREE_FLAG(COHERENT)
                                          : GLIDAR_EMBREE_FLAG(INCOHERENT));
  GLIDAR_EMBREE_CALL(rtcIntersect16, valid, packet);
  for (unsigned i = 0; i < 16; ++i) store_lane(packet, i, first + i, hits_);
}

void RawRays::cast8(std::size_t first) {
  alignas(32) RTCRayHit8 packet;
  alignas(32) int valid[8];
  for (unsigned i = 0; i < 8; ++i) {
    valid[i] = -1;
    set_lane(packet, i, list_.rays[first + i]);
  }
  GLIDAR_EMBREE_CONTEXT(list_.is_coherent ? GLIDAR_EMBREE_FLAG(COHERENT)
                                          : GLIDAR_EMBREE_FLAG(INCOHERENT));
  GLIDAR_EMBREE_CALL(rtcIntersect8, valid, packet);
  for (unsigned i = 0; i < 8; ++i) store_lane(packet, i, first + i, hits_);
}

void RawRays::cast1(std::size_t index) {
  const RayList::Ray& ray = list_.rays[index];
  const Eigen::Vector3f o = ray.origin.cast<float>();
  const Eigen::Vector3f d = ray.direction.cast<float>();
  alignas(16) RTCRayHit hit;
  hit.ray = {o.x(), o.y(), o.z(), 0.0F, d.x(), d.y(), d.z(), 0.0F, kFar, ~0U, 0, 0};
  hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  GLIDAR_EMBREE_CONTEXT(GLIDAR_EMBREE_FLAG(INCOHERENT));
#ifdef GLIDAR_EMBREE_4
  rtcIntersect1(scene_, &hit, &context);
#else
  rtcIntersect1(scene_, &context, &hit);
#endif
  hits_.range_m[index] = hit.ray.tfar;
  hits_.normal[index] = Eigen::Vector3f(hit.hit.Ng_x, hit.hit.Ng_y, hit.hit.Ng_z).normalized();
  hits_.instance[index] = hit.hit.geomID;
  hits_.primitive[index] = hit.hit.primID;
}

}  // namespace glidar::bench
