// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <immintrin.h>
#include <cstdint>

// Eight numbers side by side, as simd_portable.hpp, in a register of AVX2.
#define GLIDAR_INLINE [[gnu::always_inline]] inline

namespace glidar::rays::GLIDAR_KERNEL {

struct Mask8 {
  __m256 v;
};

struct Float8 {
  static constexpr unsigned kWidth = 8;
  using Mask = Mask8;
  __m256 v;

  GLIDAR_INLINE static Float8 load(const float* p) { return {_mm256_load_ps(p)}; }
  GLIDAR_INLINE static Float8 load_unaligned(const float* p) { return {_mm256_loadu_ps(p)}; }
  GLIDAR_INLINE static Float8 all(float x) { return {_mm256_set1_ps(x)}; }
  GLIDAR_INLINE static Mask8 mask(std::uint32_t bits) {
    const __m256i of_lane = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
    const __m256i kept = _mm256_and_si256(_mm256_set1_epi32(static_cast<int>(bits)), of_lane);
    return {_mm256_castsi256_ps(_mm256_cmpeq_epi32(kept, of_lane))};
  }
};

GLIDAR_INLINE void store(float* p, Float8 a) {
  _mm256_store_ps(p, a.v);
}
GLIDAR_INLINE void store_unaligned(float* p, Float8 a) {
  _mm256_storeu_ps(p, a.v);
}
GLIDAR_INLINE Float8 operator+(Float8 a, Float8 b) {
  return {_mm256_add_ps(a.v, b.v)};
}
GLIDAR_INLINE Float8 operator-(Float8 a, Float8 b) {
  return {_mm256_sub_ps(a.v, b.v)};
}
GLIDAR_INLINE Float8 operator*(Float8 a, Float8 b) {
  return {_mm256_mul_ps(a.v, b.v)};
}
GLIDAR_INLINE Float8 operator/(Float8 a, Float8 b) {
  return {_mm256_div_ps(a.v, b.v)};
}
GLIDAR_INLINE Float8 operator-(Float8 a) {
  return {_mm256_xor_ps(a.v, _mm256_set1_ps(-0.0F))};
}
GLIDAR_INLINE Float8 multiply_add(Float8 a, Float8 b, Float8 c) {
  return {_mm256_fmadd_ps(a.v, b.v, c.v)};
}
GLIDAR_INLINE Float8 multiply_subtract(Float8 a, Float8 b, Float8 c) {
  return {_mm256_fmsub_ps(a.v, b.v, c.v)};
}

GLIDAR_INLINE Mask8 operator<(Float8 a, Float8 b) {
  return {_mm256_cmp_ps(a.v, b.v, _CMP_LT_OQ)};
}
GLIDAR_INLINE Mask8 operator>(Float8 a, Float8 b) {
  return {_mm256_cmp_ps(a.v, b.v, _CMP_GT_OQ)};
}
GLIDAR_INLINE Mask8 operator<=(Float8 a, Float8 b) {
  return {_mm256_cmp_ps(a.v, b.v, _CMP_LE_OQ)};
}
GLIDAR_INLINE Mask8 operator&(Mask8 a, Mask8 b) {
  return {_mm256_and_ps(a.v, b.v)};
}
GLIDAR_INLINE Mask8 operator|(Mask8 a, Mask8 b) {
  return {_mm256_or_ps(a.v, b.v)};
}
GLIDAR_INLINE Mask8 operator~(Mask8 a) {
  return {_mm256_xor_ps(a.v, _mm256_castsi256_ps(_mm256_set1_epi32(-1)))};
}

GLIDAR_INLINE Float8 select(Mask8 m, Float8 a, Float8 b) {
  return {_mm256_blendv_ps(b.v, a.v, m.v)};
}
GLIDAR_INLINE Float8 min(Float8 a, Float8 b) {
  return {_mm256_min_ps(a.v, b.v)};
}
GLIDAR_INLINE Float8 max(Float8 a, Float8 b) {
  return {_mm256_max_ps(a.v, b.v)};
}
GLIDAR_INLINE Float8 square_root(Float8 a) {
  return {_mm256_sqrt_ps(a.v)};
}
GLIDAR_INLINE Float8 magnitude(Float8 a) {
  return {_mm256_andnot_ps(_mm256_set1_ps(-0.0F), a.v)};
}
GLIDAR_INLINE Float8 flip_sign(Float8 a, Float8 b) {
  return {_mm256_xor_ps(a.v, _mm256_and_ps(b.v, _mm256_set1_ps(-0.0F)))};
}
GLIDAR_INLINE std::uint32_t bits(Mask8 m) {
  return static_cast<std::uint32_t>(_mm256_movemask_ps(m.v));
}

GLIDAR_INLINE float min_of(Float8 a) {
  __m128 x = _mm_min_ps(_mm256_castps256_ps128(a.v), _mm256_extractf128_ps(a.v, 1));
  x = _mm_min_ps(x, _mm_movehl_ps(x, x));
  return _mm_cvtss_f32(_mm_min_ss(x, _mm_shuffle_ps(x, x, 1)));
}

#ifndef __AVX512F__
using LaneFloat = Float8;
#endif

}  // namespace glidar::rays::GLIDAR_KERNEL
