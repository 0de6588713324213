// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/formats/format.hpp>

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glidar {

/// The header of a NumPy array file, version 1.0, in C order; the numbers follow it.
/// `type` is NumPy's, e.g. "<f4". Source: numpy.lib.format ("Format Version 1.0").
std::string npy_header(std::string_view type, std::span<const std::size_t> shape);

/// The field of a depth image: depth as float.
std::vector<PointField> depth_fields(const PointCloud& cloud);

}  // namespace glidar
