// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <zip.h>

#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace glidar::import {

/// A ZIP archive in memory, which must outlive it.
class ZipArchive {
 public:
  explicit ZipArchive(std::string_view bytes);

  /// Names of its files, in its order; none if it is unreadable.
  [[nodiscard]] std::vector<std::string> names() const;
  /// The start of a file, at most `max_bytes`; ignores the case of its name. Empty if it is
  /// unreadable.
  [[nodiscard]] std::string text(const std::string& name, std::size_t max_bytes) const;
  /// A whole file, of any size that its compressed data can have (ZIP64 too). Throws Refusal if it
  /// is damaged.
  [[nodiscard]] std::string content(const std::string& name) const;

 private:
  std::unique_ptr<zip_t, void (*)(zip_t*)> archive_;  ///< null: unreadable
  std::size_t bytes_;
};

/// A plain ZIP archive of these files, not compressed.
std::string make_zip(const std::map<std::string, std::string>& files);

/// The name of a file in an archive from a reference to it: "./a%20b.dae" or "/a%20b.dae" is
/// "a b.dae".
std::string zip_name(std::string_view reference);

}  // namespace glidar::import
