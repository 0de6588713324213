// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

namespace glidar {

/// The range after which the phases of all modulation frequencies repeat: c / (2 gcd), with the
/// frequencies rounded to whole hertz.
double unambiguous_range_m(std::span<const double> frequencies_hz);

}  // namespace glidar
