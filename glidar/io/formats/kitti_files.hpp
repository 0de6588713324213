// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io: the files of KITTI's 3D object benchmark (Geiger et al. 2012; formats in
// the readme of its object development kit) and of SemanticKITTI (Behley et al. 2019).

#include <glidar/io/files/staged_files.hpp>
#include <glidar/io/formats/cloud_file.hpp>

#include <filesystem>
#include <string>

namespace glidar {

/// The points of a cloud as KITTI keeps them: xyz and `intensity` from 0 to 1, and the ids that the
/// cloud has. Intensities are calibrated reflectivities as bytes over 255 for sensors of pulsed
/// light (of the noise step `intensity_scale`, kind vendor: that byte), else the intensity itself,
/// clipped. Throws Error when a column is missing.
PointCloud kitti_cloud(const PointCloud& cloud, const Sensor& sensor, const Beams& beams);

/// True when an instance of the scene has a class.
bool has_classes(const Scene& scene);

/// A little-endian uint32 for each point, class in the lower 16 bits, instance in the upper. Throws
/// Error for ids beyond 16 bits.
void write_kitti_labels(const CloudFile& job, AtomicFile& file);

/// Adds the labels of a cloud for scenes with classes; for others removes those of an earlier
/// cloud, which would have the name of this one's. Throws Error.
void stage_kitti_labels(const CloudFile& job, const std::filesystem::path& path,
                        StagedFiles& files);

/// OUT.label beside OUT.bin.
std::filesystem::path labels_path(const std::filesystem::path& path);

/// stage_kitti_labels for OUT.label beside OUT.bin.
void stage_labels_beside(const CloudFile& job, const std::filesystem::path& path,
                         StagedFiles& files);

/// Adds one frame to a folder: velodyne/NNNNNN.bin, calib/NNNNNN.txt, label_2/NNNNNN.txt, and
/// labels/NNNNNN.label for scenes with classes; NNNNNN is the frame's number. Throws Error.
void stage_kitti_folder(const CloudFile& job, const std::filesystem::path& folder,
                        StagedFiles& files);

/// The text of a file in calib/: the camera is the sensor where it is one, else one like KITTI's
/// left colour camera at the LiDAR's origin. Both are rectified, and there is no IMU. The Velodyne
/// frame is the sensor's own.
std::string kitti_calibration(const Sensor& sensor);

/// The text of a file in label_2/: a line for each instance that a beam met, with its box in the
/// camera's frame; DontCare for those without a class.
std::string kitti_labels(const Scene& scene, const Sensor& sensor, const Frame& frame);

}  // namespace glidar
