// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/text_row_reader.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/files/text_file.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <system_error>
#include <utility>

namespace glidar {
namespace {

constexpr std::string_view kBlanks = " \t\r";
constexpr std::size_t kMaxWords = 64;

/// Digits as nanoseconds: "12.5" is 12500000000. Empty for any other notation.
std::optional<std::int64_t> decimal_ns(std::string_view text) {
  constexpr int kRowPlaces = 9;
  constexpr std::size_t kMaxDigits = 18;  // nine before the point and nine after it fit 64 bits
  const bool negative = text.starts_with('-');
  if (negative) text.remove_prefix(1);
  const std::size_t point = text.find('.');
  const std::string_view whole = text.substr(0, point);
  std::string_view fraction = point == std::string_view::npos ? "" : text.substr(point + 1);
  if (whole.size() + fraction.size() == 0 || whole.size() > kMaxDigits - kRowPlaces + 1) return {};
  if ((std::string(whole) + std::string(fraction)).find_first_not_of("0123456789") !=
      std::string::npos) {
    return {};
  }
  const bool round_up = fraction.size() > kRowPlaces && fraction[kRowPlaces] >= '5';
  std::string digits = std::string(whole) + std::string(fraction.substr(0, kRowPlaces));
  digits.append(kRowPlaces - std::min<std::size_t>(fraction.size(), kRowPlaces), '0');
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size()) return {};
  value += round_up ? 1 : 0;
  return negative ? -value : value;
}

}  // namespace

TextRowReader::TextRowReader(std::string file, std::string_view content)
    : file_(std::move(file)), rest_(content) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (rest_.starts_with(kByteOrderMark)) rest_.remove_prefix(kByteOrderMark.size());
}

bool TextRowReader::next() {
  while (!rest_.empty()) {
    const std::size_t end = rest_.find('\n');
    std::string_view row = rest_.substr(0, end);
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    ++line_;
    row = row.substr(0, row.find('#'));
    if (row.find_first_not_of(kBlanks) == std::string_view::npos) continue;
    split(row);
    return true;
  }
  return false;
}

void TextRowReader::split(std::string_view row) {
  words_.clear();
  has_commas_ = row.find(',') != std::string_view::npos;
  std::size_t at = 0;
  while (at <= row.size() && words_.size() <= kMaxWords) {
    at = std::min(row.find_first_not_of(kBlanks, at), row.size());
    if (!has_commas_ && at == row.size()) return;
    const std::size_t end =
        std::min(has_commas_ ? row.find(',', at) : row.find_first_of(kBlanks, at), row.size());
    std::string_view text = row.substr(at, end - at);
    text = text.substr(0, text.find_last_not_of(kBlanks) + 1);  // npos + 1 is 0
    words_.push_back({text, at + 1});
    at = end + 1;
  }
}

void TextRowReader::reject(const Word& word, std::string found, std::string allowed,
                           std::string remedy) const {
  const std::string place = file_ + ":" + std::to_string(line_) + ":" + std::to_string(word.column);
  throw Error({place, std::move(found), std::move(allowed), std::move(remedy)});
}

double TextRowReader::number(const Word& word) const {
  std::string_view text = word.text;
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = !text.empty() && end == text.data() + text.size();
  if (whole && error == std::errc() && std::isfinite(value)) return value;
  reject(word, "'" + shown(word.text) + "'", "a finite number");
}

std::int64_t TextRowReader::time_ns(const Word& word) const {
  constexpr double kMax_s = 9.2e9;
  const double seconds = number(word);
  if (std::abs(seconds) > kMax_s) {
    reject(word, "'" + shown(word.text) + "'", "seconds from -9.2e9 to 9.2e9",
           "a file in nanoseconds must be divided by 1e9");
  }
  const std::optional<std::int64_t> exact = decimal_ns(word.text);
  return exact ? *exact : static_cast<std::int64_t>(std::llround(seconds * 1e9));
}

}  // namespace glidar
