// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/files/atomic_file.hpp>
#include <glidar/io/formats/file_sink.hpp>
#include <glidar/io/formats/point_rows.hpp>

#include <span>
#include <string>

namespace glidar {

/// The input of a format's writer: the cloud to write (without misses if requested), with the
/// columns that its FileFormat lists, each of the correct size.
struct CloudFile {
  const PointCloud& cloud;
  const Frame& frame;
  const FileSinkOptions& options;
  const SidecarContext& context;
  std::span<const PointField> fields;  ///< stored numbers of each point, as the sidecar lists them
  std::string layout = {};             ///< name of the cloud's point layout; empty: none
  std::string pixels = {};             ///< meaning of an image's pixels; empty: not an image
  bool has_moved = false;              ///< the axes of the frames of a run differ
};

/// The distances of an image: the column depth, or range in the images of cameras that look back.
inline const Column& distance_column(const PointCloud& cloud) {
  const Column* depth = find_column(cloud, "depth");
  return depth != nullptr ? *depth : *find_column(cloud, "range");
}

}  // namespace glidar
