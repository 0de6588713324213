// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/imported_model.hpp>

#include <filesystem>
#include <optional>
#include <string>

namespace glidar {

/// One model's file in the cache folder.
struct CacheEntry {
  std::filesystem::path file;
  std::string importer;  ///< version of the import program; another one makes the file void
};

/// Where this model with these options is cached. Not an error, but none, when there is no folder
/// to be had (no $XDG_CACHE_HOME, no home).
std::optional<CacheEntry> cache_entry(const std::filesystem::path& canonical_model,
                                      const ModelOptions& options);

struct CachedModel {
  ImportedModel imported;
  std::string hash;  ///< over the content of its files
};

/// The cached model, if the file is whole, the import program and its libraries (Assimp) are the
/// same as then, every file that the model was read from has the same content, every absent one is
/// still absent and every texture search still ends the same way.
std::optional<CachedModel> read_cache(const CacheEntry& entry,
                                      const std::filesystem::path& canonical_model);

/// Hashes of the content of all its files, hexadecimal. Throws Error when one cannot be read any
/// more or lies outside the model's root.
std::vector<std::string> hash_files(const ImportedModel& imported,
                                    const std::filesystem::path& canonical_model);

/// One hash over all: the model file first, the others in the order of their hashes, so that
/// renaming the folder changes nothing.
std::string combined_hash(std::vector<std::string> hashes);

/// Writes the file under a temporary name and renames it. Returns why not, in words, or "".
/// A cache that cannot be written is no error.
std::string write_cache(const CacheEntry& entry, const ImportedModel& imported,
                        const std::vector<std::string>& hashes,
                        const std::filesystem::path& canonical_model);

}  // namespace glidar
