// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace glidar::app {

// What the program returns; an interrupt returns 130, of `stream` 128 and the signal's number.
inline constexpr int kDone = 0;
inline constexpr int kCheckFailed = 1;   ///< `verify` found errors over its bounds
inline constexpr int kBadInput = 2;      ///< options, files, values
inline constexpr int kClosedPipe = 141;  ///< nobody reads standard output, as shells report it
inline constexpr int kNoPoses = 3;       ///< `stream`: none came for --pose-timeout

}  // namespace glidar::app
