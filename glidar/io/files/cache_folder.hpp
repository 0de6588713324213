// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io.

#include <glidar/io/files/unique_fd.hpp>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

namespace glidar {

struct ModelOptions;

/// The folder of cached models, opened. Entries are files named by 32 hexadecimal digits and
/// ".model"; all access goes through the descriptor.
struct CacheFolder {
  UniqueFd fd;                 ///< -1: not to be used
  std::filesystem::path path;  ///< for messages
  std::string problem;         ///< why it is not used, with the remedy; empty: it is
};

/// ModelOptions::cache_folder, else $XDG_CACHE_HOME/glidar, else ~/.cache/glidar; none when there
/// is neither.
std::optional<std::filesystem::path> cache_folder_path(const ModelOptions& options);

/// Opens the folder, which is made with access for its owner only (0700) if it does not exist.
/// A folder that belongs to another user, or that others may access, is not used.
CacheFolder open_cache_folder(const std::filesystem::path& path);

/// Most bytes of all entries together: $GLIDAR_CACHE_LIMIT_MIB, else 2 GiB.
/// Throws Error unless that is a whole number of MiB.
std::uint64_t cache_limit_bytes();

/// Opens an entry for reading; -1 when it is not there, not a regular file, belongs to another user
/// or can be written by others.
UniqueFd open_entry(const CacheFolder& folder, const std::string& name);

/// Marks an entry as used now: entries that were not used for longest are evicted first.
void touch_entry(const UniqueFd& entry);

/// Writes an entry under a temporary name and renames it, then evicts others until all entries
/// together are within the limit. Temporary files that dead processes left are removed.
/// Returns why nothing was stored, in words, or "".
std::string store_entry(const CacheFolder& folder, const std::string& name,
                        std::uint64_t limit_bytes, const std::function<void(int fd)>& write);

}  // namespace glidar
