// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io: point files of KITTI's 3D object benchmark (Geiger et al. 2012; formats in
// the readme of its object development kit) and label files of SemanticKITTI (Behley et al. 2019).

#include <glidar/io/formats/format.hpp>

#include <filesystem>
#include <vector>

namespace glidar {

/// The points of a cloud in KITTI's format: xyz and `intensity` from 0 to 1, and the ids that the
/// cloud has. Intensities of pulsed sensors are calibrated reflectivities as bytes over 255. With
/// the noise step `intensity_scale` of kind vendor they are that byte over 255, else the intensity
/// itself, clipped. Throws Error when a column is missing.
PointCloud kitti_cloud(const PointCloud& cloud, const Sensor& sensor, const Beams& beams);

/// Fields of a KITTI file: x y z intensity as float; see kitti_cloud().
std::vector<PointField> kitti_fields(const PointCloud& cloud);

/// Writes a KITTI Velodyne file: float32 x y z intensity per point, no header, no misses; of a
/// kitti_cloud().
void write_kitti(const CloudFile& job, AtomicFile& file);

/// Writes a little-endian uint32 for each point, class in the lower 16 bits, instance in the upper.
/// Throws Error for ids beyond 16 bits.
void write_kitti_labels(const CloudFile& job, AtomicFile& file);

/// Adds the labels of a cloud for scenes with classes. For other scenes, removes a label file of an
/// earlier cloud with the same name. Throws Error.
void stage_kitti_labels(const CloudFile& job, const std::filesystem::path& path,
                        StagedFiles& files);

/// OUT.label for OUT.bin.
std::filesystem::path labels_path(const std::filesystem::path& path);

/// stage_kitti_labels for the OUT.label of OUT.bin.
void stage_labels_beside(const CloudFile& job, const std::filesystem::path& path,
                         StagedFiles& files);

}  // namespace glidar
