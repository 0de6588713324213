// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io: everything that distinguishes one file format from others.

#include <glidar/io/files/staged_files.hpp>
#include <glidar/io/formats/cloud_file.hpp>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace glidar {

/// Whether misses are stored, and whether the file has a sidecar.
enum class Content : std::uint8_t {
  points,    ///< a cloud: organised, or without misses by option
  hits,      ///< a cloud: always without misses
  kitti,     ///< the same with KITTI's intensity
  image,     ///< always the whole frame, with a sidecar
  per_beam,  ///< a preview or a pose: always the whole frame, no sidecar
};

struct Format {
  FileFormat info;
  Content content = Content::points;
  /// Stored numbers of each point; nullptr: the format stores no points.
  std::vector<PointField> (*fields)(const PointCloud&) = nullptr;
  /// nullptr: `stage_extra_files` writes all.
  void (*write)(const CloudFile&, AtomicFile&) = nullptr;
  /// Adds further files; nullptr: none.
  void (*stage_extra_files)(const CloudFile&, const std::filesystem::path&, StagedFiles&) = nullptr;
  /// The path of the further file beside a path; nullptr: none, or a folder of files.
  std::filesystem::path (*extra_path)(const std::filesystem::path&) = nullptr;
  const char* pixels = "";  ///< meaning of an image's pixels, for its sidecar
  /// Whether the file is plain text with these options; nullptr: never.
  bool (*is_text)(const FileSinkOptions&) = nullptr;
  /// The warning for points that the format moves by rounding, empty if there is none; nullptr:
  /// that of rounding_warning().
  std::string (*rounding_warning)(const PointCloud&) = nullptr;
  /// See find_misfit(); nullptr: the format fits all sensors.
  Misfit (*misfit)(const CloudPictureOptions&, const Sensor&, const Beams&) = nullptr;
};

/// Whether files of the format have a sidecar, unless the options forbid it.
inline bool has_sidecar(const Format& format) {
  return format.content != Content::per_beam && !format.info.is_folder;
}

}  // namespace glidar
