// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/link/dds/domain.hpp>
#include <glidar/link/error_log.hpp>

#include <cstdint>

namespace glidar::dds {

/// RAII: gives the warnings of Cyclone DDS to a log instead of standard error. Cyclone DDS has one
/// destination per process: with several objects, each gets all warnings.
class LogSink {
 public:
  /// The log must outlive it.
  explicit LogSink(link::ErrorLog& log);
  ~LogSink();
  LogSink(const LogSink&) = delete;
  LogSink& operator=(const LogSink&) = delete;

 private:
  link::ErrorLog& log_;
};

/// False in builds without Cyclone DDS.
bool has_dds();

/// A participant of a DDS domain that ROS 2 nodes find. It outlives all its writers and readers,
/// and the first one in a domain outlives the others of its process, which use its network
/// interface.
class Participant {
 public:
  /// Joins the domain. Reports warnings, such as small socket buffers, to the log, which must
  /// outlive it. Throws Error when the domain is not valid or there is no such network interface,
  /// and in builds without Cyclone DDS.
  Participant(const DomainOptions& options, link::ErrorLog& errors);
  ~Participant();
  Participant(const Participant&) = delete;
  Participant& operator=(const Participant&) = delete;

  [[nodiscard]] std::int32_t handle() const { return handle_; }
  [[nodiscard]] std::uint32_t domain() const { return id_; }
  [[nodiscard]] link::ErrorLog& errors() const { return errors_; }

 private:
  link::ErrorLog& errors_;
  std::uint32_t id_ = 0;
  LogSink sink_;
  std::int32_t domain_handle_ = 0;  ///< negative: another participant has it
  std::int32_t handle_ = 0;
};

}  // namespace glidar::dds
