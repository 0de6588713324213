// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/frame_stream.hpp>
#include <glidar/io/imported_model.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace glidar {

/// Most parts, materials, textures or files of one model.
inline constexpr std::uint64_t kMostRecords = std::uint64_t{1} << 20U;

/// The two halves of one binary layout: every field of an ImportedModel in the order of its
/// declaration; counts as uint64, then the raw elements.
void write_model(int fd, const ImportedModel& imported);

/// Reads what write_model wrote, from a frame whose head is read already. Checks every size, index
/// and number before the model is handed out, as the writer may have been led astray by a hostile
/// file; throws Error.
ImportedModel read_model(FrameReader& frame);

/// Why the import process gave no model.
struct ImportFailure {
  std::string found;
  std::string remedy;
};

void write_failure(int fd, const ImportFailure& failure);
ImportFailure read_failure(FrameReader& frame);

/// The first frame of a cache file: what its model was made with and from.
struct CacheIndex {
  std::string importer;             ///< version of everything that shapes the model
  std::vector<std::string> files;   ///< paths
  std::vector<std::string> hashes;  ///< of their content, hexadecimal; one per file
  std::vector<std::string> absent;
  std::vector<std::string> texture_folders;
  std::vector<TextureLookup> lookups;
  std::string root;  ///< folder and root that the lookups were made in
  std::string folder;
  std::vector<std::string> libraries;  ///< paths of those that the import program ran with
  std::vector<std::string>
      states_of_libraries;  ///< one per library; another one makes the file void
};

void write_cache_index(int fd, const CacheIndex& index);
CacheIndex read_cache_index(FrameReader& frame);

}  // namespace glidar
