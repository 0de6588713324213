// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/tof/tof_decode.hpp>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace glidar {

/// One test of a pixel.
struct TofTest {
  TofStatus failure = TofStatus::valid;  ///< the status of a pixel that fails it
  bool has_passed = true;
  std::string finding;  ///< the numbers that were compared
};

/// A choice of whole periods.
struct TofCandidate {
  double range_m = 0.0;
  double misfit_rad = 0.0;
  std::vector<double> periods = {};  ///< whole periods of each frequency
};

/// How a pixel got its range or status.
struct TofTrace {
  std::uint32_t column = 0;
  std::uint32_t row = 0;
  TofStatus status = TofStatus::valid;
  double range_m = 0.0;  ///< also of pixels that fail a test
  double depth_m = 0.0;
  double misfit_rad = 0.0;
  std::vector<std::vector<double>> levels = {};  ///< frequencies x taps: the raw values
  std::vector<double> frequencies_hz = {};
  std::vector<double> amplitude = {};         ///< of each frequency, after the filter
  std::vector<double> phase_rad = {};         ///< of each frequency, after the filter
  std::vector<TofCandidate> candidates = {};  ///< the least misfit first
  std::vector<TofTest> tests = {};            ///< all of them, in their order
};

/// Decodes the images and reports on one pixel, from the same numbers and tests. Throws Error as
/// decode_tof() does, and when the pixel is outside the image.
TofTrace explain_tof(const TofImages& images, const TofOptions& options,
                     std::array<std::uint32_t, 2> column_row,
                     const TofCalibration& calibration = {}, const TofRun& run = {});

/// The trace as lines of text: result, tests, phases and the best candidates.
std::string format_tof_trace(const TofTrace& trace);

}  // namespace glidar
