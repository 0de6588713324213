// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/text_cursor.hpp>

#include <import/model_files.hpp>

#include <glidar/core/text.hpp>
#include <glidar/math/constants.hpp>

#include <array>
#include <charconv>
#include <system_error>
#include <utility>

namespace glidar::import {
namespace {

constexpr std::size_t kPiece_bytes = (std::size_t{1} << 20U) + 1;  // of a file

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\v' || c == '\f';
}

bool is_line_end(char c) {
  return c == '\n' || c == '\r';
}

/// Characters that may end a word, by their codes.
constexpr auto kMayEndWord = [] {
  std::array<bool, 256> may_end{};
  for (const char c : {' ', '\t', '\v', '\f', '\n', '\r', '#', '\\'}) {
    may_end[static_cast<unsigned char>(c)] = true;
  }
  return may_end;
}();

void append_utf8(char32_t code, std::string& text) {
  constexpr char32_t kTail = 0x3F;
  const auto byte = [](char32_t value) { return static_cast<char>(value); };
  if (code < 0x80) {
    text += byte(code);
  } else if (code < 0x800) {
    text += {byte(0xC0U | (code >> 6U)), byte(0x80U | (code & kTail))};
  } else if (code < 0x10000) {
    text += {byte(0xE0U | (code >> 12U)), byte(0x80U | ((code >> 6U) & kTail)),
             byte(0x80U | (code & kTail))};
  } else {
    text += {byte(0xF0U | (code >> 18U)), byte(0x80U | ((code >> 12U) & kTail)),
             byte(0x80U | ((code >> 6U) & kTail)), byte(0x80U | (code & kTail))};
  }
}

std::string utf8_of_utf16(std::string_view bytes, bool big_endian) {
  const auto unit = [&](std::size_t i) {
    const auto first = static_cast<unsigned char>(bytes[i]);
    const auto second = static_cast<unsigned char>(bytes[i + 1]);
    return static_cast<char32_t>(big_endian ? first << 8U | second : second << 8U | first);
  };
  std::string text;
  text.reserve(bytes.size() / 2);
  for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
    char32_t code = unit(i);
    const bool is_high = code >= 0xD800 && code < 0xDC00;
    if (is_high && i + 3 < bytes.size() && unit(i + 2) >= 0xDC00 && unit(i + 2) < 0xE000) {
      i += 2;
      code = 0x10000 + ((code - 0xD800) << 10U) + (unit(i) - 0xDC00);
    }
    append_utf8(code, text);
  }
  return text;
}

/// Most words of faces are short and have digits only.
std::optional<double> short_whole_number(std::string_view word) {
  constexpr std::size_t kMostDigits = 9;
  if (word.empty() || word.size() > kMostDigits) return std::nullopt;
  std::uint32_t value = 0;
  for (const char c : word) {
    if (c < '0' || c > '9') return std::nullopt;
    value = 10 * value + static_cast<std::uint32_t>(c - '0');
  }
  return value;
}

/// "1.#QNAN", "-1.#IND", "1.#INF00", "-nan(ind)".
std::optional<double> number_of_windows(std::string_view word) {
  const double sign = word.starts_with('-') ? -1.0 : 1.0;
  if (word.starts_with('-')) word.remove_prefix(1);
  const std::string small = lower_case(word);
  if (small == "nan(ind)" || small == "nan(snan)") return kNaN;
  if (small.starts_with("1.#inf")) return sign * kInfinity;
  for (const char* nan : {"1.#qnan", "1.#ind", "1.#snan", "1.#nan"}) {
    if (small.starts_with(nan)) return kNaN;
  }
  return std::nullopt;
}

}  // namespace

std::string_view utf8_text(std::string_view bytes, std::string& storage) {
  if (bytes.starts_with("\xEF\xBB\xBF")) return bytes.substr(3);
  const bool big_endian = bytes.starts_with("\xFE\xFF");
  if (!big_endian && !bytes.starts_with("\xFF\xFE")) return bytes;
  storage = utf8_of_utf16(bytes.substr(2), big_endian);
  return storage;
}

std::optional<double> number_in(std::string_view word) {
  if (const auto whole = short_whole_number(word)) return whole;
  const char* from = word.data();
  const char* const end = from + word.size();
  if (from != end && *from == '+') {
    ++from;
    if (from != end && (*from == '-' || *from == '+')) return std::nullopt;
  }
  double value = 0.0;
  const auto [stop, problem] = std::from_chars(from, end, value);
  if (stop != end || problem == std::errc::invalid_argument) {
    return word.find_first_of("#(") == std::string_view::npos ? std::nullopt
                                                              : number_of_windows(word);
  }
  if (problem == std::errc()) return value;
  const bool is_small =
      word.find("e-") != std::string_view::npos || word.find("E-") != std::string_view::npos;
  return is_small ? 0.0 : word.starts_with('-') ? -kInfinity : kInfinity;
}

std::optional<std::int64_t> integer_in(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  std::int64_t value = 0;
  const char* const end = word.data() + word.size();
  const auto [stop, problem] = std::from_chars(word.data(), end, value);
  if (stop != end || problem != std::errc()) return std::nullopt;
  return value;
}

std::string shown(std::string_view word) {
  constexpr std::size_t kLongest = 60;
  std::string text(word.substr(0, kLongest));
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = '?';
  }
  return word.size() > kLongest ? text + "..." : text;
}

TextCursor::TextCursor(FileContent& file, std::size_t begin, bool continues, bool comments)
    : TextCursor({}, continues, comments) {
  file_ = &file;
  at_ = end_ = file.head(kPiece_bytes).substr(begin).data();
  read_on();
}

std::size_t TextCursor::left() const {
  const char* const end = file_ == nullptr ? end_ : file_->head(0).data() + file_->size();
  return static_cast<std::size_t>(end - at_);
}

/// Whether the line end belongs to a line that a backslash continues.
bool TextCursor::is_continued(const char* line_end) const {
  if (!continues_) return false;
  while (line_end != at_ && (is_blank(line_end[-1]) || line_end[-1] == '\r')) --line_end;
  return line_end != at_ && line_end[-1] == '\\';
}

/// Reads more whole lines of the file. False at its end.
bool TextCursor::read_on() {
  if (file_ == nullptr) return false;
  file_->forget_before(at_);
  const char* const begin = file_->head(0).data();
  const auto read = static_cast<std::size_t>(end_ - begin);
  for (std::size_t more = kPiece_bytes;; more *= 2) {
    const std::string_view text = file_->head(read + more);
    const char* last = text.data() + text.size();
    if (text.size() < read + more) {
      file_ = nullptr;
      return last != std::exchange(end_, last);
    }
    while (last != end_ && (last[-1] != '\n' || is_continued(last - 1))) --last;
    if (last != end_) {
      end_ = last;
      return true;
    }
  }
}

const char* TextCursor::after_line_end(const char* at) const {
  return at + (*at == '\r' && at + 1 != end_ && at[1] == '\n' ? 2 : 1);
}

/// The start of the next line if a backslash at `at` continues this one; else null.
const char* TextCursor::continuation(const char* at) const {
  if (!continues_ || *at != '\\') return nullptr;
  for (++at; at != end_ && is_blank(*at);) ++at;
  if (at == end_) return at;
  return is_line_end(*at) ? after_line_end(at) : nullptr;
}

/// A comment is skipped too.
void TextCursor::skip_blanks() {
  for (;;) {
    while (at_ != end_ && is_blank(*at_)) ++at_;
    if (at_ == end_) return;
    if (comments_ && *at_ == '#') return skip_comment();
    const char* const next = continuation(at_);
    if (next == nullptr) return;
    at_ = next;
    ++line_;
  }
}

std::string_view TextCursor::word() {
  skip_blanks();
  const char* const from = at_;
  // "1.#IND" is a number of Windows' C library.
  const auto is_comment = [&] {
    const bool is_number = at_ != from && at_[-1] == '.' && at_ + 1 != end_ &&
                           std::string_view("IQS").find(at_[1]) != std::string_view::npos;
    return comments_ && *at_ == '#' && !is_number;
  };
  const auto ends = [&] {
    return kMayEndWord[static_cast<unsigned char>(*at_)] &&
           (is_blank(*at_) || is_line_end(*at_) || is_comment() || continuation(at_) != nullptr);
  };
  while (at_ != end_ && !ends()) ++at_;
  return {from, static_cast<std::size_t>(at_ - from)};
}

std::optional<std::uint32_t> TextCursor::digits() {
  constexpr std::ptrdiff_t kMostDigits = 9;
  const char* at = at_;
  while (at != end_ && is_blank(*at)) ++at;
  const char* const from = at;
  std::uint32_t value = 0;
  for (; at != end_ && at - from < kMostDigits && *at >= '0' && *at <= '9'; ++at) {
    value = 10 * value + static_cast<std::uint32_t>(*at - '0');
  }
  if (at == from || (at != end_ && !is_blank(*at) && !is_line_end(*at))) return std::nullopt;
  at_ = at;
  return value;
}

bool TextCursor::is_line_read() const {
  const char* at = at_;
  while (at != end_ && is_blank(*at)) ++at;
  return at == end_ || is_line_end(*at);
}

std::string TextCursor::rest() {
  std::string text;
  for (;;) {
    const char* const from = at_;
    const char* next = nullptr;
    while (at_ != end_ && !is_line_end(*at_) && (next = continuation(at_)) == nullptr) ++at_;
    text.append(from, at_);
    if (next == nullptr) return std::string(trimmed(text));
    text += ' ';
    at_ = next;
    ++line_;
  }
}

void TextCursor::skip_comment() {
  while (at_ != end_ && !is_line_end(*at_)) ++at_;
}

bool TextCursor::next_line() {
  while (continues_ && !word().empty()) {
  }
  while (at_ != end_ && !is_line_end(*at_)) ++at_;
  if (at_ == end_) return false;
  at_ = after_line_end(at_);
  ++line_;
  return true;
}

bool TextCursor::find_word() {
  for (;;) {
    skip_blanks();
    if (at_ == end_) {
      if (!read_on()) return false;
    } else if (is_line_end(*at_)) {
      next_line();
    } else {
      return true;
    }
  }
}

}  // namespace glidar::import
