// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io: folders of KITTI's 3D object benchmark (Geiger et al. 2012; formats in the
// readme of its object development kit).

#include <glidar/io/formats/format.hpp>

#include <filesystem>
#include <string>

namespace glidar {

/// Adds one frame to a folder: velodyne/NNNNNN.bin, calib/NNNNNN.txt, label_2/NNNNNN.txt, and
/// labels/NNNNNN.label for scenes with classes; NNNNNN is the frame's number. Throws Error.
void stage_kitti_folder(const CloudFile& job, const std::filesystem::path& folder,
                        StagedFiles& files);

/// The text of a file in calib/. The camera is the sensor if it is a camera, else one like KITTI's
/// left colour camera at the LiDAR's origin. Both are rectified, and there is no IMU. The Velodyne
/// frame is the sensor's own.
std::string kitti_calibration(const Sensor& sensor);

/// The text of a file in label_2/: a line for each visible instance, with its box in the
/// camera's frame; DontCare for those without a class.
std::string kitti_labels(const Scene& scene, const Sensor& sensor, const Frame& frame);

Format kitti_folder_format();

}  // namespace glidar
