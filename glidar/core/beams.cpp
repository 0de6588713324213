// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/beams.hpp>

#include <glidar/core/error.hpp>
#include <glidar/math/portable.hpp>

#include <cmath>

namespace glidar {
namespace {

void require_size(std::size_t found, std::size_t size, bool may_be_empty, const char* field) {
  if (found == size || (may_be_empty && found == 0)) return;
  throw Error({.where = std::string("beams, ") + field,
               .found = std::to_string(found) + " entries",
               .allowed = std::to_string(size) + " (rows x cols)"});
}

}  // namespace

bool looks_along_z(const Beams& beams) {
  return beams.boresight.isApprox(Eigen::Vector3d::UnitZ());
}

SensorAxes axes_of(const Beams& beams) {
  using Eigen::Vector3d;
  if (looks_along_z(beams)) return {Vector3d::UnitZ(), -Vector3d::UnitX(), -Vector3d::UnitY()};
  return {Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ()};
}

double azimuth_rad(const SensorAxes& axes, const Eigen::Vector3d& direction) {
  return portable_atan2(axes.left.dot(direction), axes.ahead.dot(direction));
}

double elevation_rad(const SensorAxes& axes, const Eigen::Vector3d& direction) {
  const double level = portable_hypot(axes.left.dot(direction), axes.ahead.dot(direction));
  return portable_atan2(axes.up.dot(direction), level);
}

void validate(const Beams& beams) {
  const std::size_t size = std::size_t{beams.rows} * beams.cols;
  require_size(beams.directions.size(), size, false, "directions");
  require_size(beams.origins_m.size(), size, true, "origins_m");
  require_size(beams.times_ns.size(), size, true, "times_ns");
  require_size(beams.rings.size(), size, true, "rings");
  constexpr double kUnitTolerance = 1e-12;  // a few roundings of a normalisation in double
  for (const Eigen::Vector3d& direction : beams.directions) {
    if (std::isnan(direction.x()) || std::abs(direction.norm() - 1.0) < kUnitTolerance) continue;
    throw Error({.where = "beams, directions",
                 .found = "a vector of length " + number_text(direction.norm()),
                 .allowed = "unit vectors, or NaN for no beam",
                 .remedy = "normalise them"});
  }
}

}  // namespace glidar
