// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/options/cli_fwd.hpp>
#include <apps/glidar/options/message_options.hpp>
#include <glidar/output/frame_files.hpp>

#include <string>
#include <vector>

namespace glidar::app {

/// The files to write.
struct OutputFlags : FrameFileRequest {
  OutputFlags() { option = "--output"; }

  std::vector<std::string> imu_paths;        ///< of IMU samples
  std::vector<std::string> recording_paths;  ///< bags, OSI traces, packet captures, KITTI
  std::vector<std::string> box_classes;      ///< see SceneFile; empty: those of the scene
};

inline constexpr const char* kOutputHeading = "Output (names are explained below)";

void add_output_options(CLI::App& command, OutputFlags& flags);

/// --box-classes, of commands that measure.
void add_box_classes_option(CLI::App& command, OutputFlags& flags);

/// --per-frame, of commands that end by themselves.
void add_per_frame_option(CLI::App& command, OutputFlags& flags);

/// --legacy-output, under the heading of the original GLIDAR's options.
void add_legacy_output_option(CLI::App& command, OutputFlags& flags);

/// Removes standard output from the help of a command that writes sequences.
void hide_standard_output(CLI::App& command);

/// The meanings of suffixes, columns, layouts and axes, for the end of --help.
std::string output_names_text();

/// Whether any file of a whole run is written: samples of IMUs, bags, OSI traces, packet
/// captures.
bool has_run_outputs(const OutputFlags& flags);

}  // namespace glidar::app
