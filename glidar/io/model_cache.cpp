// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/model_cache.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/version.hpp>
#include <glidar/io/content_hash.hpp>
#include <glidar/io/import_process.hpp>
#include <glidar/io/mesh_blob.hpp>
#include <glidar/io/unique_fd.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <system_error>

namespace glidar {
namespace {

namespace fs = std::filesystem;

std::optional<fs::path> cache_folder(const ModelOptions& options) {
  if (!options.cache_folder.empty()) return options.cache_folder;
  const auto variable = [](const char* name) -> fs::path {
    const char* value = std::getenv(name);
    return value != nullptr ? value : "";
  };
  // The XDG base directory specification: relative values are invalid.
  if (const fs::path xdg = variable("XDG_CACHE_HOME"); xdg.is_absolute()) return xdg / "glidar";
  if (const fs::path home = variable("HOME"); home.is_absolute()) return home / ".cache" / "glidar";
  return std::nullopt;
}

/// Tells a new version of an installed program or library without reading it; empty: not there.
std::string file_state(const fs::path& path) {
  struct stat info {};
  if (::stat(path.c_str(), &info) != 0) return "";
  return fmt::format("{} {} {}.{}", info.st_ino, info.st_size, info.st_mtim.tv_sec,
                     info.st_mtim.tv_nsec);
}

/// The import program as installed, and where it looks for libraries before all other places. The
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

/// True when importing now would read the very same bytes.
bool holds(const CacheIndex& index, const CacheEntry& entry, const fs::path& canonical_model) {
  ModelFolder folder = model_folder(canonical_model);
  folder.also.assign(index.texture_folders.begin(), index.texture_folders.end());
  if (index.importer != entry.importer || index.importer.empty() ||
      index.files.front() != canonical_model.string() || index.root != folder.root.string() ||
      index.folder != folder.folder.string() ||
      index.states_of_libraries != file_states(index.libraries)) {
    return false;
  }
  for (const std::string& path : index.absent) {
    if (!still_absent(path, folder)) return false;
  }
  for (const TextureLookup& lookup : index.lookups) {
    if (find_texture(lookup.name, folder) != lookup) return false;
  }
  for (std::size_t i = 0; i < index.files.size(); ++i) {
    const auto hash = hash_file(index.files[i]);
    if (!hash || hex(*hash) != index.hashes[i]) return false;
  }
  return true;
}

std::string why(const fs::path& path, int error) {
  return "the cache " + path.string() + " cannot be written: " + std::strerror(error);
}

}  // namespace

std::optional<CacheEntry> cache_entry(const fs::path& canonical_model,
                                      const ModelOptions& options) {
  const auto folder = cache_folder(options);
  if (!folder) return std::nullopt;
  const std::string key =
      fmt::format("{}\n{:.17g}", canonical_model.string(), options.crease_angle_rad);
  ContentHash hash;
  hash.add(key.data(), key.size());
  return CacheEntry{*folder / (hex(hash.value()) + ".model"), importer_version()};
}

std::optional<CachedModel> read_cache(const CacheEntry& entry, const fs::path& canonical_model) {
  const UniqueFd fd(::open(entry.file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (!fd) return std::nullopt;
  try {
    FrameReader head(fd.get());
    const CacheIndex index = read_cache_index(head);
    if (!holds(index, entry, canonical_model)) return std::nullopt;
    FrameReader body(fd.get());
    return CachedModel{read_model(body), combined_hash(index.hashes)};
  } catch (const Error&) {
    return std::nullopt;  // damaged or of an older layout: it is made anew
  }
}

std::vector<std::string> hash_files(const ImportedModel& imported,
                                    const fs::path& canonical_model) {
  const ModelFolder folder = model_folder(canonical_model);
  std::vector<std::string> hashes;
  for (const std::string& file : imported.files) {
    // The list comes from the import process: it gets no file read here that it may not read.
    const bool allowed = confine(file, folder).path == file;
    const auto hash = allowed ? hash_file(file) : std::nullopt;
    if (!hash) {
      throw Error({.where = canonical_model.string(),
                   .found = "its file " + file + " cannot be read again",
                   .allowed = "",
                   .remedy = "try again"});
    }
    hashes.push_back(hex(*hash));
  }
  return hashes;
}

std::string combined_hash(std::vector<std::string> hashes) {
  std::sort(hashes.begin() + 1, hashes.end());
  ContentHash hash;
  for (const std::string& one : hashes) hash.add(one.data(), one.size());
  return hex(hash.value());
}

std::string write_cache(const CacheEntry& entry, const ImportedModel& imported,
                        const std::vector<std::string>& hashes, const fs::path& canonical_model) {
  std::error_code error;
  fs::create_directories(entry.file.parent_path(), error);
  if (error) return why(entry.file.parent_path(), error.value());
  std::string temporary = entry.file.string() + ".XXXXXX";
  const UniqueFd fd(::mkostemp(temporary.data(), O_CLOEXEC));
  if (!fd) return why(entry.file, errno);
  const ModelFolder folder = model_folder(canonical_model);
  try {
    write_cache_index(
        fd.get(), {entry.importer, imported.files, hashes, imported.absent,
                   imported.texture_folders, imported.lookups, folder.root.string(),
                   folder.folder.string(), imported.libraries, file_states(imported.libraries)});
    write_model(fd.get(), imported);
  } catch (const Error& failure) {
    fs::remove(temporary, error);
    return "the cache cannot be written: " + failure.parts().found;
  }
  fs::rename(temporary, entry.file, error);
  if (!error) return "";
  const std::string reason = why(entry.file, error.value());
  fs::remove(temporary, error);
  return reason;
}

}  // namespace glidar
