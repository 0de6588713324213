// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

// Eight numbers side by side, in two registers of 128 bits (SSE2, NEON).
#define GLIDAR_INLINE [[gnu::always_inline]] inline

namespace glidar::rays::GLIDAR_KERNEL {

using Quad = float __attribute__((vector_size(16)));
using QuadInMemory = float __attribute__((vector_size(16), may_alias));
using QuadAnywhere = float __attribute__((vector_size(16), may_alias, aligned(4)));
using QuadMask = std::int32_t __attribute__((vector_size(16)));

struct Mask8 {
  QuadMask low;
  QuadMask high;
};

struct Float8 {
  static constexpr unsigned kWidth = 8;
  using Mask = Mask8;
  Quad low;
  Quad high;

  GLIDAR_INLINE static Float8 load(const float* p) {
    return {*reinterpret_cast<const QuadInMemory*>(p),
            *reinterpret_cast<const QuadInMemory*>(p + 4)};
  }
  GLIDAR_INLINE static Float8 load_unaligned(const float* p) {
    return {*reinterpret_cast<const QuadAnywhere*>(p),
            *reinterpret_cast<const QuadAnywhere*>(p + 4)};
  }
  GLIDAR_INLINE static Float8 all(float x) { return {Quad{x, x, x, x}, Quad{x, x, x, x}}; }
  /// Bit i of `bits`: lane i.
  GLIDAR_INLINE static Mask8 mask(std::uint32_t bits) {
    const auto b = static_cast<std::int32_t>(bits);
    const QuadMask low = {b & 1, b & 2, b & 4, b & 8};
    const QuadMask high = {b & 16, b & 32, b & 64, b & 128};
    return {low != 0, high != 0};
  }
};

GLIDAR_INLINE void store(float* p, Float8 a) {
  *reinterpret_cast<QuadInMemory*>(p) = a.low;
  *reinterpret_cast<QuadInMemory*>(p + 4) = a.high;
}
GLIDAR_INLINE void store_unaligned(float* p, Float8 a) {
  *reinterpret_cast<QuadAnywhere*>(p) = a.low;
  *reinterpret_cast<QuadAnywhere*>(p + 4) = a.high;
}
GLIDAR_INLINE Float8 operator+(Float8 a, Float8 b) {
  return {a.low + b.low, a.high + b.high};
}
GLIDAR_INLINE Float8 operator-(Float8 a, Float8 b) {
  return {a.low - b.low, a.high - b.high};
}
GLIDAR_INLINE Float8 operator*(Float8 a, Float8 b) {
  return {a.low * b.low, a.high * b.high};
}
GLIDAR_INLINE Float8 operator/(Float8 a, Float8 b) {
  return {a.low / b.low, a.high / b.high};
}
GLIDAR_INLINE Float8 operator-(Float8 a) {
  return {-a.low, -a.high};
}
/// a b + c, rounded once or twice.
GLIDAR_INLINE Float8 multiply_add(Float8 a, Float8 b, Float8 c) {
  return a * b + c;
}
/// a b - c, rounded once or twice.
GLIDAR_INLINE Float8 multiply_subtract(Float8 a, Float8 b, Float8 c) {
  return a * b - c;
}

GLIDAR_INLINE Mask8 operator<(Float8 a, Float8 b) {
  return {a.low < b.low, a.high < b.high};
}
GLIDAR_INLINE Mask8 operator>(Float8 a, Float8 b) {
  return {a.low > b.low, a.high > b.high};
}
GLIDAR_INLINE Mask8 operator<=(Float8 a, Float8 b) {
  return {a.low <= b.low, a.high <= b.high};
}
GLIDAR_INLINE Mask8 operator&(Mask8 a, Mask8 b) {
  return {a.low & b.low, a.high & b.high};
}
GLIDAR_INLINE Mask8 operator|(Mask8 a, Mask8 b) {
  return {a.low | b.low, a.high | b.high};
}
GLIDAR_INLINE Mask8 operator~(Mask8 a) {
  return {~a.low, ~a.high};
}

/// mask ? a : b
GLIDAR_INLINE Float8 select(Mask8 m, Float8 a, Float8 b) {
  return {m.low ? a.low : b.low, m.high ? a.high : b.high};
}
GLIDAR_INLINE Float8 min(Float8 a, Float8 b) {
  return select(a < b, a, b);
}
GLIDAR_INLINE Float8 max(Float8 a, Float8 b) {
  return select(a > b, a, b);
}

GLIDAR_INLINE Quad square_root(Quad a) {
  return Quad{__builtin_sqrtf(a[0]), __builtin_sqrtf(a[1]), __builtin_sqrtf(a[2]),
              __builtin_sqrtf(a[3])};
}
GLIDAR_INLINE Float8 square_root(Float8 a) {
  return {square_root(a.low), square_root(a.high)};
}

GLIDAR_INLINE float min_of(Float8 a) {
  const Quad x = a.low < a.high ? a.low : a.high;
  const float p = x[0] < x[1] ? x[0] : x[1];
  const float q = x[2] < x[3] ? x[2] : x[3];
  return p < q ? p : q;
}

GLIDAR_INLINE QuadMask bits_of(Quad a) {
  return reinterpret_cast<QuadMask>(a);
}
GLIDAR_INLINE Quad from_bits(QuadMask a) {
  return reinterpret_cast<Quad>(a);
}
GLIDAR_INLINE Float8 magnitude(Float8 a) {
  const QuadMask keep = QuadMask{} + INT32_MAX;
  return {from_bits(bits_of(a.low) & keep), from_bits(bits_of(a.high) & keep)};
}
/// a, negated where b is negative.
GLIDAR_INLINE Float8 flip_sign(Float8 a, Float8 b) {
  const QuadMask sign = QuadMask{} + INT32_MIN;
  return {from_bits(bits_of(a.low) ^ (bits_of(b.low) & sign)),
          from_bits(bits_of(a.high) ^ (bits_of(b.high) & sign))};
}

GLIDAR_INLINE std::uint32_t four_bits(QuadMask m) {
#ifdef __SSE2__
  return static_cast<std::uint32_t>(__builtin_ia32_movmskps(reinterpret_cast<Quad>(m)));
#else
  const QuadMask weights = {1, 2, 4, 8};
  const QuadMask kept = m & weights;
  return static_cast<std::uint32_t>(kept[0] | kept[1] | kept[2] | kept[3]);
#endif
}
/// Bit i: lane i.
GLIDAR_INLINE std::uint32_t bits(Mask8 m) {
  return four_bits(m.low) | four_bits(m.high) << 4U;
}

using LaneFloat = Float8;  ///< for the rays of a packet

}  // namespace glidar::rays::GLIDAR_KERNEL
