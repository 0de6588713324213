// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/block_kernel.hpp>

#include <glidar/render/lanes.hpp>
#include <glidar/render/rays/kernel_simd.hpp>

#include <cstddef>

namespace glidar::rays::GLIDAR_KERNEL {

// Loads planes of triangles row by row and transposes them in registers: vectors that are written
// number by number are slow to load. In namespace glidar::rays::GLIDAR_KERNEL.

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

// Compiled once for every instruction set, under the rules of rays/kernel.cpp.

namespace glidar::rays::GLIDAR_KERNEL {

// Loads vectors at the corners of triangles one by one and transposes them in registers: vectors
// that are written number by number are slow to load. In namespace glidar::rays::GLIDAR_KERNEL.

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

namespace {

#if defined(__AVX512F__)
constexpr unsigned kWidth = 8;
#elif defined(__AVX2__)
constexpr unsigned kWidth = 4;
#else
constexpr unsigned kWidth = 2;
#endif
using Vector = double __attribute__((vector_size(kWidth * sizeof(double)), may_alias));
using VectorMask = long long __attribute__((vector_size(kWidth * sizeof(double))));
using FloatVector = float __attribute__((vector_size(kWidth * sizeof(float)), may_alias));

GLIDAR_INLINE Vector square_root(Vector x) {
#if defined(__AVX512F__)
  return _mm512_sqrt_pd(x);
#elif defined(__AVX2__)
  return _mm256_sqrt_pd(x);
#elif defined(__SSE2__)
  return _mm_sqrt_pd(x);
#else
  return Vector{__builtin_sqrt(x[0]), __builtin_sqrt(x[1])};
#endif
}

GLIDAR_INLINE double* numbers(Lanes<double>& lanes) {
  return reinterpret_cast<double*>(&lanes);
}
GLIDAR_INLINE const double* numbers(const Lanes<double>& lanes) {
  return reinterpret_cast<const double*>(&lanes);
}

/// out = matrix * in, as rotate(); the matrix is stored column by column.
GLIDAR_INLINE void rotate_lanes(const double* m, const Lanes3<double>& in, double* __restrict out_x,
                                double* __restrict out_y, double* __restrict out_z) {
  const double* const x = numbers(in.x);
  const double* const y = numbers(in.y);
  const double* const z = numbers(in.z);
  for (unsigned i = 0; i < kLanes; ++i) {
    out_x[i] = m[0] * x[i] + m[3] * y[i] + m[6] * z[i];
    out_y[i] = m[1] * x[i] + m[4] * y[i] + m[7] * z[i];
    out_z[i] = m[2] * x[i] + m[5] * y[i] + m[8] * z[i];
  }
}

/// Loads and stores a register's worth of lanes.
GLIDAR_INLINE Vector& at(Lanes<double>& lanes, unsigned i) {
  return *reinterpret_cast<Vector*>(numbers(lanes) + i);
}

struct Vector3 {
  Vector x;
  Vector y;
  Vector z;
};

/// Corners of the lanes from i on.
GLIDAR_INLINE Vector3 corner_at(const Lanes3<float>& corner, unsigned i) {
  const auto component = [i](const Lanes<float>& lanes) {
    return __builtin_convertvector(
        *reinterpret_cast<const FloatVector*>(reinterpret_cast<const float*>(&lanes) + i), Vector);
  };
  return {component(corner.x), component(corner.y), component(corner.z)};
}

/// Computes the planes of the lanes from i on as plane_of().
GLIDAR_INLINE void find_planes_at(const CornerBlock& corners, unsigned i, Lanes3<double>& normal,
                                  Lanes<double>& offset) {
  const Vector3 a = corner_at(corners.c0, i);
  const Vector3 b = corner_at(corners.c1, i);
  const Vector3 c = corner_at(corners.c2, i);
  const Vector3 u = {b.x - a.x, b.y - a.y, b.z - a.z};
  const Vector3 v = {c.x - a.x, c.y - a.y, c.z - a.z};
  const Vector3 cross = {u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
  const Vector length = square_root(cross.x * cross.x + cross.y * cross.y + cross.z * cross.z);
  const Vector3 n = {cross.x / length, cross.y / length, cross.z / length};
  at(normal.x, i) = n.x;
  at(normal.y, i) = n.y;
  at(normal.z, i) = n.z;
  at(offset, i) = n.x * a.x + n.y * a.y + n.z * a.z;
}

void find_planes(const CornerBlock& corners, Lanes3<double>& normal, Lanes<double>& offset) {
  for (unsigned i = 0; i < kLanes; i += kWidth) find_planes_at(corners, i, normal, offset);
}

/// Sets all lanes to the first lane's triangle.
GLIDAR_INLINE void set_triangle(const TrianglesToGather& from, const HitsToFind& exact) {
  Lanes3<float>* const corners[3] = {&exact.corners->c0, &exact.corners->c1, &exact.corners->c2};
  const std::uint32_t* const triangle = from.vertices + std::size_t{3} * from.primitive[0];
  const auto fill_lanes = [](auto& lanes, auto number) {
    auto* const all = reinterpret_cast<decltype(number)*>(&lanes);
    for (unsigned i = 0; i < kLanes; ++i) all[i] = number;
  };
  for (unsigned k = 0; k < 3; ++k) {
    const float* const vector = from.of_vertex + std::size_t{3} * triangle[k];
    fill_lanes(corners[k]->x, vector[0]);
    fill_lanes(corners[k]->y, vector[1]);
    fill_lanes(corners[k]->z, vector[2]);
  }
  find_planes_at(*exact.corners, 0, *exact.normal, *exact.offset);
  fill_lanes(exact.normal->x, *numbers(exact.normal->x));
  fill_lanes(exact.normal->y, *numbers(exact.normal->y));
  fill_lanes(exact.normal->z, *numbers(exact.normal->z));
  fill_lanes(*exact.offset, *numbers(*exact.offset));
}

GLIDAR_INLINE void set_triangles(const OneInstanceHits& block, const HitsToFind& exact) {
  if (block.planes != nullptr) {
    gather_planes(reinterpret_cast<const double*>(block.planes), block.positions.primitive,
                  {numbers(exact.normal->x), numbers(exact.normal->y), numbers(exact.normal->z),
                   numbers(*exact.offset)});
    return;
  }
  if (block.is_one_triangle) return set_triangle(block.positions, exact);
  gather_lanes(block.positions, *exact.corners);
  find_planes(*exact.corners, *exact.normal, *exact.offset);
}

bool intersect(const OneInstanceHits& block, const HitsToFind& exact) {
  set_triangles(block, exact);
  rotate_lanes(block.object_from_sensor, *block.direction, numbers(exact.direction->x),
               numbers(exact.direction->y), numbers(exact.direction->z));
  const Vector ox = Vector{} + block.sensor_in_object[0];
  const Vector oy = Vector{} + block.sensor_in_object[1];
  const Vector oz = Vector{} + block.sensor_in_object[2];
  VectorMask certain = ~VectorMask{};
  for (unsigned i = 0; i < kLanes; i += kWidth) {
    const Vector nx = at(exact.normal->x, i);
    const Vector ny = at(exact.normal->y, i);
    const Vector nz = at(exact.normal->z, i);
    const Vector above = at(*exact.offset, i) - (nx * ox + ny * oy + nz * oz);
    const Vector cosine = nx * at(exact.direction->x, i) + ny * at(exact.direction->y, i) +
                          nz * at(exact.direction->z, i);
    const Vector distance = above / cosine;
    at(exact.origin->x, i) = ox;
    at(exact.origin->y, i) = oy;
    at(exact.origin->z, i) = oz;
    at(*exact.cosine, i) = cosine;
    at(*exact.distance, i) = distance;
    // As is_uncertain() of intersect_grazing().
    certain &= ((cosine > kGrazing) | (cosine < -kGrazing)) & (distance > 0.0);
  }
  long long all = -1;
  for (unsigned i = 0; i < kWidth; ++i) all &= certain[i];
  return all != 0;
}

void orient(const double* sensor_from_object, const Lanes3<double>& front,
            const Lanes<double>& cosine, float* normals) {
  alignas(64) double x[kLanes];
  alignas(64) double y[kLanes];
  alignas(64) double z[kLanes];
  rotate_lanes(sensor_from_object, front, x, y, z);
  const double* const cosines = numbers(cosine);
  alignas(64) float out_x[kLanes];
  alignas(64) float out_y[kLanes];
  alignas(64) float out_z[kLanes];
  for (unsigned i = 0; i < kLanes; ++i) {
    const double sign = cosines[i] > 0.0 ? -1.0 : 1.0;
    out_x[i] = static_cast<float>(sign * x[i]);
    out_y[i] = static_cast<float>(sign * y[i]);
    out_z[i] = static_cast<float>(sign * z[i]);
  }
  for (std::size_t i = 0; i < kLanes; ++i) {
    normals[3 * i] = out_x[i];
    normals[3 * i + 1] = out_y[i];
    normals[3 * i + 2] = out_z[i];
  }
}

void gather(const TrianglesToGather& from, CornerBlock& to) {
  gather_lanes(from, to);
}

}  // namespace

extern const BlockKernel kBlockKernel;
const BlockKernel kBlockKernel = {GLIDAR_KERNEL_NAME, intersect, orient, find_planes, gather};

}  // namespace glidar::rays::GLIDAR_KERNEL
