// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace glidar {

/// Which beam each pixel of a picture of a measurement shows, the way the sensor sees it: left is
/// left and up is up. Pictures only: the measurement keeps its own order.
struct BeamPicture {
  enum class Kind : std::uint8_t {
    image,   ///< rows and columns of a camera, as they are
    grid,    ///< a LiDAR's rows, each shifted so that a column has one azimuth ("destaggered")
    angles,  ///< scattered beams by azimuth and elevation (equirectangular)
    top,     ///< the returns of a scanner of one line from above: x to the right, y up
  };
  static constexpr std::uint32_t kNoBeam = 0xFFFFFFFFU;

  Kind kind = Kind::image;
  std::uint32_t rows = 0;
  std::uint32_t cols = 0;
  std::vector<std::uint32_t> beams;  ///< rows x cols, kNoBeam where none is; empty: beam = pixel
  std::uint32_t first = 0;           ///< of an image: the beam of the first pixel
  /// At the picture's edges: azimuth (to the left) and elevation in degrees, or x and y in metres.
  double left = 0.0;
  double right = 0.0;
  double top = 0.0;
  double bottom = 0.0;
  std::vector<double> row_elevations_deg;  ///< of a grid, from the top row down

  [[nodiscard]] std::uint32_t beam_at(std::size_t pixel) const {
    return beams.empty() ? first + static_cast<std::uint32_t>(pixel) : beams[pixel];
  }
};

/// The picture for one of the returns (from 0) of a measurement. `range_m` has one number a beam,
/// NaN without a return; where several beams fall on one pixel the nearest return wins.
BeamPicture make_beam_picture(const Beams& beams, std::span<const double> range_m,
                              std::uint32_t number_of_return = 0);

/// The picture of a camera of this size: its pixels as they are.
BeamPicture make_image_picture(std::uint32_t rows, std::uint32_t cols,
                               std::uint32_t number_of_return = 0);

}  // namespace glidar
