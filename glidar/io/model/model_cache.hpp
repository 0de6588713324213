// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/files/cache_folder.hpp>
#include <glidar/io/model/mesh_blob.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace glidar {

/// The file of one model in the cache folder.
struct CacheEntry {
  CacheFolder folder;
  std::string name;
  std::string importer;  ///< version of the import program; a different one invalidates the file
  std::vector<std::filesystem::path> texture_folders;  ///< of the options
  std::uint64_t limit_bytes = 0;                       ///< of all entries together
};

/// The cache entry of a model with these options; empty when there is no folder
/// (no $XDG_CACHE_HOME, no home), and, with a warning, when the folder must not be used.
/// Throws Error when the variable that limits the cache is not a number.
std::optional<CacheEntry> cache_entry(const std::filesystem::path& canonical_model,
                                      const ModelOptions& options, const Report& report);

struct CachedModel {
  ImportedModel imported;
  std::string hash;  ///< over the content of its files
};

/// The cached model, if the file is valid, the import program and its libraries (Assimp) are
/// unchanged, every file that the model was read from has the same content, every absent one is
/// still absent and every texture search still has the same result.
std::optional<CachedModel> read_cache(const CacheEntry& entry,
                                      const std::filesystem::path& canonical_model);

/// The first file that no longer has the content that the import process claims to have read;
/// empty: none. A malicious model may compromise the import process, so its claim alone
/// is not sufficient: a model is cached only when the files have the hashes that it reports.
/// Throws Error when it lists files or folders that it must not read.
std::string changed_file(const ImportedModel& imported,
                         const std::filesystem::path& canonical_model,
                         const std::vector<std::filesystem::path>& texture_folders = {});

/// One hash of all files: the model file first, the others in the order of their hashes, so that
/// renaming the folder changes nothing.
std::string combined_hash(std::vector<std::string> hashes);

/// Stores the model, whose files are unchanged. Returns the reason for a failure, or "".
/// Failures are not errors.
std::string write_cache(const CacheEntry& entry, const ImportedModel& imported,
                        const std::filesystem::path& canonical_model);

}  // namespace glidar
