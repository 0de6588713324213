// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Not installed: the longest sequence of exposures of a depth camera.

namespace glidar {

/// Times within a frame are 32 bits of nanoseconds.
inline constexpr double kMaxSequence_s = 4.0;

}  // namespace glidar
