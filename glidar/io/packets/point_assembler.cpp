// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/packets/point_assembler.hpp>

#include <glidar/math/constants.hpp>

#include <algorithm>
#include <limits>
#include <utility>

namespace glidar {
namespace {

constexpr std::size_t kMaxPoints = std::size_t{1} << 22U;  // of a frame, to bound memory
constexpr double kMaxPeriod_ns = 4e9;  // times since the frame's start have 32 bits

void store(const AssembledPoint& point, std::size_t entry, DecodedFrame& made) {
  const double range_m = point.xyz_m.norm();
  if (range_m > 0.0) {
    made.beams.directions[entry] = point.xyz_m / range_m;
    made.frame.range_m[entry] = range_m;
    made.frame.intensity[entry] = point.intensity;
    made.frame.status[entry] = Status::hit;
    return;
  }
  made.beams.directions[entry].setConstant(std::numeric_limits<double>::quiet_NaN());
  invalidate_return(made.frame, entry, Status::miss);
}

}  // namespace

PointAssembler::PointAssembler(std::size_t rows, double rate_hz)
    : rows_(rows), period_ns_(std::min(kSecond_ns / rate_hz, kMaxPeriod_ns)) {}

void PointAssembler::add(std::int64_t stamp_ns, std::span<const AssembledPoint> points,
                         std::vector<DecodedFrame>& frames) {
  const auto age_ns = static_cast<double>(stamp_ns - epoch_ns_) - start_ns_;
  const bool joins = !stamps_ns_.empty() && stamp_ns >= stamps_ns_.back() &&
                     age_ns < 2.0 * period_ns_ && points_.size() < kMaxPoints;
  if (joins && age_ns >= period_ns_) {
    emit(frames);
    start_ns_ += period_ns_;
  } else if (!joins) {
    finish(frames);
    epoch_ns_ = stamp_ns;
    start_ns_ = 0.0;
  }
  stamps_ns_.push_back(stamp_ns);
  points_.insert(points_.end(), points.begin(), points.end());
}

void PointAssembler::finish(std::vector<DecodedFrame>& frames) {
  if (!stamps_ns_.empty()) emit(frames);
}

void PointAssembler::emit(std::vector<DecodedFrame>& frames) {
  DecodedFrame made;
  const std::size_t cols = stamps_ns_.size();
  made.beams.rows = static_cast<std::uint32_t>(rows_);
  made.beams.cols = static_cast<std::uint32_t>(cols);
  made.beams.frame_id = "lidar_frame";
  made.beams.boresight = Eigen::Vector3d::UnitX();
  made.beams.directions.resize(points_.size());
  made.beams.times_ns.resize(points_.size());
  made.beams.rings.resize(points_.size());
  resize(made.frame, points_.size());
  resize(made.frame.ground_truth, points_.size(), {});
  write_misses({}, 0, points_.size(), made.frame.ground_truth);  // packets have none
  made.frame.rows = made.beams.rows;
  made.frame.cols = made.beams.cols;
  made.frame.frame_id = made.beams.frame_id;
  made.frame.number = number_++;
  made.frame.stamp_ns = stamps_ns_.front();
  for (std::size_t row = 0; row < rows_; ++row) {
    for (std::size_t col = 0; col < cols; ++col) {
      const std::size_t entry = row * cols + col;
      made.beams.rings[entry] = static_cast<std::uint16_t>(row);
      made.beams.times_ns[entry] = static_cast<std::uint32_t>(stamps_ns_[col] - stamps_ns_.front());
      store(points_[col * rows_ + row], entry, made);
    }
  }
  stamps_ns_.clear();
  points_.clear();
  frames.push_back(std::move(made));
}

}  // namespace glidar
