// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/options/cli_fwd.hpp>
#include <glidar/core/cloud_sink.hpp>
#include <glidar/core/report.hpp>
#include <glidar/io/files/overwrite_guard.hpp>
#include <glidar/io/formats/file_sink.hpp>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace glidar::app {

/// What to write, as given.
struct OutputFlags {
  std::vector<std::string> paths;  ///< "-": standard output
  std::string format;              ///< of standard output, without the dot; empty: not given
  std::string legacy_name;         ///< --pcd NAME; empty: not given
  std::string columns;             ///< empty: not given
  std::string layout;              ///< empty: not given
  std::string cloud_frame = "sensor";
  std::string pcd_encoding = "binary";
  bool dense = false;
  bool deskew = false;
  bool ply_ascii = false;
  bool no_sidecar = false;
  std::optional<double> depth_scale;
  std::string colour_by = "height";
  std::string picture_size;  ///< WxH; empty: not given
  std::string view_eye;      ///< X,Y,Z; empty: not given
  std::string view_target;

  bool operator==(const OutputFlags&) const = default;
};

void add_output_flags(CLI::App& command, OutputFlags& flags);

/// Leaves standard output out of the help of a command that writes sequences.
void hide_standard_output(CLI::App& command);

/// What the names of suffixes, columns and axes mean, for the end of --help.
std::string output_names_text();

/// Standard output among the paths.
inline constexpr const char* kStandardOutput = "-";

/// The format of one of the paths. Throws Error.
const FileFormat& format_of(const OutputFlags& flags, const std::string& path);

/// Whether one of the paths is standard output: then texts go to standard error.
bool writes_standard_output(const OutputFlags& flags);

/// The same for one frame of a sequence: NAME_000007.pcd for NAME.pcd; folders take all frames.
/// Throws Error for standard output, which holds one cloud.
OutputFlags numbered(const OutputFlags& flags, std::uint32_t frame);

/// The same for one sensor of a rig: NAME_lidar.pcd for NAME.pcd.
OutputFlags labelled(const OutputFlags& flags, const std::string& label);

/// One file to be written.
struct Output {
  std::filesystem::path path;
  std::vector<std::string> columns;
  std::string cloud_frame;  ///< optical, ros, gl, world or legacy
  bool deskew = false;      ///< points as fired from where the sensor was
  std::unique_ptr<FileSink> sink;
};

/// All files, checked as far as possible before anything is computed: suffix, folder, column names,
/// no name twice, not the input itself. The context is read and `progress` told when writing,
/// warnings go to `report`.
std::vector<Output> plan_outputs(const OutputFlags& flags, const std::string& input,
                                 const SidecarContext& context, const Report& report,
                                 const ProgressCallback& progress = {});

using glidar::refuse_overwrite_of_inputs;
/// Throws Error when one of them is a file that was read: known once the input is loaded.
void refuse_overwrite_of_inputs(const std::vector<std::string>& read,
                                const std::vector<Output>& outputs);

/// The hit columns that all outputs together need.
HitFieldMask fields_for_outputs(const std::vector<Output>& outputs);

/// Writes them all; reports which one is being written. They get their names together: when one
/// fails, none of the frame's files is there. Should the system refuse a name, the error lists the
/// files that have theirs.
void write_outputs(const std::vector<Output>& outputs, const Frame& frame, const Beams& beams,
                   const Scene& scene, const Report& report = {});

}  // namespace glidar::app
