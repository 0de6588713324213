// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace glidar {

/// The four parts of an error message.
struct ErrorParts {
  std::string where;         ///< file:line:column, field, option or file name
  std::string found;         ///< what is wrong, with the value found
  std::string allowed = {};  ///< the allowed values; empty if obvious
  std::string remedy = {};   ///< what to do; empty if obvious
};

/// The only exception type of GLIDAR. It is thrown where the cause is known and caught once, in
/// `main`, a language binding or a socket. what() is "where: found; allowed: ...; remedy": one
/// line, whatever the parts contain, see printable_line().
class Error : public std::runtime_error {
 public:
  explicit Error(const ErrorParts& parts);
  [[nodiscard]] const ErrorParts& parts() const noexcept {  // printable too
    return parts_;
  }

 private:
  ErrorParts parts_;
};

/// The shortest decimal text that parses to the same double, for error messages: 0.1, 1e+300.
std::string number_text(double value);

/// Throws Error unless `holds`. `where` names the number's place, e.g. "pinhole, fx".
void require_number(bool holds, const char* where, double found, const char* allowed);

/// The candidate that is most similar to `word`: up to a third of its letters differ (ignoring
/// case), or one begins or ends with the other ("range_m", "range"). Empty if there is none.
std::string closest_match(std::string_view word, std::span<const std::string> candidates);

}  // namespace glidar
