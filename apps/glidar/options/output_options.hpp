// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/options/cli_fwd.hpp>
#include <apps/glidar/options/message_options.hpp>
#include <glidar/io/formats/file_sink.hpp>
#include <glidar/io/packets/livox_packet.hpp>
#include <glidar/io/packets/ouster_packet.hpp>

#include <optional>
#include <string>
#include <vector>

namespace glidar::app {

/// The files to write.
struct OutputFlags {
  std::vector<std::string> paths;            ///< "-": standard output
  std::vector<std::string> imu_paths;        ///< of IMU samples
  std::vector<std::string> recording_paths;  ///< bags, OSI traces, packet captures, KITTI
  std::string format;                ///< of standard output, without the dot; empty: not given
  std::string legacy_name;           ///< --legacy-output NAME; empty: not given
  std::vector<std::string> columns;  ///< of clouds; empty: default_columns()
  std::string frame;                 ///< axes of clouds; empty: by the format, see frame_for()
  bool deskew = false;
  std::optional<OusterProfile> ouster_profile;  ///< of packets; empty: by the number of returns
  std::optional<LivoxDataType> livox_type;      ///< of points in packets; empty: in mm
  MessageFlags messages;                        ///< of ROS
  FileSinkOptions sink;
};

inline constexpr const char* kOutputHeading = "Output (names are explained below)";

void add_output_options(CLI::App& command, OutputFlags& flags);

/// --legacy-output, under the heading of the original GLIDAR's options.
void add_legacy_output_option(CLI::App& command, OutputFlags& flags);

/// Removes standard output from the help of a command that writes sequences.
void hide_standard_output(CLI::App& command);

/// The columns of a cloud unless --columns or --layout gives others.
const std::vector<std::string>& default_columns();

/// The meanings of suffixes, columns, layouts and axes, for the end of --help.
std::string output_names_text();

/// The path that means standard output.
inline constexpr const char* kStandardOutput = "-";

/// The format of one of the paths. Throws Error.
const FileFormat& format_of(const OutputFlags& flags, const std::string& path);

/// Whether one of the paths is standard output; text for the user goes to standard error then.
bool writes_standard_output(const OutputFlags& flags);

/// Whether any file of a single frame is written.
bool has_outputs(const OutputFlags& flags);

/// Whether any file of a whole run is written: samples of IMUs, bags, OSI traces, packet
/// captures.
bool has_run_outputs(const OutputFlags& flags);

}  // namespace glidar::app
