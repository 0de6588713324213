// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io: points of packets that do not state their beams.

#include <glidar/io/packets/packet_codec.hpp>

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace glidar {

struct AssembledPoint {
  Eigen::Vector3d xyz_m;  ///< in the sensor frame; zero: no return
  float intensity = 0.0F;
};

/// Collects the points of firings and joins those of a frame period to a frame.
class PointAssembler {
 public:
  /// `rows`: points of a firing.
  PointAssembler(std::size_t rows, double rate_hz);

  /// Adds the next firing in time; appends the frame before it if it begins a new one.
  void add(std::int64_t stamp_ns, std::span<const AssembledPoint> points,
           std::vector<DecodedFrame>& frames);
  void finish(std::vector<DecodedFrame>& frames);

 private:
  void emit(std::vector<DecodedFrame>& frames);

  std::size_t rows_;
  double period_ns_;
  std::uint32_t number_ = 0;
  double start_ns_ = 0.0;                ///< of the frame, after the epoch
  std::int64_t epoch_ns_ = 0;            ///< a firing to which frames are aligned
  std::vector<std::int64_t> stamps_ns_;  ///< of the firings
  std::vector<AssembledPoint> points_;   ///< firings x rows
};

}  // namespace glidar
