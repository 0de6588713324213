// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/files/cache_folder.hpp>
#include <glidar/io/model/imported_model.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace glidar {

/// One model's file in the cache folder.
struct CacheEntry {
  CacheFolder folder;
  std::string name;
  std::string importer;  ///< version of the import program; another one makes the file void
  std::uint64_t limit_bytes = 0;  ///< of all entries together
};

/// Where this model with these options is cached. Not an error, but none, when there is no folder
/// to be had (no $XDG_CACHE_HOME, no home), and, with a warning, when the folder may not be used.
/// Throws Error when the variable that limits the cache is not a number.
std::optional<CacheEntry> cache_entry(const std::filesystem::path& canonical_model,
                                      const ModelOptions& options, const Report& report);

struct CachedModel {
  ImportedModel imported;
  std::string hash;  ///< over the content of its files
};

/// The cached model, if the file is whole, the import program and its libraries (Assimp) are the
/// same as then, every file that the model was read from has the same content, every absent one is
/// still absent and every texture search still ends the same way.
std::optional<CachedModel> read_cache(const CacheEntry& entry,
                                      const std::filesystem::path& canonical_model);

/// The first file that no longer has the content that the import process read (or says it read);
/// empty: all have. The import process may be led astray by a hostile model, so its word alone
/// stores nothing: a model is cached only when the content found here is the content that it names.
/// Throws Error when it lists files or folders that it may not read.
std::string changed_file(const ImportedModel& imported,
                         const std::filesystem::path& canonical_model);

/// One hash over all: the model file first, the others in the order of their hashes, so that
/// renaming the folder changes nothing.
std::string combined_hash(std::vector<std::string> hashes);

/// Stores the model, whose files are unchanged. Returns why not, in words, or "".
/// A cache that cannot be written is no error.
std::string write_cache(const CacheEntry& entry, const ImportedModel& imported,
                        const std::filesystem::path& canonical_model);

}  // namespace glidar
