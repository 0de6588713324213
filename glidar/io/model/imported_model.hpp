// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/model/model.hpp>
#include <glidar/io/model/texture_search.hpp>

#include <string>
#include <vector>

namespace glidar {

/// What the import process hands over: the model in the file's own units and axes (source, hash and
/// from_cache are not set), and what it depends on, so that a cache can tell whether it still
/// holds.
struct ImportedModel {
  Model model;
  std::vector<std::string> files;   ///< canonical paths of all files read, the model itself first
  std::vector<std::string> absent;  ///< paths that were looked for and are no files inside the root
  std::vector<std::string> texture_folders;  ///< ModelFolder::also of the searches
  std::vector<TextureLookup> lookups;        ///< every texture file that was searched
  std::vector<std::string> libraries;        ///< paths of those that the import program ran with
  std::vector<std::string> hashes;  ///< of the bytes that were parsed, hexadecimal; one per file
  std::vector<std::string>
      sandbox_notes;  ///< mechanisms that the system lacked when it was imported; not cached
};

}  // namespace glidar
