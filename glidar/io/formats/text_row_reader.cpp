// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/text_row_reader.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/time_text.hpp>
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
  (void)number(word);
  const std::optional<std::int64_t> exact = parse_seconds_ns(word.text);
  if (exact) return *exact;
  reject(word, "'" + shown(word.text) + "'", "seconds from -9.2e9 to 9.2e9",
         "nanoseconds are allowed in CSV files with a column 'timestamp [ns]'");
}

std::int64_t TextRowReader::whole_ns(const Word& word) const {
  std::int64_t value = 0;
  const auto [end, error] =
      std::from_chars(word.text.data(), word.text.data() + word.text.size(), value);
  if (error == std::errc() && end == word.text.data() + word.text.size()) return value;
  reject(word, "'" + shown(word.text) + "' in a column of nanoseconds", "whole numbers",
         "a column of seconds is called 't'");
}

}  // namespace glidar
