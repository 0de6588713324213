// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace glidar {

/// The stretch of time that one frame covers, [start_ns, end_ns). A sensor that fires without pause
/// gives a frame the beams it fires in there, so that successive frames join without gap or overlap
/// whatever their length. A camera exposes all of its pixels at start_ns.
struct ScanWindow {
  std::int64_t start_ns = 0;
  std::int64_t end_ns = 0;
};

}  // namespace glidar
