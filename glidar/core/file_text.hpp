// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/text.hpp>

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

namespace glidar {

inline constexpr std::size_t kMaxColumnName_bytes = 96;

/// Text that a file or a message of others contains: any bytes of any number. It is no string, so
/// that nobody prints it or writes it into a header by mistake; each way out states its use.
class FileText {
 public:
  FileText() = default;
  // Every text may become one. NOLINTNEXTLINE(google-explicit-constructor)
  FileText(std::string bytes) : bytes_(std::move(bytes)) {}
  // NOLINTNEXTLINE(google-explicit-constructor)
  FileText(const char* bytes) : bytes_(bytes) {}

  /// For people: see excerpt().
  [[nodiscard]] std::string shown(std::size_t max_bytes = kMaxExcerpt_bytes) const {
    return excerpt(bytes_, max_bytes);
  }
  /// The name of a column or field in outputs: 1 to 64 letters, digits and '_', which replaces all
  /// others. See is_column_name().
  [[nodiscard]] std::string column_name() const;
  /// A word of a text file: printable UTF-8 without white space, which becomes '_'.
  [[nodiscard]] std::string word() const;
  /// As it is: to compare it, or to write it as the length and bytes of a message.
  [[nodiscard]] const std::string& bytes() const { return bytes_; }

  bool operator==(const FileText&) const = default;
  auto operator<=>(const FileText&) const = default;

 private:
  std::string bytes_;
};

/// Whether a text has 1 to kMaxColumnName_bytes letters, digits and '_', as
/// FileText::column_name(), also with a number. Such names need no quotation marks and no escapes
/// in any output: members of archives, lines of headers, cells of tables.
bool is_column_name(std::string_view text);

}  // namespace glidar
