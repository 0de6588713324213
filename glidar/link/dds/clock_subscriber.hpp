// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/link/dds/participant.hpp>
#include <glidar/link/dds/pose_subscriber.hpp>

#include <cstdint>
#include <memory>
#include <optional>

namespace glidar::dds {

/// Receives the simulation's time from /clock.
class ClockSubscriber {
 public:
  explicit ClockSubscriber(const Participant& participant);
  ~ClockSubscriber();
  ClockSubscriber(const ClockSubscriber&) = delete;
  ClockSubscriber& operator=(const ClockSubscriber&) = delete;

  /// The newest time that was not returned yet, ns. Never blocks.
  std::optional<std::int64_t> receive();
  [[nodiscard]] int descriptor() const;
  [[nodiscard]] PoseCounts counts() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace glidar::dds
