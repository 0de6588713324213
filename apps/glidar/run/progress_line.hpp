// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace glidar::app {

/// What the progress display says of a task: a bar with percent and the time left, or how long it
/// has taken where the fraction is unknown (negative). At most `columns` bytes.
std::string progress_line(std::string_view task, double fraction_done, double elapsed_s,
                          std::size_t columns);

}  // namespace glidar::app
