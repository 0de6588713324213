// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/pictures/colour_scale.hpp>

#include <glidar/math/portable.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace glidar {
namespace {

constexpr double kPercentile = 0.01;  // fraction of values beyond each end
constexpr double kNearby =
    0.25;  // of the span: maximum distance of an extreme that replaces the percentile
constexpr double kSameNumber = 0.001;  // the same relative to the values, without a span

}  // namespace

double ColourScale::fraction(double value) const {
  if (span() > 0.0) return std::clamp((value - low) / span(), 0.0, 1.0);
  return value > low ? 1.0 : 0.0;
}

ColourScale make_colour_scale(std::span<const double> values, ColourScale::Start start) {
  std::vector<double> finite;
  finite.reserve(values.size());
  std::copy_if(values.begin(), values.end(), std::back_inserter(finite),
               [](double value) { return std::isfinite(value); });
  ColourScale scale;
  if (finite.empty()) return scale;
  const auto last = static_cast<double>(finite.size() - 1);
  const auto value_at = [&finite](double rank) {
    const auto place = finite.begin() + static_cast<std::ptrdiff_t>(rank);
    std::nth_element(finite.begin(), place, finite.end());
    return *place;
  };
  scale.has_values = true;
  scale.low = value_at(std::floor(kPercentile * last));
  scale.high = value_at(std::ceil((1.0 - kPercentile) * last));
  const auto [least, greatest] = std::minmax_element(finite.begin(), finite.end());
  const double close = std::max(kNearby * scale.span(),
                                kSameNumber * std::max(std::abs(scale.low), std::abs(scale.high)));
  if (*greatest - scale.high <= close) scale.high = *greatest;
  if (scale.low - *least <= close) scale.low = *least;
  if (start == ColourScale::Start::zero) {
    scale.low = std::min(0.0, scale.low);
    scale.high = std::max(0.0, scale.high);
  }
  scale.clips_low = *least < scale.low;
  scale.clips_high = *greatest > scale.high;
  return scale;
}

std::string scale_number(double value, double span) {
  if (value == 0.0) return "0";
  const double needed = span > 0.0 ? 2.0 - decimal_exponent(span) : 3.0;
  const int decimals = static_cast<int>(std::clamp(needed, 0.0, 9.0));
  constexpr double kMax = 1e5;
  constexpr std::size_t kLongest = 12;
  std::string text = fmt::format("{:.{}f}", std::abs(value), decimals);
  if (std::max(std::abs(value), span) >= kMax || text.size() > kLongest)
    return (value < 0.0 ? "\u2212" : "") + fmt::format("{:.3g}", std::abs(value));
  if (text.find_first_not_of("0.") == std::string::npos) return "0";  // rounded to zero
  if (text.find('.') != std::string::npos && text.find('e') == std::string::npos) {
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
  }
  return value < 0.0 ? "\u2212" + text : text;
}

std::array<std::string, 2> scale_ends(const ColourScale& scale, std::string_view unit) {
  if (!scale.has_values) return {};
  const std::string low = scale_number(scale.low, scale.span());
  const std::string high = scale_number(scale.high, scale.span());
  return {
      (scale.clips_low ? "\u2264 " : "") + low,
      (scale.clips_high ? "\u2265 " : "") + high + (unit.empty() ? "" : " ") + std::string(unit)};
}

}  // namespace glidar
