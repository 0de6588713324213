// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/cli_fwd.hpp>
#include <glidar/core/cloud_sink.hpp>
#include <glidar/io/file_sink.hpp>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace glidar::app {

/// What to write, as given.
struct OutputFlags {
  std::vector<std::string> paths;
  std::string legacy_name;  ///< --pcd NAME; empty: not given
  std::string columns = "default";
  std::string cloud_frame = "sensor";
  std::string pcd_encoding = "binary";
  bool dense = false;
  bool ply_ascii = false;
  bool no_sidecar = false;
  double depth_scale = 1000.0;
};

void add_output_flags(CLI::App& command, OutputFlags& flags);

/// One file to be written.
struct Output {
  std::filesystem::path path;
  std::vector<std::string> columns;
  std::string cloud_frame;  ///< optical, ros, gl, world or legacy
  std::unique_ptr<CloudSink> sink;
};

/// All files, checked as far as possible before anything is computed: suffix, folder, column names,
/// no name twice, not the input itself. The context is read when writing.
std::vector<Output> plan_outputs(const OutputFlags& flags, const std::string& input,
                                 const SidecarContext& context);

/// The hit columns that all outputs together need.
HitFields fields_for(const std::vector<Output>& outputs);

/// The coordinate frame of this name for a camera's frame.
CloudFrame cloud_frame(const std::string& name, const Beams& beams, const Pose& world_from_sensor);

/// Writes them all.
void write_outputs(const std::vector<Output>& outputs, const Frame& frame, const Beams& beams,
                   const Scene& scene);

}  // namespace glidar::app
