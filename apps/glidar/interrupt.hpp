// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace glidar::app {

/// From now on Ctrl-C (SIGINT), SIGTERM and a closed terminal (SIGHUP) remove unfinished output
/// files and end the program at once with exit code 130 (128 + SIGINT, as shells have it); a limit
/// on the size of files is told as an error.
void end_cleanly_on_interrupt();

}  // namespace glidar::app
