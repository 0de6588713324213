// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace glidar {

/// Means below it use the uniform number, others the normal one.
inline constexpr double kPoissonInversionLimit = 32.0;

/// A Poisson number of a mean from 0, as a function of one uniform number in (0, 1) or one standard
/// normal number. Below kPoissonInversionLimit it inverts the distribution, exactly to the
/// resolution of the uniform number. Above it is the rounded Cornish-Fisher expansion of the
/// quantile to the third order (Abramowitz and Stegun 26.2.49), of the variance less 1/12, which
/// rounding adds; mean and variance are within 1e-3 of the exact ones, relative to the mean.
double sample_poisson(double mean, double uniform, double normal);

}  // namespace glidar
