// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/run/pose_source.hpp>
#include <glidar/link/recording.hpp>

namespace glidar::app {

/// The frames of a recording, in its order.
class RecordedSource final : public PoseSource {
 public:
  /// All must outlive it.
  RecordedSource(link::RecordingReader& recording, const FrameSchedule& schedule,
                 const PreparedScene& prepared, const StopRequest& stop);
  std::optional<FrameRequest> next() override;
  [[nodiscard]] std::string ending() const override { return ending_; }

 private:
  void wait_until_due();

  link::RecordingReader& recording_;
  FrameSchedule schedule_;
  const PreparedScene& prepared_;
  const StopRequest& stop_;
  std::optional<std::chrono::steady_clock::time_point> due_;
  std::uint64_t number_ = 0;                 ///< of the next frame
  std::vector<std::uint64_t> next_indices_;  ///< of each sensor's next frame
  std::string ending_;
};

}  // namespace glidar::app
