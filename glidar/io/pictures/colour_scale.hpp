// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace glidar {

/// The colour scale of all pictures: PNG files, the
/// window, Python and reports.
struct ColourScale {
  enum class Start : std::uint8_t { lowest, zero };

  double low = 0.0;
  double high = 0.0;
  bool clips_low = false;   ///< some values are below `low` and have its colour
  bool clips_high = false;  ///< some values are above `high`
  bool has_values = false;  ///< false: no finite value; low and high are 0

  /// 0 at `low`, 1 at `high`; clamped. A scale without a span is 0 up
  /// to `low` and 1 above.
  [[nodiscard]] double fraction(double value) const;
  [[nodiscard]] double span() const { return high - low; }
};

/// A scale that is robust to outliers: the 1st to the 99th percentile of the finite values
/// (nearest rank, outwards). An end is the extreme value instead when that is at most a quarter
/// of the percentiles' span, or a thousandth of the values, away. With Start::zero it begins at 0.
ColourScale make_colour_scale(std::span<const double> values,
                              ColourScale::Start start = ColourScale::Start::lowest);

/// A number for a scale of this span: enough digits to resolve a percent of the span, U+2212 as
/// the minus sign.
std::string scale_number(double value, double span);

/// Both ends in words: "2.1" and "45 m", or "≤ 2.1" and "≥ 45 m" where values are clipped. Empty
/// without values.
std::array<std::string, 2> scale_ends(const ColourScale& scale, std::string_view unit);

}  // namespace glidar
