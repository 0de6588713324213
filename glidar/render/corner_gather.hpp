// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/block_kernel.hpp>
#include <glidar/render/rays/kernel_simd.hpp>

// Loads vectors at the corners of triangles one by one and transposes them in registers: vectors
// that are written number by number are slow to load. In namespace glidar::rays::GLIDAR_KERNEL.
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

/// Writes corner k of eight triangles to lanes [first, first + 8).
GLIDAR_INLINE void gather_corner(const float* of_vertex, const std::uint32_t* const (&triangle)[8],
                                 unsigned k, unsigned first, Lanes3<float>& to) {
  const __m256 a = load_two(of_vertex, triangle[0][k], triangle[4][k]);
  const __m256 b = load_two(of_vertex, triangle[1][k], triangle[5][k]);
  const __m256 c = load_two(of_vertex, triangle[2][k], triangle[6][k]);
  const __m256 d = load_two(of_vertex, triangle[3][k], triangle[7][k]);
  const __m256d ab = _mm256_castps_pd(_mm256_unpacklo_ps(a, b));
  const __m256d cd = _mm256_castps_pd(_mm256_unpacklo_ps(c, d));
  const __m256d ab_z = _mm256_castps_pd(_mm256_unpackhi_ps(a, b));
  const __m256d cd_z = _mm256_castps_pd(_mm256_unpackhi_ps(c, d));
  const auto store_at = [first](Lanes<float>& lanes, __m256d numbers) {
    _mm256_store_ps(reinterpret_cast<float*>(&lanes) + first, _mm256_castpd_ps(numbers));
  };
  store_at(to.x, _mm256_unpacklo_pd(ab, cd));
  store_at(to.y, _mm256_unpackhi_pd(ab, cd));
  store_at(to.z, _mm256_unpacklo_pd(ab_z, cd_z));
}

GLIDAR_INLINE void gather_lanes(const TrianglesToGather& from, CornerBlock& to) {
  for (unsigned first = 0; first < kLanes; first += 8) {
    const std::uint32_t* triangle[8];
    for (unsigned i = 0; i < 8; ++i) {
      triangle[i] = from.vertices + std::size_t{3} * from.primitive[first + i];
    }
    gather_corner(from.of_vertex, triangle, 0, first, to.c0);
    gather_corner(from.of_vertex, triangle, 1, first, to.c1);
    gather_corner(from.of_vertex, triangle, 2, first, to.c2);
  }
}

#else

GLIDAR_INLINE void gather_lanes(const TrianglesToGather& from, CornerBlock& to) {
  Lanes3<float>* const corners[3] = {&to.c0, &to.c1, &to.c2};
  for (unsigned i = 0; i < kLanes; ++i) {
    const std::uint32_t* const triangle = from.vertices + std::size_t{3} * from.primitive[i];
    for (unsigned k = 0; k < 3; ++k) {
      const float* const vector = from.of_vertex + std::size_t{3} * triangle[k];
      corners[k]->x.at[i] = vector[0];
      corners[k]->y.at[i] = vector[1];
      corners[k]->z.at[i] = vector[2];
    }
  }
}

#endif

}  // namespace glidar::rays::GLIDAR_KERNEL
