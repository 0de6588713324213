// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io: reads rows of numbers from a text file; errors contain line and column.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace glidar {

/// A word and the column of its first character, from 1.
struct Word {
  std::string_view text;
  std::size_t column = 1;
};

/// The rows of a text, without blank lines and comments ('#' to the end of the line).
class TextRowReader {
 public:
  /// `content` must outlive the rows.
  TextRowReader(std::string file, std::string_view content);

  /// Reads the next row; false at the end.
  bool next();

  /// The parts of the row, separated by commas and trimmed, or by blanks if there is no comma. At
  /// most 64; a longer row has 65.
  [[nodiscard]] const std::vector<Word>& words() const { return words_; }
  [[nodiscard]] bool has_commas() const { return has_commas_; }
  [[nodiscard]] std::size_t line() const { return line_; }

  /// Throws Error at this word: "file:line:column: found; allowed: ...".
  [[noreturn]] void reject(const Word& word, std::string found, std::string allowed,
                           std::string remedy = "") const;

  /// The word as a finite number; throws Error when it is not one.
  [[nodiscard]] double number(const Word& word) const;

  /// Seconds as nanoseconds, exact for up to nine decimals; throws Error when the word is
  /// not a number or beyond 290 years.
  [[nodiscard]] std::int64_t time_ns(const Word& word) const;

  /// Nanoseconds; throws Error when the word is not a whole number.
  [[nodiscard]] std::int64_t whole_ns(const Word& word) const;

 private:
  void split(std::string_view row);

  std::string file_;
  std::string_view rest_;
  std::size_t line_ = 0;
  std::vector<Word> words_;
  bool has_commas_ = false;
};

}  // namespace glidar
