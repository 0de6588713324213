// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/depth/depth_filter.hpp>
#include <glidar/depth/filter_image.hpp>

namespace glidar::depth {

/// Of an image of depths.
void apply(const DecimationFilter& filter, FilterImage& image);

}  // namespace glidar::depth
