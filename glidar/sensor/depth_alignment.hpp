// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/pose.hpp>
#include <glidar/depth_camera/depth_filters.hpp>
#include <glidar/sensor/optics/pinhole.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace glidar {

class FieldVisitor;

/// A depth camera and the camera to whose pixels its depths move.
struct DepthAlignment {
  Pinhole depth;
  Pinhole colour;
  Pose colour_from_depth = Pose::Identity();
  double unit_m = 0.001;  ///< of depths
  /// Depths stay those along the boresight of the depth camera, as in librealsense. false: they
  /// become those along the boresight of the colour camera.
  bool keeps_depth = false;
};

/// Keys of an alignment file.
void describe(DepthAlignment& alignment, FieldVisitor& visitor);

/// The source of a pixel without depth.
inline constexpr std::uint32_t kNoSource = 0xFFFFFFFFU;

/// The depths that the colour camera sees: an image of its size.
struct AlignedDepth {
  DepthImage image;
  std::vector<std::uint32_t> source;  ///< the pixel of the depth image, row-major; or kNoSource
};

/// Registers depth images to a colour camera. The square of each depth pixel, at its depth, covers
/// the pixels of the colour image from its upper left to its lower right corner, each rounded to
/// the nearest pixel; of several the nearest depth remains, and of equal ones the first (the method
/// of rs.align in librealsense). Pixels that none covers have no depth: the depth camera does not
/// see what the colour camera sees there.
class DepthAligner {
 public:
  /// Throws Error when a camera or the unit is not allowed.
  explicit DepthAligner(const DepthAlignment& alignment);

  /// Throws Error when the image has not the size of the depth camera.
  [[nodiscard]] AlignedDepth align(const DepthImage& image) const;
  [[nodiscard]] const DepthAlignment& alignment() const { return alignment_; }

 private:
  struct Square {
    std::array<std::uint32_t, 2> first;  ///< column and row of the first pixel
    std::array<std::uint32_t, 2> last;
    double depth_m = 0.0;  ///< along the boresight of the colour camera
  };
  bool find_square(std::size_t pixel, double depth_m, Square& square) const;
  void cover(const Square& square, std::size_t pixel, std::uint16_t depth,
             AlignedDepth& aligned) const;

  DepthAlignment alignment_;
  PinholeProjection colour_;
  std::vector<Eigen::Vector2d>
      corners_;  ///< of pixels, on the plane z = 1: (width + 1) (height + 1)
  std::vector<Eigen::Vector2d> centres_;  ///< of pixels
};

}  // namespace glidar
