// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/point_cloud.hpp>
#include <glidar/io/files/atomic_file.hpp>
#include <glidar/io/osi/ground_truth.hpp>

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace glidar::osi {

/// True for the names of OSI traces: with the suffix .osi.
bool is_osi_trace_name(const std::filesystem::path& path);

/// Writes the frames of a rig as a single-channel trace of ASAM OSI: the messages SensorData, each
/// after its size as a little-endian 32-bit integer. docs/osi.md lists the fields. The file appears
/// in finish().
class OsiTraceWriter {
 public:
  /// Throws Error when the file cannot be created.
  OsiTraceWriter(const std::filesystem::path& path, OsiRig rig);

  /// The cloud columns that it reads.
  [[nodiscard]] static const std::vector<std::string>& columns();
  /// Appends a frame of the rig's sensor with this index. Throws Error when the disk is full, or
  /// the message exceeds the 2 GiB that Protocol Buffers allow.
  void write(std::size_t sensor_index, const Frame& frame, const Beams& beams);
  /// Gives the file its name. Without it nothing of it remains.
  void finish();

 private:
  OsiRig rig_;
  GroundTruthMessages ground_truth_;
  AtomicFile file_;
  PointCloud cloud_;  ///< of the last frame; reuses its memory, like `detected_`
  PointCloud detected_;
};

}  // namespace glidar::osi
