// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/files/checksummed_block.hpp>
#include <glidar/io/model/imported_model.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace glidar {

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
