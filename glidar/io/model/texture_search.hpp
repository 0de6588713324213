// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/model/model_folder.hpp>

#include <filesystem>
#include <map>
#include <string>
#include <unordered_map>

namespace glidar {

/// The result of a texture search.
struct TextureLookup {
  std::string name;    ///< as in the model
  std::string found;   ///< canonical path of the file; empty: none
  std::string reason;  ///< reason for a failure, in words

  bool operator==(const TextureLookup&) const = default;
};

/// The text with percent-encoding such as %20 decoded.
std::string percent_decoded(const std::string& text);

/// Searches for the files of texture names, never outside the model's root and the texture folders.
/// Lists each folder at most once, so a search is as old as its object.
class TextureSearch {
 public:
  explicit TextureSearch(ModelFolder folder);

  /// The name is used as it is and normalised (surrounding spaces, backslashes, %20, `file://`,
  /// `model://`, `package://`), absolute and `C:\` paths are cut to their base name, and it is
  /// searched as given, then by its base name, in the model's folder, `textures/`,
  /// `materials/textures/` and, in a model package, `../materials/textures/` and `../textures/`,
  /// then in the folders of material files; then by its last components, most of them first, below
  /// each texture folder; finally by its base name in all these folders ignoring letter case.
  TextureLookup find(const std::string& name);

 private:
  /// The file of a folder with this base name, ignoring letter case; the first in byte order of
  /// several; empty: none.
  [[nodiscard]] std::filesystem::path any_case(const std::filesystem::path& place,
                                               const std::string& base);

  ModelFolder folder_;
  /// Of each folder, the names of its files by their lower-case names.
  std::map<std::filesystem::path, std::unordered_map<std::string, std::string>> listings_;
};

}  // namespace glidar
