// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace glidar {

/// The beam of each pixel in a picture of a measurement, as seen by the sensor: left is
/// left and up is up. For display only: the order of the measurement is unchanged.
struct BeamPicture {
  enum class Kind : std::uint8_t {
    image,   ///< rows and columns of a camera, unchanged
    grid,    ///< a LiDAR's rows, each shifted so that a column has one azimuth ("destaggered")
    angles,  ///< scattered beams by azimuth and elevation (equirectangular)
    top,     ///< the returns of a scanner of one line from above: x to the right, y up
  };
  static constexpr std::uint32_t kNoBeam = 0xFFFFFFFFU;

  Kind kind = Kind::image;
  std::uint32_t rows = 0;
  std::uint32_t cols = 0;
  std::vector<std::uint32_t> beams;  ///< rows x cols, kNoBeam for none; empty: beam = pixel
  std::uint32_t first = 0;           ///< for an image: the beam of the first pixel
  /// At the picture's edges: azimuth (to the left) and elevation in degrees, or x and y in metres.
  double left = 0.0;
  double right = 0.0;
  double top = 0.0;
  double bottom = 0.0;
  std::vector<double> row_elevations_deg;  ///< for a grid, from top to bottom

  [[nodiscard]] std::uint32_t beam_at(std::size_t pixel) const {
    return beams.empty() ? first + static_cast<std::uint32_t>(pixel) : beams[pixel];
  }
};

/// The picture for one of the returns (from 0) of a measurement. `range_m` has one number per beam,
/// NaN without a return; if several beams have the same pixel, the nearest return is shown.
BeamPicture make_beam_picture(const Beams& beams, std::span<const double> range_m,
                              std::uint32_t number_of_return = 0);

/// The picture of a camera of this size: its pixels unchanged.
BeamPicture make_image_picture(std::uint32_t rows, std::uint32_t cols,
                               std::uint32_t number_of_return = 0);

/// Writes a PNG of the beam directions: azimuth (left of the boresight is left) and elevation in
/// degrees, with axes, coloured by firing time, or by ring when all fire at the same time. For
/// images a part of the pixels is drawn. Throws Error when there is no beam or the file cannot be
/// written.
void write_pattern_picture(const Beams& beams, const std::filesystem::path& path);

}  // namespace glidar
