// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/formats/frame_stream.hpp>
#include <glidar/io/model/imported_model.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace glidar {

/// Most parts, materials, textures or files of one model.
inline constexpr std::uint64_t kMaxRecords = std::uint64_t{1} << 20U;

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

/// What a cached model was made with, beside what ImportedModel lists.
struct CacheIndex {
  std::string importer;  ///< version of everything that shapes the model
  std::string root;      ///< folder and root that textures were searched in
  std::string folder;
  std::vector<std::string>
      states_of_libraries;  ///< one per library; another one makes the file void
};

/// A cache file: index, dependencies with their hashes, and model in one frame, whose hash covers
/// all of them.
struct CachedFile {
  CacheIndex index;
  ImportedModel imported;
};

void write_cached_file(int fd, const CacheIndex& index, const ImportedModel& imported);
/// Checks what read_model() checks.
CachedFile read_cached_file(FrameReader& frame);

}  // namespace glidar
