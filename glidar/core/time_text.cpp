// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/time_text.hpp>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <system_error>

namespace glidar {
namespace {

constexpr int kTimePlaces = 9;
constexpr std::int64_t kNsPerSecond = 1'000'000'000;
constexpr std::int64_t kLatestSecond = 9'200'000'000;

bool is_digits(std::string_view text) {
  return text.find_first_not_of("0123456789") == std::string_view::npos;
}

/// The whole text as a number; a sign + is allowed.
template <class Number>
std::optional<Number> whole_number(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  Number value = 0;
  const char* const last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, value);
  if (text.empty() || error != std::errc() || end != last) return std::nullopt;
  return value;
}

/// Digits with a decimal point before the digit `point`, as nanoseconds.
std::optional<std::int64_t> digits_ns(std::string digits, std::int64_t point) {
  const auto zeros = std::min(digits.find_first_not_of('0'), digits.size());
  digits.erase(0, zeros);
  point -= static_cast<std::int64_t>(zeros);
  if (digits.empty() || point < -kTimePlaces) return 0;
  constexpr std::int64_t kMaxPlaces = 10;  // of the seconds
  if (point > kMaxPlaces) return std::nullopt;
  const auto kept = static_cast<std::size_t>(point + kTimePlaces);
  const bool rounds_up = digits.size() > kept && digits[kept] >= '5';
  digits.resize(kept, '0');
  const std::int64_t value = digits.empty() ? 0 : whole_number<std::int64_t>(digits).value_or(-1);
  if (value < 0 || value > kLatestSecond * kNsPerSecond) return std::nullopt;
  return value + (rounds_up ? 1 : 0);
}

/// The number of a field of a date, such as the month; -1 for other texts.
int field_of(std::string_view text, std::size_t at, std::size_t size) {
  const std::string_view part = at < text.size() ? text.substr(at, size) : std::string_view();
  return part.size() == size && is_digits(part) ? whole_number<int>(part).value_or(-1) : -1;
}

}  // namespace

std::optional<std::int64_t> parse_seconds_ns(std::string_view text) {
  const bool is_negative = text.starts_with('-');
  if (is_negative || text.starts_with('+')) text.remove_prefix(1);
  const std::size_t mark = std::min(text.find_first_of("eE"), text.size());
  std::int64_t exponent = 0;
  if (mark < text.size()) {
    const std::optional<std::int32_t> given = whole_number<std::int32_t>(text.substr(mark + 1));
    if (!given) return std::nullopt;
    exponent = *given;
  }
  const std::string_view mantissa = text.substr(0, mark);
  const std::size_t point = std::min(mantissa.find('.'), mantissa.size());
  std::string digits(mantissa);
  if (point < mantissa.size()) digits.erase(point, 1);
  if (digits.empty() || !is_digits(digits)) return std::nullopt;
  const std::optional<std::int64_t> value =
      digits_ns(std::move(digits), static_cast<std::int64_t>(point) + exponent);
  if (!value) return std::nullopt;
  return is_negative ? -*value : *value;
}

std::optional<std::int64_t> parse_date_ns(std::string_view text) {
  // 2026-01-31T12:00:00.5Z
  constexpr std::string_view kForm = "    -  -  T  :  :";
  if (text.size() < kForm.size() + 3 || !text.ends_with('Z')) return std::nullopt;
  for (std::size_t i = 0; i < kForm.size(); ++i) {
    if (kForm[i] != ' ' && text[i] != kForm[i]) return std::nullopt;
  }
  const std::chrono::year_month_day date{
      std::chrono::year(field_of(text, 0, 4)),
      std::chrono::month(static_cast<unsigned>(field_of(text, 5, 2))),
      std::chrono::day(static_cast<unsigned>(field_of(text, 8, 2)))};
  const int hour = field_of(text, 11, 2);
  const int minute = field_of(text, 14, 2);
  std::string_view seconds = text.substr(kForm.size());
  seconds.remove_suffix(1);
  const bool is_plain = is_digits(seconds.substr(0, 2)) && seconds.find_first_of("eE") > 20;
  const std::optional<std::int64_t> second_ns =
      is_plain ? parse_seconds_ns(seconds) : std::optional<std::int64_t>();
  constexpr int kMinYear = 1970;
  constexpr int kMaxYear = 2200;
  const bool is_valid = date.ok() && int(date.year()) >= kMinYear && int(date.year()) < kMaxYear &&
                        hour >= 0 && hour < 24 && minute >= 0 && minute < 60 && second_ns &&
                        *second_ns < 60 * kNsPerSecond;
  if (!is_valid) return std::nullopt;
  const std::int64_t days = std::chrono::sys_days(date).time_since_epoch().count();
  return ((days * 24 + hour) * 60 + minute) * 60 * kNsPerSecond + *second_ns;
}

std::string decimal_seconds(std::int64_t t_ns) {
  const std::uint64_t size =
      t_ns < 0 ? ~static_cast<std::uint64_t>(t_ns) + 1 : static_cast<std::uint64_t>(t_ns);
  std::string text = (t_ns < 0 ? "-" : "") + std::to_string(size / kNsPerSecond);
  std::string fraction =
      std::to_string(kNsPerSecond + static_cast<std::int64_t>(size % kNsPerSecond));
  fraction[0] = '.';
  fraction.erase(fraction.find_last_not_of('0') + 1);
  return fraction == "." ? text : text + fraction;
}

}  // namespace glidar
