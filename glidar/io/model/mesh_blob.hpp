// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/files/checksummed_block.hpp>
#include <glidar/io/model/model.hpp>
#include <glidar/io/model/texture_search.hpp>

#include <cstdint>
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

/// Maximum number of parts, materials, textures or files of one model.
inline constexpr std::uint64_t kMaxRecords = std::uint64_t{1} << 20U;

/// Writes the binary format: every field of an ImportedModel in the order of
/// declaration; counts as uint64, then the raw elements.
void write_model(int fd, const ImportedModel& imported);

/// Reads what write_model wrote, from a block whose header was read already. Checks every size,
/// index and number before it returns the model, because a malicious file may have compromised the
/// writer; throws Error.
ImportedModel read_model(BlockReader& block);

/// Why the import process returned no model.
struct ImportFailure {
  std::string found;
  std::string remedy;
};

void write_failure(int fd, const ImportFailure& failure);
ImportFailure read_failure(BlockReader& block);

/// Dependencies of a cached model other than those in ImportedModel.
struct CacheIndex {
  std::string importer;  ///< version of everything that affects the model
  std::string root;      ///< root of the texture search; its folder follows
  std::string folder;
  std::vector<std::string>
      states_of_libraries;  ///< one per library; a different one invalidates the file
};

/// A cache file: index, dependencies with their hashes, and model in one block, whose hash covers
/// all of them.
struct CachedFile {
  CacheIndex index;
  ImportedModel imported;
};

void write_cached_file(int fd, const CacheIndex& index, const ImportedModel& imported);
/// Checks what read_model() checks.
CachedFile read_cached_file(BlockReader& block);

}  // namespace glidar
