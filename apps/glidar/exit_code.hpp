// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace glidar::app {

/// What the program returns; an interrupt returns 130.
enum ExitCode : int {
  kDone = 0,
  kCheckFailed = 1,  ///< `verify` found errors over its bounds
  kBadInput = 2,     ///< options, files, values
};

}  // namespace glidar::app
