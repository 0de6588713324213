// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/depth/depth_filter.hpp>
#include <glidar/depth/depth_image.hpp>

#include <memory>
#include <span>
#include <vector>

namespace glidar {

/// What filters need to know of the camera.
struct DepthFilterCamera {
  double focal_length_px = 0.0;  ///< along rows, of the images before the filters; for to_disparity
  double unit_m = 0.001;         ///< of depths
};

class FieldVisitor;

/// Keys: the values with their bounds and defaults.
void describe(DepthFilterCamera& camera, FieldVisitor& visitor);

/// Applies filters in their order to the images of one camera, one after the other. Arithmetic is
/// that of librealsense (single precision), so the result has its bytes. Only the temporal filter
/// keeps a state.
class DepthFilterChain {
 public:
  /// Throws Error as validate() does, or when to_disparity lacks the focal length.
  DepthFilterChain(std::span<const DepthFilter> filters, const DepthFilterCamera& camera);
  ~DepthFilterChain();
  DepthFilterChain(DepthFilterChain&&) noexcept;
  DepthFilterChain& operator=(DepthFilterChain&&) noexcept;
  DepthFilterChain(const DepthFilterChain&) = delete;
  DepthFilterChain& operator=(const DepthFilterChain&) = delete;

  /// The next image. Another size than that of the image before clears the state. Throws Error
  /// when the image is empty or has not width x height depths.
  DepthImage apply(const DepthImage& image);
  /// Forgets all images: the next one is the first.
  void reset();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The camera of the filtered images: the focal length is divided by the decimation.
DepthFilterCamera filtered_camera(std::span<const DepthFilter> filters, DepthFilterCamera camera);

}  // namespace glidar
