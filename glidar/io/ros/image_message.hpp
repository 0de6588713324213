// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/ros/cloud_message.hpp>

#include <cstdint>
#include <string>

namespace glidar::ros {

/// Pixels of a depth image. REP-118: 16UC1 is millimetres and 0 without a return, 32FC1 is metres
/// and NaN without one.
enum class DepthEncoding : std::uint8_t { millimetres_16uc1, metres_32fc1 };

/// The depth along the boresight. `frame_id` empty: that of the sensor. Depths above 65.535 m are 0
/// in 16UC1. Throws Error for sensors that report several returns or depths behind them.
Image depth_image(const CloudSource& source, DepthEncoding encoding,
                  const std::string& frame_id = {});

/// Pixels of an intensity image.
enum class IntensityEncoding : std::uint8_t {
  mono8,  ///< 0 to 1 as 0 to 255, clipped
  f32c1,  ///< 32FC1, the intensity itself
};

/// Rows and columns of the first return.
Image intensity_image(const CloudSource& source, IntensityEncoding encoding,
                      const std::string& frame_id = {});

/// Rows and columns of the first return: 32FC1, the reported range in metres, NaN without a return.
Image range_image(const CloudSource& source, const std::string& frame_id = {});

/// An image of encoding mono8 or 16UC1 as PNG, in the format of image_transport's plugin
/// compressed_image_transport. Throws Error for other encodings.
CompressedImage png_image(const Image& image);

/// A depth image of encoding 16UC1 in the format of image_transport's plugin
/// compressed_depth_image_transport: PNG behind a header of 12 bytes. Throws Error for other
/// encodings.
CompressedImage compressed_depth_image(const Image& image);

/// Intrinsics and distortion. Throws Error for optics other than a camera.
CameraInfo camera_info(const CloudSource& source, const std::string& frame_id = {});

}  // namespace glidar::ros
