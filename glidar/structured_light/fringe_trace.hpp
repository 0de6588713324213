// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/structured_light/fringe_decoder.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace glidar {

/// One test of a pixel.
struct FringeTest {
  FringeStatus failure = FringeStatus::valid;  ///< the status of a pixel that fails it
  bool has_passed = true;
  std::string finding;  ///< the numbers that were compared
};

/// How a pixel got its coordinate or status.
struct FringeTrace {
  std::uint32_t column = 0;
  std::uint32_t row = 0;
  FringeStatus status = FringeStatus::valid;
  std::uint32_t steps = 0;                 ///< images of fringes, which come first
  std::vector<std::uint16_t> levels = {};  ///< of each image
  double phase_rad = 0.0;                  ///< of the fringes, 0 to 2 pi; 0 without fringes
  double modulation = 0.0;                 ///< levels
  double mean_level = 0.0;
  std::uint32_t stripe = 0;            ///< number of the stripe by the Gray code
  double period = 0.0;                 ///< whole periods that the stripe selects
  double code_error = 0.0;             ///< between phase and code, periods
  double coordinate_px = 0.0;          ///< also of pixels that fail a test
  std::vector<FringeTest> tests = {};  ///< all of them, in their order
};

/// Decodes one pixel as decode_fringes() does, and reports on it. Throws Error as decode_fringes(),
/// and when the pixel is outside the images.
FringeTrace explain_fringes(std::span<const GreyImage> images, const FringePatterns& patterns,
                            const FringeDecoding& decoding,
                            std::array<std::uint32_t, 2> column_row);

/// The trace as lines of text: grey levels, phase, code and tests.
std::string format_fringe_trace(const FringeTrace& trace);

}  // namespace glidar
