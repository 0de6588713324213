// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/model/model_cache.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/version.hpp>
#include <glidar/io/decoder/import_program.hpp>
#include <glidar/io/files/content_hash.hpp>
#include <glidar/io/model/import_process.hpp>
#include <glidar/io/model/mesh_blob.hpp>

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace glidar {
namespace {

namespace fs = std::filesystem;

/// Identifies a version of an installed program or library without reading it; empty: missing.
std::string file_state(const fs::path& path) {
  struct stat info {};
  if (::stat(path.c_str(), &info) != 0) return "";
  return fmt::format("{} {} {}.{}", info.st_ino, info.st_size, info.st_mtim.tv_sec,
                     info.st_mtim.tv_nsec);
}

/// The installed import program, and the path that it searches for libraries first. The
/// libraries themselves are known once it has run.
std::string importer_version() {
  const std::string state = file_state(import_program());
  if (state.empty()) return "";
  const char* libraries = std::getenv("LD_LIBRARY_PATH");
  return fmt::format("{} {} {}", version(), state, libraries != nullptr ? libraries : "");
}

std::vector<std::string> file_states(const std::vector<std::string>& paths) {
  std::vector<std::string> states;
  for (const std::string& path : paths) states.push_back(file_state(path));
  return states;
}

bool still_absent(const std::string& path, const ModelFolder& folder) {
  return confine(path, folder).access != Access::granted;
}

/// True when importing now would read identical bytes.
bool holds(const CachedFile& cached, const CacheEntry& entry, const fs::path& canonical_model) {
  const CacheIndex& index = cached.index;
  const ImportedModel& imported = cached.imported;
  ModelFolder folder = model_folder(canonical_model, entry.texture_folders);
  folder.material_folders.assign(imported.material_folders.begin(),
                                 imported.material_folders.end());
  if (index.importer != entry.importer || index.importer.empty() ||
      imported.files.front() != canonical_model.string() || index.root != folder.root.string() ||
      index.folder != folder.folder.string() ||
      index.states_of_libraries != file_states(imported.libraries)) {
    return false;
  }
  for (const std::string& path : imported.absent) {
    if (!still_absent(path, folder)) return false;
  }
  TextureSearch search(std::move(folder));
  for (const TextureLookup& lookup : imported.lookups) {
    if (search.find(lookup.name) != lookup) return false;
  }
  return changed_file(imported, canonical_model, entry.texture_folders).empty();
}

}  // namespace

std::optional<CacheEntry> cache_entry(const fs::path& canonical_model, const ModelOptions& options,
                                      const Report& report) {
  const auto path = cache_folder_path(options);
  if (!path) return std::nullopt;
  const std::uint64_t limit_bytes = cache_limit_bytes();
  CacheFolder folder = open_cache_folder(*path);
  if (!folder.problem.empty()) {
    report.warn(folder.problem);
    return std::nullopt;
  }
  std::string key = fmt::format("{}\n{:.17g}", canonical_model.string(), options.crease_angle_rad);
  for (const fs::path& one : options.texture_folders) key += "\n" + one.string();
  ContentHash hash;
  hash.add(key.data(), key.size());
  return CacheEntry{std::move(folder), hex(hash.value()) + ".model", importer_version(),
                    options.texture_folders, limit_bytes};
}

std::optional<CachedModel> read_cache(const CacheEntry& entry, const fs::path& canonical_model) {
  const UniqueFd fd = open_entry(entry.folder, entry.name);
  if (!fd) return std::nullopt;
  try {
    BlockReader block(fd.get());
    CachedFile cached = read_cached_file(block);
    if (!holds(cached, entry, canonical_model)) return std::nullopt;
    touch_entry(fd);
    std::string hash = combined_hash(cached.imported.hashes);
    return CachedModel{std::move(cached.imported), std::move(hash)};
  } catch (const Error&) {
    return std::nullopt;  // corrupt or of an older format: import again
  }
}

std::string changed_file(const ImportedModel& imported, const fs::path& canonical_model,
                         const std::vector<fs::path>& texture_folders) {
  const ModelFolder folder = model_folder(canonical_model, texture_folders);
  if (imported.files.front() != canonical_model.string()) {
    reject_answer(canonical_model, "it is for another model");
  }
  const std::vector<fs::path> allowed = folder.allowed();
  for (const std::string& place : imported.material_folders) {
    const bool is_allowed = std::any_of(allowed.begin(), allowed.end(),
                                        [&](const fs::path& one) { return is_inside(place, one); });
    if (!is_allowed) reject_answer(canonical_model, "a folder outside");
  }
  std::string changed;
  for (std::size_t i = 0; i < imported.files.size() && changed.empty(); ++i) {
    const std::string& file = imported.files[i];
    const ConfinedFile confined = confine(file, folder);
    if (confined.access == Access::outside) reject_answer(canonical_model, "a file outside");
    const auto hash = confined.path == file ? hash_file(file) : std::nullopt;
    if (!hash || hex(*hash) != imported.hashes[i]) changed = file;
  }
  return changed;
}

std::string combined_hash(std::vector<std::string> hashes) {
  std::sort(hashes.begin() + 1, hashes.end());
  ContentHash hash;
  for (const std::string& one : hashes) hash.add(one.data(), one.size());
  return hex(hash.value());
}

std::string write_cache(const CacheEntry& entry, const ImportedModel& imported,
                        const fs::path& canonical_model) {
  const ModelFolder folder = model_folder(canonical_model);
  const CacheIndex index{entry.importer, folder.root.string(), folder.folder.string(),
                         file_states(imported.libraries)};
  return store_entry(entry.folder, entry.name, entry.limit_bytes,
                     [&](int fd) { write_cached_file(fd, index, imported); });
}

}  // namespace glidar
