// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace glidar {

/// The four things a user needs to mend bad input.
struct ErrorParts {
  std::string where;    ///< file:line:column, field, option or file name
  std::string found;    ///< what is wrong, with the value found
  std::string allowed;  ///< what would be right; empty if it says itself
  std::string remedy;   ///< what to do; empty if it says itself
};

/// The one exception type of GLIDAR. Thrown where the cause is known, caught once at the border
/// (`main`, a language binding, a socket). `what()` reads "where: found; allowed: ...; remedy".
class Error : public std::runtime_error {
 public:
  explicit Error(ErrorParts parts);
  [[nodiscard]] const ErrorParts& parts() const noexcept { return parts_; }

 private:
  ErrorParts parts_;
};

/// The shortest digits that read back the same, for numbers in error texts: 0.1, 1e+300.
std::string number_text(double value);

/// Throws Error naming a number that is not allowed: `where` is what it belongs to, "pinhole, fx".
void require_number(bool holds, const char* where, double found, const char* allowed);

/// The candidate probably meant by `word`: by its letters (up to a third wrong, in capitals or
/// not), or as one continues or ends with the other ("range_m", "range"); "" for none.
std::string closest_match(std::string_view word, std::span<const std::string> candidates);

}  // namespace glidar
