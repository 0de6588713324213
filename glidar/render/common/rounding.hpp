// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/math/constants.hpp>

#include <cmath>

namespace glidar {

/// A float below the value, at most two steps away.
inline float next_below(double value) {
  return std::nextafter(static_cast<float>(value), -kInfinityf);
}
/// A float above the value, at most two steps away.
inline float next_above(double value) {
  return std::nextafter(static_cast<float>(value), kInfinityf);
}

/// Lower and higher bounds that are looser by a few steps, but faster to compute.
inline float well_below(double value) {
  const auto rounded = static_cast<float>(value);
  return rounded - 0x1p-22F * std::abs(rounded) - 0x1p-120F;
}
inline float well_above(double value) {
  return -well_below(-value);
}

}  // namespace glidar
