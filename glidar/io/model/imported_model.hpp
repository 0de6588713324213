// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/model/model.hpp>
#include <glidar/io/model/texture_search.hpp>

#include <string>
#include <vector>

namespace glidar {

/// The result of the import process: the model in the file's own units and axes (source, hash and
/// from_cache are not set), and its dependencies, so that a cache can check whether it is still
/// valid.
struct ImportedModel {
  Model model;
  std::vector<std::string> files;   ///< canonical paths of all files read, the model itself first
  std::vector<std::string> absent;  ///< paths that were searched and are not files inside the root
  std::vector<std::string> material_folders;  ///< ModelFolder::material_folders of the searches
  std::vector<TextureLookup> lookups;         ///< every texture file that was searched
  std::vector<std::string> libraries;  ///< paths of the shared libraries of the import program
  std::vector<std::string> hashes;     ///< of the bytes that were parsed, hexadecimal; one per file
  std::vector<std::string> sandbox_notes;  ///< sandbox mechanisms that the system lacks; not cached
};

}  // namespace glidar
