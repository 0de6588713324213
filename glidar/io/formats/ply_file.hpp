// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/formats/cloud_file.hpp>

#include <vector>

namespace glidar {

/// Fields of a PLY file: x y z are float unless that moves a point by more than 0.1 mm, then
/// double. Other columns keep their types, except 64-bit integers, which become double; normals are
/// nx ny nz, colour is uchar red green blue.
std::vector<PointField> ply_fields(const PointCloud& cloud);

/// Writes a Stanford polygon file, little-endian or ascii, vertices only. The size of an organised
/// cloud is stored as in PCL: `obj_info num_cols`.
void write_ply(const CloudFile& job, AtomicFile& file);

}  // namespace glidar
