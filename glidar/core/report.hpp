// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string_view>

namespace glidar {

enum class Severity { info, warning };

/// How the library talks: it prints nothing, it calls these. Empty functions mean silence.
/// `progress` may be called from worker threads, one call at a time.
struct Report {
  std::function<void(Severity, std::string_view message)> log;
  std::function<void(std::string_view task, double fraction_done)> progress;

  void info(std::string_view message) const {
    if (log) log(Severity::info, message);
  }
  void warn(std::string_view message) const {
    if (log) log(Severity::warning, message);
  }
};

}  // namespace glidar
