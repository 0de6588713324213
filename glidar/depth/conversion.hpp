// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/depth/depth_filter.hpp>
#include <glidar/depth/filter_image.hpp>

namespace glidar::depth {

/// f b 32 / unit: the product of a depth in units and its disparity in 1/32 px.
float disparity_factor(double baseline_m, float focal_length_px, double unit_m);

void to_disparity(float factor, FilterImage& image);

/// Rounded; 0 beyond 16 bits.
void to_depth(float factor, FilterImage& image);

/// Removes depths outside the interval.
void apply(const ThresholdFilter& filter, double unit_m, FilterImage& image);

}  // namespace glidar::depth
