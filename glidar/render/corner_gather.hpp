// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/lanes.hpp>
#include <glidar/render/rays/kernel_simd.hpp>

// Loads vectors at vertices one by one and transposes them in registers, as plane_gather.hpp.
namespace glidar::rays::GLIDAR_KERNEL {

#if defined(__AVX2__)

/// Three numbers; the fourth is not read.
GLIDAR_INLINE __m128 load_three(const float* p) {
#if defined(__AVX512VL__)
  return _mm_maskz_loadu_ps(7, p);
#else
  return _mm_maskload_ps(p, _mm_setr_epi32(-1, -1, -1, 0));
#endif
}

/// The vectors at two vertices.
GLIDAR_INLINE __m256 load_two(const float* of_vertex, std::uint32_t low, std::uint32_t high) {
  return _mm256_insertf128_ps(_mm256_castps128_ps256(load_three(of_vertex + std::size_t{3} * low)),
                              load_three(of_vertex + std::size_t{3} * high), 1);
}

inline void gather_corners(const float* of_vertex, const std::uint32_t* vertices,
                           Lanes3<float>& vectors) {
  auto* const x = reinterpret_cast<float*>(&vectors.x);
  auto* const y = reinterpret_cast<float*>(&vectors.y);
  auto* const z = reinterpret_cast<float*>(&vectors.z);
  for (unsigned i = 0; i < kLanes; i += 8) {
    const std::uint32_t* const v = vertices + i;
    const __m256 a = load_two(of_vertex, v[0], v[4]);
    const __m256 b = load_two(of_vertex, v[1], v[5]);
    const __m256 c = load_two(of_vertex, v[2], v[6]);
    const __m256 d = load_two(of_vertex, v[3], v[7]);
    const __m256d ab = _mm256_castps_pd(_mm256_unpacklo_ps(a, b));
    const __m256d cd = _mm256_castps_pd(_mm256_unpacklo_ps(c, d));
    const __m256d ab_z = _mm256_castps_pd(_mm256_unpackhi_ps(a, b));
    const __m256d cd_z = _mm256_castps_pd(_mm256_unpackhi_ps(c, d));
    _mm256_store_ps(x + i, _mm256_castpd_ps(_mm256_unpacklo_pd(ab, cd)));
    _mm256_store_ps(y + i, _mm256_castpd_ps(_mm256_unpackhi_pd(ab, cd)));
    _mm256_store_ps(z + i, _mm256_castpd_ps(_mm256_unpacklo_pd(ab_z, cd_z)));
  }
}

#else

inline void gather_corners(const float* of_vertex, const std::uint32_t* vertices,
                           Lanes3<float>& vectors) {
  for (unsigned i = 0; i < kLanes; ++i) {
    const float* const vector = of_vertex + std::size_t{3} * vertices[i];
    vectors.x[i] = vector[0];
    vectors.y[i] = vector[1];
    vectors.z[i] = vector[2];
  }
}

#endif

}  // namespace glidar::rays::GLIDAR_KERNEL
