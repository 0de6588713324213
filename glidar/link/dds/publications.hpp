// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/ros/message_types.hpp>
#include <glidar/link/dds/participant.hpp>
#include <glidar/link/dds/wake_up.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace glidar::dds {

/// A writer of another participant.
struct Publication {
  std::string type_name;  ///< in DDS: nav_msgs::msg::dds_::Odometry_
  bool reliable = false;
  bool transient_local = false;
};

/// Finds the writers of a topic in a domain.
class Publications {
 public:
  /// Signals `wake_up`, which must outlive it, when writers of any topic appear. Throws Error.
  Publications(const Participant& participant, const WakeUp& wake_up);
  ~Publications();
  Publications(const Publications&) = delete;
  Publications& operator=(const Publications&) = delete;

  /// Those that exist now.
  [[nodiscard]] std::vector<Publication> of(const std::string& full_name) const;

 private:
  std::int32_t participant_ = 0;
  std::int32_t handle_ = 0;
};

}  // namespace glidar::dds
