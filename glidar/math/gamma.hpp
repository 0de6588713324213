// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/math/random.hpp>

namespace glidar {

/// A number of the gamma distribution of mean 1 and a standard deviation from 0 to 1 (Marsaglia and
/// Tsang, A simple method for generating gamma variables, ACM TOMS 26(3), 2000). Uses the blocks of
/// `key` from its block on.
double sample_gamma(double deviation, RngKey key);

}  // namespace glidar
