// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/math/unambiguous_range.hpp>

#include <glidar/math/constants.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

namespace glidar {

double unambiguous_range_m(std::span<const double> frequencies_hz) {
  std::uint64_t common = 0;
  for (const double f : frequencies_hz) {
    common = std::gcd(common, static_cast<std::uint64_t>(std::llround(f)));
  }
  return kHalfLight_m_per_s / static_cast<double>(std::max<std::uint64_t>(common, 1));
}

}  // namespace glidar
