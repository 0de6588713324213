// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/tof: decode_tof() with what leads to its result.

#include <glidar/tof/pixel_tests.hpp>

namespace glidar::tof {

/// Everything from which decode_tof() finds its result.
struct Decoding {
  Unwrapping unwrapping;
  PhasorImage phasors;  ///< after the filter
  DecodedDepths depths;
  TofMeasurement measurement;
};

/// Throws Error as decode_tof() does.
Decoding decode(const TofImages& images, const TofOptions& options,
                const TofCalibration& calibration, ThreadPool* pool);

}  // namespace glidar::tof
