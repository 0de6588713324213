// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/rays/simd_avx2.hpp>

// Sixteen numbers side by side in a register of AVX-512; eight as with AVX2.
namespace glidar::rays::GLIDAR_KERNEL {

struct Mask16 {
  __mmask16 v;
};

struct Float16 {
  static constexpr unsigned kWidth = 16;
  using Mask = Mask16;
  __m512 v;

  GLIDAR_INLINE static Float16 load(const float* p) { return {_mm512_load_ps(p)}; }
  GLIDAR_INLINE static Float16 all(float x) { return {_mm512_set1_ps(x)}; }
  GLIDAR_INLINE static Mask16 mask(std::uint32_t bits) { return {static_cast<__mmask16>(bits)}; }
};

GLIDAR_INLINE void store(float* p, Float16 a) {
  _mm512_store_ps(p, a.v);
}
GLIDAR_INLINE Float16 operator+(Float16 a, Float16 b) {
  return {_mm512_add_ps(a.v, b.v)};
}
GLIDAR_INLINE Float16 operator-(Float16 a, Float16 b) {
  return {_mm512_sub_ps(a.v, b.v)};
}
GLIDAR_INLINE Float16 operator*(Float16 a, Float16 b) {
  return {_mm512_mul_ps(a.v, b.v)};
}
GLIDAR_INLINE Float16 operator/(Float16 a, Float16 b) {
  return {_mm512_div_ps(a.v, b.v)};
}
GLIDAR_INLINE Float16 operator-(Float16 a) {
  return {_mm512_xor_ps(a.v, _mm512_set1_ps(-0.0F))};
}
GLIDAR_INLINE Float16 multiply_add(Float16 a, Float16 b, Float16 c) {
  return {_mm512_fmadd_ps(a.v, b.v, c.v)};
}
GLIDAR_INLINE Float16 multiply_subtract(Float16 a, Float16 b, Float16 c) {
  return {_mm512_fmsub_ps(a.v, b.v, c.v)};
}

GLIDAR_INLINE Mask16 operator<(Float16 a, Float16 b) {
  return {_mm512_cmp_ps_mask(a.v, b.v, _CMP_LT_OQ)};
}
GLIDAR_INLINE Mask16 operator>(Float16 a, Float16 b) {
  return {_mm512_cmp_ps_mask(a.v, b.v, _CMP_GT_OQ)};
}
GLIDAR_INLINE Mask16 operator<=(Float16 a, Float16 b) {
  return {_mm512_cmp_ps_mask(a.v, b.v, _CMP_LE_OQ)};
}
GLIDAR_INLINE Mask16 operator&(Mask16 a, Mask16 b) {
  return {_kand_mask16(a.v, b.v)};
}
GLIDAR_INLINE Mask16 operator|(Mask16 a, Mask16 b) {
  return {_kor_mask16(a.v, b.v)};
}
GLIDAR_INLINE Mask16 operator~(Mask16 a) {
  return {_knot_mask16(a.v)};
}

GLIDAR_INLINE Float16 select(Mask16 m, Float16 a, Float16 b) {
  return {_mm512_mask_blend_ps(m.v, b.v, a.v)};
}
GLIDAR_INLINE Float16 min(Float16 a, Float16 b) {
  return {_mm512_min_ps(a.v, b.v)};
}
GLIDAR_INLINE Float16 max(Float16 a, Float16 b) {
  return {_mm512_max_ps(a.v, b.v)};
}
GLIDAR_INLINE Float16 square_root(Float16 a) {
  return {_mm512_sqrt_ps(a.v)};
}
GLIDAR_INLINE Float16 magnitude(Float16 a) {
  return {_mm512_abs_ps(a.v)};
}
GLIDAR_INLINE Float16 flip_sign(Float16 a, Float16 b) {
  return {_mm512_xor_ps(a.v, _mm512_and_ps(b.v, _mm512_set1_ps(-0.0F)))};
}
GLIDAR_INLINE std::uint32_t bits(Mask16 m) {
  return m.v;
}

GLIDAR_INLINE float min_of(Float16 a) {
  return min_of(Float8{_mm256_min_ps(_mm512_castps512_ps256(a.v), _mm512_extractf32x8_ps(a.v, 1))});
}

using LaneFloat = Float16;

}  // namespace glidar::rays::GLIDAR_KERNEL
