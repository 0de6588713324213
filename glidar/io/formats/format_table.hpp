// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io: the table of file formats.

#include <glidar/io/files/staged_files.hpp>
#include <glidar/io/formats/cloud_file.hpp>

#include <cstdint>
#include <filesystem>
#include <vector>

namespace glidar {

/// Whether misses are stored, and whether the file has a sidecar.
enum class Content : std::uint8_t {
  points,    ///< a cloud: organised or dense, by option
  kitti,     ///< a cloud: always dense, with KITTI's intensity
  image,     ///< always the whole frame, with a sidecar
  per_beam,  ///< a preview or a pose: always the whole frame, no sidecar
};

struct Format {
  FileFormat info;
  Content content;
  std::vector<PointField> (*fields)(const PointCloud&);  ///< stored numbers of each point
  void (*write)(const CloudFile&, AtomicFile&);  ///< nullptr: `stage_extra_files` writes all
  /// Adds further files; nullptr: none.
  void (*stage_extra_files)(const CloudFile&, const std::filesystem::path&, StagedFiles&) = nullptr;
  const char* pixels = "";  ///< meaning of an image's pixels, for its sidecar
};

/// All formats, in the order in which they are listed to users.
const std::vector<Format>& formats();

/// The format with the longest suffix that matches the name; trailing separators of
/// the path are ignored.
/// Throws Error naming all formats and the nearest one.
const Format& find_format(const std::filesystem::path& given);

}  // namespace glidar
