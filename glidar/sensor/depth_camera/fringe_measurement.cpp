// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/depth_camera/fringe_measurement.hpp>

#include <glidar/math/constants.hpp>

#include <cmath>

namespace glidar {

MeasuredFringes measure_fringes(std::span<const GreyImage> images, const StructuredLight& setup,
                                ThreadPool* pool) {
  MeasuredFringes measured;
  DecodedFringes& decoded = measured.decoded;
  decoded = decode_fringes(images, setup.patterns, setup.decoding, pool);
  measured.depth_m = triangulate(decoded, setup, make_beams(setup.camera), pool);
  for (std::size_t i = 0; i < measured.depth_m.size(); ++i) {
    if (decoded.status[i] != FringeStatus::valid || !std::isnan(measured.depth_m[i])) continue;
    decoded.status[i] = FringeStatus::inconsistent;
    decoded.coordinate_px[i] = kNaNf;
  }
  return measured;
}

FringeTrace explain_fringes(std::span<const GreyImage> images, const StructuredLight& setup,
                            std::array<std::uint32_t, 2> column_row) {
  FringeTrace trace = explain_fringes(images, setup.patterns, setup.decoding, column_row);
  if (trace.status != FringeStatus::valid) return trace;
  DecodedFringes decoded = {images.front().width, images.front().height};
  decoded.coordinate_px.assign(images.front().level.size(), kNaNf);
  const std::size_t pixel = std::size_t{trace.row} * decoded.width + trace.column;
  decoded.coordinate_px[pixel] = static_cast<float>(trace.coordinate_px);
  if (!std::isnan(triangulate(decoded, setup)[pixel])) return trace;
  trace.status = FringeStatus::inconsistent;
  trace.tests.push_back({FringeStatus::inconsistent, false,
                         "the coordinate leads to no depth in front of camera and projector"});
  return trace;
}

}  // namespace glidar
