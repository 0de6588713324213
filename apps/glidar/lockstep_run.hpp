// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/console.hpp>
#include <apps/glidar/interrupt.hpp>
#include <apps/glidar/recorder.hpp>
#include <apps/glidar/session.hpp>
#include <apps/glidar/stream_options.hpp>
#include <glidar/io/atomic_file.hpp>
#include <glidar/link/cloud_pool.hpp>
#include <glidar/link/fault_log.hpp>
#include <glidar/link/lockstep/server.hpp>

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace glidar::app {

/// `glidar stream --lockstep`: measures what clients ask for, when they ask.
class LockstepRun {
 public:
  /// Listens, then loads what the flags name. Throws Error.
  LockstepRun(const StreamFlags& flags, Console& console);
  /// Until a signal comes; returns the exit code.
  int run();

 private:
  void serve(const StopRequest& stop);
  void answer(const lockstep::Request& request);
  void record();
  void describe(const lockstep::Describe& describe);
  void measure(const lockstep::Measure& measure);
  void check(const lockstep::Measure& measure) const;
  void measure_some(const lockstep::Measure& measure, std::span<const lockstep::Moment> moments,
                    std::vector<lockstep::CloudReply>& replies);
  [[nodiscard]] std::shared_ptr<const Beams> beams_of(std::uint32_t sensor,
                                                      std::uint32_t number) const;
  [[nodiscard]] lockstep::CloudReply cloud_of(const lockstep::Measure& measure, const Frame& frame,
                                              const Beams& beams);
  void finish(const std::string& ending);

  const StreamFlags& flags_;
  Console& console_;
  link::FaultLog faults_;
  std::unique_ptr<AtomicFile> stats_file_;
  link::Context context_;
  lockstep::Server server_;
  std::unique_ptr<Recorder> recorder_;
  Session session_;
  std::vector<std::shared_ptr<const Beams>> beams_;  ///< of each sensor's frame 0
  link::CloudPool clouds_;
  std::vector<Frame> frames_;
  std::vector<link::RecordedFrame> measured_;  ///< for the request under way
};

}  // namespace glidar::app
