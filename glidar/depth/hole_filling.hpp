// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/depth/depth_filter.hpp>
#include <glidar/depth/filter_image.hpp>

namespace glidar::depth {

/// Fills in place, row by row: a filled pixel fills the next one. "Farthest" is the greatest and
/// "nearest" the least value, also of disparities.
void apply(const HoleFillingFilter& filter, FilterImage& image);

}  // namespace glidar::depth
