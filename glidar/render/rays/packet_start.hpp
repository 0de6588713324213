// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/rays/ray_packet.hpp>

// Completes a packet whose exact rays are set.
namespace glidar::rays::GLIDAR_KERNEL {

inline constexpr float kFloatInfinity = __builtin_huge_valf();

GLIDAR_INLINE double larger(double a, double b) {
  return a > b ? a : b;
}
GLIDAR_INLINE float larger(float a, float b) {
  return a > b ? a : b;
}

/// The minimum of sixteen values.
GLIDAR_INLINE float min_lane(const float* of_lane) {
  LaneFloat lowest = LaneFloat::load(of_lane);
  for (unsigned i = LaneFloat::kWidth; i < kPacketSize; i += LaneFloat::kWidth) {
    lowest = min(lowest, LaneFloat::load(of_lane + i));
  }
  return min_of(lowest);
}

GLIDAR_INLINE float max_lane(const float* of_lane) {
  LaneFloat highest = LaneFloat::load(of_lane);
  for (unsigned i = LaneFloat::kWidth; i < kPacketSize; i += LaneFloat::kWidth) {
    highest = max(highest, LaneFloat::load(of_lane + i));
  }
  return -min_of(-highest);
}

/// Distance along each ray to the mesh's sphere, for rays that start far from it; otherwise 0.
GLIDAR_INLINE void set_shifts(RayPacket& p, const MeshSphere& sphere) {
  const double near = 1.001 * sphere.radius;
  const double limit = kUnmovedRadii * sphere.radius * kUnmovedRadii * sphere.radius;
  for (unsigned i = 0; i < kPacketSize; ++i) {
    const double x = sphere.centre[0] - p.exact_origin[0][i];
    const double y = sphere.centre[1] - p.exact_origin[1][i];
    const double z = sphere.centre[2] - p.exact_origin[2][i];
    const double along = x * p.exact_direction[0][i] + y * p.exact_direction[1][i] +
                         z * p.exact_direction[2][i] - near;
    const double shift = along > 0.0 ? along : 0.0;
    p.shift[i] = x * x + y * y + z * z <= limit ? 0.0 : shift;
  }
}

/// Bounds, per axis, the distance between a ray in single precision and the true one within the
/// mesh. Rounding the origin moves it by u |o|, rounding the direction by t u |d| at distance t,
/// where u = 2^-24, |o| <= |c| + |o - c| and t <= |o - c| + R. Computing o + shift d in double adds
/// 2^-53 of the numbers in it, and rounding o +- padding to single precision another u |o|.
GLIDAR_INLINE void find_padding(const RayPacket& p, const MeshSphere& sphere, double* padding,
                                float* rounding) {
  double reach = 0.0;
  for (const double x : sphere.centre) reach = larger(reach, __builtin_fabs(x));
  reach += sphere.radius;
  for (unsigned i = 0; i < kPacketSize; ++i) {
    double distance = 0.0;
    double size = 0.0;
    for (unsigned axis = 0; axis < 3; ++axis) {
      const double o = p.exact_origin[axis][i];
      const double moved = o + p.shift[i] * p.exact_direction[axis][i];
      distance += __builtin_fabs(moved - sphere.centre[axis]);
      size += __builtin_fabs(o);
    }
    const double rounded = 2.0 * p.shift[i] + size;
    padding[i] = 0x1p-22 * (2.0 * distance + reach) + 0x1p-50 * rounded;
    // Bounds of distances include ties: 12 u 2^-26 of it is at least kTiePart tie_reach.
    rounding[i] = static_cast<float>((1.0 + 0x1p-22) * (rounded + 0x1p4 * p.tie_reach));
  }
}

GLIDAR_INLINE void round_rays(RayPacket& p, const double* padding) {
  for (unsigned axis = 0; axis < 3; ++axis) {
    for (unsigned i = 0; i < kPacketSize; ++i) {
      const double d = p.exact_direction[axis][i];
      const double o = p.exact_origin[axis][i] + p.shift[i] * d;
      p.direction[axis][i] = static_cast<float>(d);
      p.origin_low[axis][i] = static_cast<float>(o - padding[i]);
      p.origin_high[axis][i] = static_cast<float>(o + padding[i]);
    }
  }
  for (unsigned i = 0; i < kPacketSize; ++i) {
    const auto near = static_cast<float>(-p.shift[i]);
    p.near_low[i] = near + 0x1p-22F * near;  // near is not positive
    p.near_high[i] = near - 0x1p-22F * near;
  }
}

/// The middle and half width of the directions, including all rounding errors.
GLIDAR_INLINE void bound_directions(RayPacket& p) {
  for (unsigned axis = 0; axis < 3; ++axis) {
    const float low = min_lane(p.direction[axis]);
    const float high = max_lane(p.direction[axis]);
    p.middle[axis] = 0.5F * (low + high);
    p.half[axis] = 0.5F * (high - low) + 0x1p-22F;
  }
}

GLIDAR_INLINE bool have_common_origin(const RayPacket& p) {
  unsigned others = 0;
  for (unsigned i = 0; i < kPacketSize; ++i) {
    others += static_cast<unsigned>(p.exact_origin[0][i] != p.exact_origin[0][0]) |
              static_cast<unsigned>(p.exact_origin[1][i] != p.exact_origin[1][0]) |
              static_cast<unsigned>(p.exact_origin[2][i] != p.exact_origin[2][0]) |
              static_cast<unsigned>(p.shift[i] != 0.0);
  }
  return others == 0;
}

/// offset = shifted origins - from, along one axis.
GLIDAR_INLINE void set_offsets(RayPacket& p, unsigned axis, double from) {
  for (unsigned i = 0; i < kPacketSize; ++i) {
    const double moved = p.exact_origin[axis][i] + p.shift[i] * p.exact_direction[axis][i];
    p.offset[axis][i] = static_cast<float>(moved - from);
  }
}

/// The shifted origins relative to their middle, along one axis. Their bounds are found in single
/// precision, relative to the first one. Returns the maximum distance from the middle.
GLIDAR_INLINE float find_offsets(RayPacket& p, unsigned axis) {
  const float* offset = p.offset[axis];
  const double first = p.exact_origin[axis][0] + p.shift[0] * p.exact_direction[axis][0];
  set_offsets(p, axis, first);
  const double middle = first + 0.5 * static_cast<double>(min_lane(offset) + max_lane(offset));
  p.middle_origin[axis] = middle;
  set_offsets(p, axis, middle);
  return larger(max_lane(offset), -min_lane(offset));
}

GLIDAR_INLINE void find_moments(RayPacket& p, unsigned axis) {
  const unsigned next = (axis + 1) % 3;
  const unsigned last = (axis + 2) % 3;
  for (unsigned i = 0; i < kPacketSize; ++i) {
    p.moment[axis][i] =
        p.direction[next][i] * p.offset[last][i] - p.direction[last][i] * p.offset[next][i];
  }
}

/// Axis by axis without a loop: compilers unroll inner loops before they vectorise.
GLIDAR_INLINE void find_offsets(RayPacket& p) {
  p.spread = 0.0;
  for (unsigned axis = 0; axis < 3; ++axis) p.middle_origin[axis] = p.exact_origin[axis][0];
  if (p.has_common_origin) return;
  const float x = find_offsets(p, 0);
  const float y = find_offsets(p, 1);
  const float z = find_offsets(p, 2);
  p.spread = (1.0 + 0x1p-22) * static_cast<double>(larger(larger(x, y), z));
  find_moments(p, 0);
  find_moments(p, 1);
  find_moments(p, 2);
}

/// Inactive rays repeat the first active one, so that bounds of all rays are those of the active
/// ones. They are never tested.
GLIDAR_INLINE void repeat_ray(RayPacket& p, std::uint32_t active) {
  const auto first = static_cast<unsigned>(__builtin_ctz(active));
  for (unsigned i = 0; i < kPacketSize; ++i) {
    if ((active >> i & 1U) != 0) continue;
    p.high[i] = p.low[i] = -kFloatInfinity;
    for (unsigned axis = 0; axis < 3; ++axis) {
      p.exact_direction[axis][i] = p.exact_direction[axis][first];
      p.exact_origin[axis][i] = p.exact_origin[axis][first];
    }
  }
}

inline void start(RayPacket& p, const MeshSphere& sphere, std::uint32_t active) {
  for (unsigned i = 0; i < kPacketSize; ++i) {
    p.low[i] = kFloatInfinity;
    p.high[i] = kFloatInfinity;
    p.slot[i] = kNoTriangle;
  }
  if (active != (1U << kPacketSize) - 1U) repeat_ray(p, active);
  p.active = active;
  p.known = 0;
  p.prepared = 0;
  p.exact_tests = 0;
  p.tied = 0;
  alignas(64) double padding[kPacketSize];
  alignas(64) float rounding[kPacketSize];
  set_shifts(p, sphere);
  find_padding(p, sphere, padding, rounding);
  round_rays(p, padding);
  p.rounding = static_cast<double>(max_lane(rounding));
  p.has_common_origin = have_common_origin(p);
  find_offsets(p);
  bound_directions(p);
}

}  // namespace glidar::rays::GLIDAR_KERNEL
