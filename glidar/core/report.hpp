// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string_view>

namespace glidar {

/// Told how much of a work is done, from 0 to 1; empty: nobody asks. Called from the threads that
/// do the work, one call at a time.
using ProgressCallback = std::function<void(double fraction_done)>;

/// The progress of one part of a work, from `begin` to `end` of it. Refers to `whole`.
ProgressCallback subrange(const ProgressCallback& whole, double begin, double end);

enum class Severity { info, warning };

/// How the library talks: it prints nothing, it calls these. Empty functions mean silence.
/// `progress` may be called from worker threads, one call at a time; a negative fraction means that
/// it is not known.
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
