// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io: every file format, one line each.

#include <glidar/io/files/staged_files.hpp>
#include <glidar/io/formats/cloud_file.hpp>

#include <cstdint>
#include <filesystem>
#include <vector>

namespace glidar {

/// Which misses go into the file, and whether a sidecar belongs to it.
enum class Content : std::uint8_t {
  points,    ///< a cloud: organised or dense, as the options say
  kitti,     ///< a cloud: always dense, with KITTI's intensity
  image,     ///< always the whole frame, with a sidecar
  per_beam,  ///< a picture for people or a pose: always the whole frame, no sidecar
};

struct Format {
  FileFormat told;
  Content content;
  std::vector<Field> (*fields)(const PointCloud&);  ///< what it stores of each point
  void (*write)(const CloudFile&, AtomicFile&);     ///< nullptr: `beside` writes it all
  /// Adds further files; nullptr: there are none.
  void (*beside)(const CloudFile&, const std::filesystem::path&, StagedFiles&) = nullptr;
  const char* pixels = "";  ///< what those of an image are, for its sidecar
};

/// All formats, in the order in which they are listed to users.
const std::vector<Format>& formats();

/// The format whose suffix the name ends with, the longest one that fits; separators at the end of
/// the path do not count.
/// Throws Error naming all formats and the nearest.
const Format& find_format(const std::filesystem::path& given);

}  // namespace glidar
