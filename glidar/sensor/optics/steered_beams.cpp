// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/optics/steered_beams.hpp>

#include <cmath>
#include <limits>

namespace glidar {

Eigen::Vector3d refract(const Eigen::Vector3d& direction, const Eigen::Vector3d& normal,
                        double ratio) {
  const double cosine = -direction.dot(normal);
  const double root = 1.0 - ratio * ratio * (1.0 - cosine * cosine);
  if (!(root >= 0.0)) return Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  return (ratio * direction + (ratio * cosine - std::sqrt(root)) * normal).normalized();
}

double phase_turns(double at_zero_turns, double turns_per_firing, std::int64_t k) {
  return at_zero_turns + std::fmod(static_cast<double>(k) * turns_per_firing, 1.0);
}

Beams make_steered_beams(const FiringSchedule& pulses, const FrameInterval& interval,
                         std::size_t rows, const FiringDirections& directions_at) {
  const FiringRange range = firings_in(pulses, interval, kMaxBeams / rows);
  Beams beams;
  beams.rows = static_cast<std::uint32_t>(rows);
  beams.cols = static_cast<std::uint32_t>(range.size());
  beams.frame_id = "lidar_frame";
  beams.boresight = Eigen::Vector3d::UnitX();
  beams.directions.resize(rows * range.size());
  beams.times_ns.resize(rows * range.size());
  beams.rings.resize(rows * range.size());
  std::vector<Eigen::Vector3d> column(rows);
  for (std::size_t col = 0; col < range.size(); ++col) {
    const std::int64_t k = range.begin + static_cast<std::int64_t>(col);
    directions_at(k, column);
    const auto time_ns = static_cast<std::uint32_t>(firing_time_ns(pulses, k) - interval.start_ns);
    for (std::size_t row = 0; row < rows; ++row) {
      const std::size_t i = row * range.size() + col;
      beams.directions[i] = column[row];
      beams.times_ns[i] = time_ns;
      beams.rings[i] = static_cast<std::uint16_t>(row);
    }
  }
  return beams;
}

}  // namespace glidar
