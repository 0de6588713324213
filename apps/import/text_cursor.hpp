// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace glidar::import {

class FileContent;

/// The text without a byte order mark. UTF-16 is converted to UTF-8 in `storage`, which must
/// outlive the result.
std::string_view utf8_text(std::string_view bytes, std::string& storage);

/// A decimal number, whole word: "1", "+.5", "1.", "1e0", "nan", "inf", and the words of Windows'
/// C library for the last two ("1.#QNAN"). Too small ones are 0, too large ones infinite.
std::optional<double> number_in(std::string_view word);

/// A decimal integer, whole word.
std::optional<std::int64_t> integer_in(std::string_view word);

/// A word of a file for messages: printable, and limited in length.
std::string shown(std::string_view word);

/// Reads words of lines. Lines end with LF, CR or CR LF.
class TextCursor {
 public:
  /// Of a file, from its byte `begin`; it is read as the cursor advances, and what is behind the
  /// cursor is forgotten. Copies must not be behind the one that advances.
  TextCursor(FileContent& file, std::size_t begin, bool continues, bool comments);

  /// `continues`: a backslash before the end of a line continues it. `comments`: a '#' begins a
  /// comment, also within a word.
  TextCursor(std::string_view text, bool continues, bool comments)
      : at_(text.data()),
        end_(text.data() + text.size()),
        continues_(continues),
        comments_(comments) {}

  /// The next word of this line; empty at its end.
  std::string_view word();
  /// The next word of this line if it has 1 to 9 digits only. Nothing is read if it does not.
  std::optional<std::uint32_t> digits();
  /// Whether only blanks follow in this line.
  [[nodiscard]] bool is_line_read() const;
  /// The rest of this line without blanks at its ends, with its comment and the lines that continue
  /// it.
  std::string rest();
  /// Goes to the end of this line, which no backslash continues.
  void skip_comment();
  /// Goes to the next line, past what is left of this one. False at the end of the text.
  bool next_line();
  /// Goes to the next line with a word, if this one has none left. False at the end of the text.
  bool find_word();

  /// Skips characters of this line.
  void skip(std::size_t count) { at_ += count; }

  [[nodiscard]] std::uint64_t line() const { return line_; }  ///< from 1
  [[nodiscard]] const char* at() const { return at_; }
  [[nodiscard]] std::size_t left() const;  ///< bytes of the text, at most

 private:
  bool read_on();
  [[nodiscard]] bool is_continued(const char* line_end) const;
  void skip_blanks();
  [[nodiscard]] const char* after_line_end(const char* at) const;
  [[nodiscard]] const char* continuation(const char* at) const;

  const char* at_;
  const char* end_;  ///< the start of a line, if the file is not yet read
  bool continues_;
  bool comments_;
  FileContent* file_ = nullptr;  ///< of which more lines may be read; null: all is read
  std::uint64_t line_ = 1;
};

}  // namespace glidar::import
