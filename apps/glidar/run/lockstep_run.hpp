// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/options/stream_options.hpp>
#include <apps/glidar/run/console.hpp>
#include <apps/glidar/run/interrupt.hpp>
#include <apps/glidar/run/prepared_scene.hpp>
#include <apps/glidar/run/recorded_command.hpp>
#include <glidar/io/files/atomic_file.hpp>
#include <glidar/link/error_log.hpp>
#include <glidar/link/lockstep.hpp>
#include <glidar/link/payload.hpp>

#include <nlohmann/json_fwd.hpp>

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace glidar::app {

/// Bytes of one point in a cloud with these columns. Throws Error on an unknown name.
std::int64_t point_bytes(std::span<const std::string> columns);

/// Upper bound of the size of a reply, known before its clouds are measured.
std::int64_t reply_bytes(std::span<const std::string> columns, std::size_t points,
                         std::size_t clouds);

/// `glidar stream --lockstep`: measures the frames that clients request.
class LockstepRun {
 public:
  /// Listens, then loads the inputs of the flags. Throws Error.
  LockstepRun(const StreamFlags& flags, Console& console);
  /// Runs until a signal arrives, then answers open requests with an error; returns the exit code.
  int run();

 private:
  /// An open request. The requests of several clients take turns, with some frames each.
  struct Job {
    lockstep::Measure measure;
    lockstep::ReplyTo to;
    std::int64_t bytes = 0;  ///< upper bound of the reply's size
    std::vector<lockstep::CloudReply> replies = {};
    std::vector<link::RecordedFrame> frames = {};  ///< to be recorded after the reply
  };
  enum class Step : std::uint8_t { waits_for_memory, in_progress, answered };

  void serve(const StopRequest& stop);
  void start(lockstep::Received received);
  Step advance(Job& job);
  Step try_advance(Job& job);
  void record(const Job& job);
  [[nodiscard]] nlohmann::ordered_json description() const;
  [[nodiscard]] std::int64_t check(const lockstep::Measure& measure) const;
  void check_deadline(const Job& job) const;
  [[nodiscard]] std::size_t frames_at_once(const Job& job) const;
  void measure_some(Job& job, std::span<const lockstep::Moment> moments);
  [[nodiscard]] lockstep::CloudReply cloud_of(const lockstep::Measure& measure, const Frame& frame,
                                              const Beams& beams);
  void finish(const std::string& ending);

  const StreamFlags& flags_;
  Console& console_;
  link::ErrorLog errors_;
  std::unique_ptr<AtomicFile> stats_file_;
  link::Context context_;
  lockstep::Server server_;
  std::unique_ptr<Recorder> recorder_;
  PreparedScene prepared_;
  link::CloudPool clouds_;
  std::vector<Frame> frames_;
  std::vector<double> frame_s_;  ///< duration of each sensor's last frame; 0: unknown
  std::deque<Job> jobs_;         ///< at most one per client
};

}  // namespace glidar::app
