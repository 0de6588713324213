// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace glidar::app {

/// The progress display of a task: a bar with percent and the remaining time, or the elapsed time
/// if the fraction is unknown (negative). At most `columns` bytes.
std::string progress_line(std::string_view task, double fraction_done, double elapsed_s,
                          std::size_t columns);

}  // namespace glidar::app
