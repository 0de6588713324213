// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace glidar::app {

/// From now on Ctrl-C (SIGINT) and SIGTERM remove unfinished output files and end the program with
/// exit code 130 (128 + SIGINT, as shells have it).
void end_cleanly_on_interrupt();

}  // namespace glidar::app
