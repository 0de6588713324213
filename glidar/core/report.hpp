// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string_view>

namespace glidar {

/// Progress callback, fraction in [0, 1]; empty: no reporting. Called from worker threads, one call
/// at a time.
using ProgressCallback = std::function<void(double fraction_done)>;

/// Maps the progress of a part to [begin, end] of `whole`, which must outlive the result.
ProgressCallback subrange(const ProgressCallback& whole, double begin, double end);

enum class Severity { info, warning };

/// Callbacks for messages and progress, because the library prints nothing. Empty functions report
/// nothing. `log` gets one printable line, whatever the message contains, see printable_line().
/// `progress` may be called from worker threads, one call at a time; a negative fraction
/// means unknown.
struct Report {
  std::function<void(Severity, std::string_view message)> log;
  std::function<void(std::string_view task, double fraction_done)> progress;

  void info(std::string_view message) const;
  void warn(std::string_view message) const;
};

}  // namespace glidar
