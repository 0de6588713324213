// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/depth/depth_filter.hpp>
#include <glidar/depth/filter_image.hpp>

namespace glidar::depth {

/// Disparities are smoothed in single precision. Of depths, which are rounded after each step,
/// holes are filled in the same passes.
void apply(const SpatialFilter& filter, FilterImage& image);

}  // namespace glidar::depth
