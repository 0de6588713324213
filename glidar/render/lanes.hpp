// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <bit>
#include <cstdint>

namespace glidar {

/// How many beams are processed together.
inline constexpr unsigned kLanes = 16;

/// One number per lane.
template <class T>
struct alignas(64) Lanes {
  std::array<T, kLanes> at;
  T& operator[](unsigned lane) { return at[lane]; }
  const T& operator[](unsigned lane) const { return at[lane]; }
};

/// One vector per lane, component by component.
template <class T>
struct Lanes3 {
  Lanes<T> x;
  Lanes<T> y;
  Lanes<T> z;

  void set(unsigned lane, const Eigen::Matrix<T, 3, 1>& v) {
    x[lane] = v.x();
    y[lane] = v.y();
    z[lane] = v.z();
  }
  [[nodiscard]] Eigen::Matrix<T, 3, 1> get(unsigned lane) const {
    return {x[lane], y[lane], z[lane]};
  }
};

/// A vector at each corner of the lanes' triangles.
struct CornerBlock {
  Lanes3<float> c0;
  Lanes3<float> c1;
  Lanes3<float> c2;
};

/// Sets all lanes to the value.
template <class T>
inline void fill(T value, Lanes<T>& lanes) {
  for (unsigned i = 0; i < kLanes; ++i) lanes[i] = value;
}

/// Calls body(lane) for every lane of a mask.
template <class Body>
void for_lanes(std::uint32_t mask, const Body& body) {
  for (; mask != 0; mask &= mask - 1) body(static_cast<unsigned>(std::countr_zero(mask)));
}

/// out = matrix * in, lane by lane; out is not in. Without __restrict, compilers do not vectorise
/// it.
template <class T>
inline void rotate(const Eigen::Matrix<T, 3, 3>& matrix, const Lanes3<T>& in,
                   Lanes3<T>& __restrict out) {
  const T* m = matrix.data();  // column by column
  for (unsigned i = 0; i < kLanes; ++i) {
    out.x[i] = m[0] * in.x[i] + m[3] * in.y[i] + m[6] * in.z[i];
    out.y[i] = m[1] * in.x[i] + m[4] * in.y[i] + m[7] * in.z[i];
    out.z[i] = m[2] * in.x[i] + m[5] * in.y[i] + m[8] * in.z[i];
  }
}

/// The same for one vector, with the same bits: Eigen adds the terms in another order.
template <class T>
inline Eigen::Matrix<T, 3, 1> rotate(const Eigen::Matrix<T, 3, 3>& matrix,
                                     const Eigen::Matrix<T, 3, 1>& in) {
  const T* m = matrix.data();
  return {m[0] * in.x() + m[3] * in.y() + m[6] * in.z(),
          m[1] * in.x() + m[4] * in.y() + m[7] * in.z(),
          m[2] * in.x() + m[5] * in.y() + m[8] * in.z()};
}

}  // namespace glidar
