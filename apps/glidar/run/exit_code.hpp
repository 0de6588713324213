// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace glidar::app {

// Exit codes. An interrupt returns 130; `stream` returns 128 plus the signal's number.
inline constexpr int kDone = 0;
inline constexpr int kCheckFailed = 1;   ///< `verify` found errors beyond its bounds
inline constexpr int kBadInput = 2;      ///< options, files, values
inline constexpr int kClosedPipe = 141;  ///< standard output was closed, as shells report it
inline constexpr int kNoPoses = 3;       ///< `stream`: no pose within --pose-timeout

}  // namespace glidar::app
