// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/link/error_log.hpp>

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

}  // namespace glidar::dds
