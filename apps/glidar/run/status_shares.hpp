// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <string>
#include <vector>

namespace glidar::app {

/// "76.2 % valid, 11.3 % border ...": every status that occurs, of `count` that there are.
template <class Status>
std::string status_shares(const std::vector<Status>& statuses, std::size_t count) {
  std::vector<std::size_t> counts(count);
  for (const Status status : statuses) ++counts[static_cast<std::size_t>(status)];
  std::string text;
  for (std::size_t i = 0; i < count; ++i) {
    if (counts[i] == 0) continue;
    text +=
        fmt::format("{}{:.1f} % {}", text.empty() ? "" : ", ",
                    100.0 * static_cast<double>(counts[i]) / static_cast<double>(statuses.size()),
                    to_string(static_cast<Status>(i)));
  }
  return text;
}

}  // namespace glidar::app
