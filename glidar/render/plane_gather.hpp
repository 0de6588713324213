// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/lanes.hpp>
#include <glidar/render/rays/kernel_simd.hpp>

// Loads planes of triangles row by row and transposes them in registers: vectors that are written
// number by number are slow to load. In namespace glidar::rays::GLIDAR_KERNEL.
namespace glidar::rays::GLIDAR_KERNEL {

/// Columns of planes, kLanes numbers each.
struct PlaneColumns {
  double* x;
  double* y;
  double* z;
  double* offset;
};

#if defined(__AVX512F__)

GLIDAR_INLINE __m512d two_planes(const double* low, const double* high) {
  return _mm512_insertf64x4(_mm512_castpd256_pd512(_mm256_loadu_pd(low)), _mm256_loadu_pd(high), 1);
}

/// planes: four numbers each.
GLIDAR_INLINE void gather_planes(const double* planes, const std::uint32_t* primitive,
                                 const PlaneColumns& to) {
  const __m512i low = _mm512_setr_epi64(0, 1, 8, 9, 4, 5, 12, 13);
  const __m512i high = _mm512_setr_epi64(2, 3, 10, 11, 6, 7, 14, 15);
  for (unsigned i = 0; i < kLanes; i += 8) {
    const __m512d a = two_planes(planes + std::size_t{4} * primitive[i],
                                 planes + std::size_t{4} * primitive[i + 4]);
    const __m512d b = two_planes(planes + std::size_t{4} * primitive[i + 1],
                                 planes + std::size_t{4} * primitive[i + 5]);
    const __m512d c = two_planes(planes + std::size_t{4} * primitive[i + 2],
                                 planes + std::size_t{4} * primitive[i + 6]);
    const __m512d d = two_planes(planes + std::size_t{4} * primitive[i + 3],
                                 planes + std::size_t{4} * primitive[i + 7]);
    const __m512d ab_even = _mm512_unpacklo_pd(a, b);
    const __m512d ab_odd = _mm512_unpackhi_pd(a, b);
    const __m512d cd_even = _mm512_unpacklo_pd(c, d);
    const __m512d cd_odd = _mm512_unpackhi_pd(c, d);
    _mm512_store_pd(to.x + i, _mm512_permutex2var_pd(ab_even, low, cd_even));
    _mm512_store_pd(to.y + i, _mm512_permutex2var_pd(ab_odd, low, cd_odd));
    _mm512_store_pd(to.z + i, _mm512_permutex2var_pd(ab_even, high, cd_even));
    _mm512_store_pd(to.offset + i, _mm512_permutex2var_pd(ab_odd, high, cd_odd));
  }
}

#elif defined(__AVX2__)

GLIDAR_INLINE void gather_planes(const double* planes, const std::uint32_t* primitive,
                                 const PlaneColumns& to) {
  for (unsigned i = 0; i < kLanes; i += 4) {
    const __m256d a = _mm256_loadu_pd(planes + std::size_t{4} * primitive[i]);
    const __m256d b = _mm256_loadu_pd(planes + std::size_t{4} * primitive[i + 1]);
    const __m256d c = _mm256_loadu_pd(planes + std::size_t{4} * primitive[i + 2]);
    const __m256d d = _mm256_loadu_pd(planes + std::size_t{4} * primitive[i + 3]);
    const __m256d ab_even = _mm256_unpacklo_pd(a, b);
    const __m256d ab_odd = _mm256_unpackhi_pd(a, b);
    const __m256d cd_even = _mm256_unpacklo_pd(c, d);
    const __m256d cd_odd = _mm256_unpackhi_pd(c, d);
    _mm256_store_pd(to.x + i, _mm256_permute2f128_pd(ab_even, cd_even, 0x20));
    _mm256_store_pd(to.y + i, _mm256_permute2f128_pd(ab_odd, cd_odd, 0x20));
    _mm256_store_pd(to.z + i, _mm256_permute2f128_pd(ab_even, cd_even, 0x31));
    _mm256_store_pd(to.offset + i, _mm256_permute2f128_pd(ab_odd, cd_odd, 0x31));
  }
}

#else

GLIDAR_INLINE void gather_planes(const double* planes, const std::uint32_t* primitive,
                                 const PlaneColumns& to) {
  for (unsigned i = 0; i < kLanes; ++i) {
    const double* const plane = planes + std::size_t{4} * primitive[i];
    to.x[i] = plane[0];
    to.y[i] = plane[1];
    to.z[i] = plane[2];
    to.offset[i] = plane[3];
  }
}

#endif

}  // namespace glidar::rays::GLIDAR_KERNEL
