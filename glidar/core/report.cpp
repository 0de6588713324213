// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/report.hpp>

#include <glidar/core/text.hpp>

namespace glidar {

ProgressCallback subrange(const ProgressCallback& whole, double begin, double end) {
  if (!whole) return {};
  return [&whole, begin, end](double fraction) { whole(begin + fraction * (end - begin)); };
}

void Report::info(std::string_view message) const {
  if (log) log(Severity::info, printable_line(message));
}

void Report::warn(std::string_view message) const {
  if (log) log(Severity::warning, printable_line(message));
}

}  // namespace glidar
