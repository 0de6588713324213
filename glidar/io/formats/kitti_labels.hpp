// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io: calibration, poses and labels of KITTI (Geiger et al. 2012; formats in the
// readmes of the development kits for 3D objects and odometry).

#include <glidar/core/frame.hpp>
#include <glidar/core/scene.hpp>
#include <glidar/io/pictures/point_image.hpp>
#include <glidar/sensor/sensor.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace glidar {

/// A rectified camera of a KITTI folder.
struct KittiCamera {
  RectifiedCamera intrinsics;
  Pose camera_from_velodyne = Pose::Identity();  ///< the Velodyne frame is the LiDAR's own
};

/// The camera of a folder with this sensor alone: the sensor if it is a camera, else one like
/// KITTI's left colour camera at the LiDAR's origin.
KittiCamera kitti_camera(const Sensor& sensor);

/// A camera beside the LiDAR; empty for other sensors and lenses with distortion, since KITTI's
/// images are rectified.
std::optional<KittiCamera> kitti_camera(const Sensor& camera, const Pose& camera_from_velodyne);

enum class KittiCalibration : std::uint8_t {
  frame,     ///< calib/NNNNNN.txt of the object benchmark
  sequence,  ///< calib.txt of the odometry benchmark
};

/// A file of calibration. The first camera is the reference camera and that of image_2, the second
/// that of image_3. There is no IMU.
std::string kitti_calibration(std::span<const KittiCamera> cameras, KittiCalibration kind);

/// The first three rows of a pose, as a line of poses.txt.
std::string kitti_pose_line(const Pose& pose);

/// The text of a file in label_2/: a line for each visible instance, with its box in the
/// camera's frame; DontCare for those without a class, nothing for those whose class has no
/// boxes. Occlusion is that of frame.boxes.
std::string kitti_labels(const Scene& scene, const KittiCamera& camera, const Frame& frame);

}  // namespace glidar
