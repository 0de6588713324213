// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/formats/cloud_file.hpp>

#include <vector>

namespace glidar {

/// Fields of a PCD file: real numbers as float, as PCL's point types require; colour is PCL's
/// packed `rgb`.
std::vector<PointField> pcd_fields(const PointCloud& cloud);

/// Writes a Point Cloud Library file, format 0.7: https://pcl.readthedocs.io (The PCD file format).
/// The viewpoint is the sensor's pose in the cloud's frame.
void write_pcd(const CloudFile& job, AtomicFile& file);

}  // namespace glidar
