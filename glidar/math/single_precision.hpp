// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace glidar {

/// The value rounded to single precision, as a double. Use it for every conversion to float and
/// back: the optimiser of GCC 12 omits the rounding where it vectorises neighbouring conversions
/// (-ftree-slp-vectorize, part of -O2 and -O3), unless the float passes through memory.
inline double rounded_to_float(double value) {
  auto rounded = static_cast<float>(value);
#if defined(__GNUC__)
  asm("" : "+m"(rounded));
#endif
  return double{rounded};
}

}  // namespace glidar
