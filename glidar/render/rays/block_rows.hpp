// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/rays/triangle_filter.hpp>

namespace glidar::rays::GLIDAR_KERNEL {

/// Values of eight triangles, to be read one triangle at a time, the same in all lanes of F.
template <class F, unsigned kRows>
struct BlockRows {
  alignas(32) float at[kRows][kBlockSize];

  GLIDAR_INLINE void set(unsigned row, Float8 x) { store(at[row], x); }
  GLIDAR_INLINE void set(unsigned row, const Vector<Float8>& v) {
    set(row, v.x);
    set(row + 1, v.y);
    set(row + 2, v.z);
  }
  GLIDAR_INLINE void set(unsigned row, const ErrorBounds<Float8>& b) {
    set(row, b.edge);
    set(row + 1, b.det);
    set(row + 2, b.den);
  }
  [[nodiscard]] GLIDAR_INLINE F all(unsigned row, unsigned i) const { return F::all(at[row][i]); }
  [[nodiscard]] GLIDAR_INLINE Vector<F> all3(unsigned row, unsigned i) const {
    return {all(row, i), all(row + 1, i), all(row + 2, i)};
  }
  [[nodiscard]] GLIDAR_INLINE ErrorBounds<F> bounds(unsigned row, unsigned i) const {
    return {all(row, i), all(row + 1, i), all(row + 2, i)};
  }
};

}  // namespace glidar::rays::GLIDAR_KERNEL
