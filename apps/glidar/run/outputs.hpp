// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/options/output_options.hpp>
#include <glidar/core/cloud_sink.hpp>
#include <glidar/core/report.hpp>
#include <glidar/io/files/atomic_file.hpp>
#include <glidar/io/formats/file_sink.hpp>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace glidar::app {

/// The same for one frame of a sequence: NAME_000007.pcd for NAME.pcd; folders take all frames.
/// Throws Error for standard output, which holds one cloud.
OutputFlags numbered(const OutputFlags& flags, std::uint32_t frame);

/// The same for one sensor of a rig: NAME_lidar.pcd for NAME.pcd.
OutputFlags labelled(const OutputFlags& flags, const std::string& label);

/// A file to be written.
struct Output {
  std::filesystem::path path;
  std::vector<std::string> columns;
  std::string frame_name;  ///< optical, ros, gl, world or legacy
  bool deskew = false;     ///< points as fired from where the sensor was
  bool has_boxes = false;  ///< of the objects, in the file or its sidecar
  std::unique_ptr<FileSink> sink;
};

/// Throws Error when a layout or a coordinate reference system is given, but no output takes one.
void check_layout(const OutputFlags& flags);

/// All files, checked as far as possible before any work: suffix, folder, columns, no name twice,
/// not the input itself. Writing uses the context, calls `progress` and sends warnings to `report`.
std::vector<Output> plan_outputs(const OutputFlags& flags, const std::string& input,
                                 const SidecarContext& context, const Report& report,
                                 const ProgressCallback& progress = {});

using glidar::refuse_overwrite_of_inputs;
/// Throws Error when one of the outputs is a file that was read; for use after loading.
void refuse_overwrite_of_inputs(const std::vector<std::string>& read,
                                const std::vector<Output>& outputs);

/// The hit columns that all outputs together need.
HitColumnMask hit_columns_for_outputs(const std::vector<Output>& outputs);

/// Writes all outputs and reports which one is being written. They get their final names together:
/// if one fails before that, no file of the frame exists. If a later name is refused, the error
/// lists the files that exist.
void write_outputs(const std::vector<Output>& outputs, const Frame& frame, const Beams& beams,
                   const Scene& scene, const Report& report = {});

}  // namespace glidar::app
