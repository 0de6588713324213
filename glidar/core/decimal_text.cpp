// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/decimal_text.hpp>

#include <cmath>
#include <cstdint>

namespace glidar {

std::string decimal_text(double value, unsigned decimals) {
  std::uint64_t scale = 1;
  for (unsigned i = 0; i < decimals; ++i) scale *= 10;
  const double scaled = std::floor(std::abs(value) * static_cast<double>(scale) + 0.5);
  constexpr double kMaxWhole = 1e18;
  if (!(scaled < kMaxWhole)) return "none";
  const auto whole = static_cast<std::uint64_t>(scaled);
  std::string text = value < 0.0 && whole > 0 ? "-" : "";
  text += std::to_string(whole / scale);
  if (decimals == 0) return text;
  const std::string fraction = std::to_string(whole % scale);
  return text + '.' + std::string(decimals - fraction.size(), '0') + fraction;
}

}  // namespace glidar
