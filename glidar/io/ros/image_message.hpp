// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/ros/cloud_message.hpp>

#include <cstdint>
#include <string>
#include <string_view>

namespace glidar::ros {

/// Pixels of a depth image. REP-118: 16UC1 is millimetres and 0 without a return, 32FC1 is metres
/// and NaN without one.
enum class DepthEncoding : std::uint8_t { millimetres_16uc1, metres_32fc1 };

/// The depth along the boresight; of a camera that looks back, the range along the beams.
/// `frame_id` empty: that of the sensor. Depths above 65.535 m are 0 in 16UC1. Throws Error for
/// sensors that report several returns or depths behind them.
Image depth_image(const CloudSource& source, DepthEncoding encoding,
                  const std::string& frame_id = {});

/// Pixels of an intensity image.
enum class IntensityEncoding : std::uint8_t {
  mono8,   ///< 0 to 1 as 0 to 255, clipped
  mono16,  ///< 0 to 1 as 0 to 65535, clipped
  f32c1,   ///< 32FC1, the intensity itself
};

/// Rows and columns of the first return.
Image intensity_image(const CloudSource& source, IntensityEncoding encoding,
                      const std::string& frame_id = {});

/// Rows and columns of the first return: 32FC1, the reported range in metres, NaN without a return.
Image range_image(const CloudSource& source, const std::string& frame_id = {});

/// Channels of a colour image.
enum class ColourEncoding : std::uint8_t { rgb8, bgra8 };

/// The diffuse colours of the surfaces, black where there is none. Throws Error if the frame was
/// cast without colours.
Image colour_image(const CloudSource& source, ColourEncoding encoding,
                   const std::string& frame_id = {});

/// One of Frame::raw_images: mono8, or mono16 if it has more than 8 bits. Throws Error if there is
/// none of this name.
Image raw_image(const CloudSource& source, std::string_view name, const std::string& frame_id = {});

/// What the images of Ouster's driver show.
enum class OusterChannel : std::uint8_t { range, signal, reflectivity, near_infrared };

/// An image of Ouster's driver: mono16, each row shifted so that columns have one azimuth. Range is
/// in steps of 4 mm, 0 beyond 16 bits. The others are scaled so that their 10th and 90th percentile
/// are at 0.1 and 0.9, and of signal and near infrared the square root is taken.
Image ouster_image(const CloudSource& source, OusterChannel channel,
                   const std::string& frame_id = {});

/// An image of encoding mono8, 16UC1 or rgb8 as PNG, in the format of image_transport's plugin
/// compressed_image_transport. Throws Error for other encodings.
CompressedImage png_image(const Image& image);

/// A depth image of encoding 16UC1 in the format of image_transport's plugin
/// compressed_depth_image_transport: PNG behind a header of 12 bytes. Throws Error for other
/// encodings.
CompressedImage compressed_depth_image(const Image& image);

/// Intrinsics and distortion. `right_baseline_m`: of the right camera of a stereo pair at this
/// distance, whose P[3] is -fx times it (sensor_msgs/CameraInfo). Throws Error for optics other
/// than a camera.
CameraInfo camera_info(const CloudSource& source, const std::string& frame_id = {},
                       double right_baseline_m = 0.0);

/// The beams of one ring as a scan in the plane of the sensor's axes ahead and left: angles grow
/// counter-clockwise, those of a whole turn from -pi on, and ranges are distances in that plane.
/// The stamp is the time of the first firing, and time_increment is positive, as of all drivers,
/// also of scanners that turn clockwise, whose greatest angles fire first. REP-117: +inf without a
/// return, -inf for surfaces that are too near, NaN for invalid measurements. Throws Error when the
/// ring has fewer than two beams or its angles are not equally spaced.
/// `quarter_turns` of the axes: see quarter_turned().
LaserScan laser_scan(const CloudSource& source, std::uint16_t ring,
                     const std::string& frame_id = {}, int quarter_turns = 0);

// Scans as the drivers of manufacturers make them: docs/drivers.md.

/// The nearly level ring in bins of 0.007 rad: ros-drivers/velodyne (04a7ca7),
/// velodyne_laserscan.cpp.
LaserScan velodyne_scan(const CloudSource& source, std::int64_t stamp_ns,
                        const std::string& frame_id);

/// The highest row, in reverse: ouster-lidar/ouster-ros (f5c4ef8), os_ros.cpp.
LaserScan ouster_scan(const CloudSource& source, std::int64_t stamp_ns,
                      const std::string& frame_id);

/// All returns in bins of equal angles, in reverse: Slamtec/sllidar_ros2 (3430009),
/// sllidar_node.cpp with angle_compensate.
LaserScan rplidar_scan(const CloudSource& source, std::int64_t stamp_ns,
                       const std::string& frame_id);

}  // namespace glidar::ros
