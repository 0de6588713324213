// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/run/playback.hpp>
#include <apps/glidar/run/pose_source.hpp>
#include <glidar/link/recording.hpp>

namespace glidar::app {

/// How fast the frames of a recording follow.
enum class ReplayPace : std::uint8_t {
  schedule,  ///< at the rate of the schedule
  stamps,    ///< as the frames were measured, by their stamps
};

/// The frames of a recording, in its order.
class RecordedSource final : public PoseSource {
 public:
  struct Options {
    FrameSchedule schedule;
    ReplayPace pace = ReplayPace::schedule;
    /// Commands of a viewer, who may also look at the last frame until a stop is requested;
    /// nullptr: none.
    Playback* playback = nullptr;
  };
  /// All must outlive it.
  RecordedSource(link::RecordingReader& recording, const Options& options,
                 const PreparedScene& prepared, const StopRequest& stop);
  std::optional<FrameRequest> next() override;
  [[nodiscard]] std::string ending() const override { return ending_; }

 private:
  std::optional<link::RecordedFrame> read();
  [[nodiscard]] std::chrono::duration<double> period(std::int64_t t_ns) const;
  void wait_until_due(std::int64_t t_ns);

  link::RecordingReader& recording_;
  Options options_;
  const PreparedScene& prepared_;
  const StopRequest& stop_;
  std::optional<std::chrono::steady_clock::time_point> due_;
  std::int64_t last_ns_ = 0;                 ///< stamp of the last frame
  std::uint64_t number_ = 0;                 ///< of the next frame
  std::vector<std::uint64_t> next_indices_;  ///< of each sensor's next frame
  std::string ending_;
};

}  // namespace glidar::app
