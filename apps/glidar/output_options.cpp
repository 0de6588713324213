// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/output_options.hpp>

#include <apps/glidar/help_text.hpp>
#include <apps/glidar/numbers.hpp>
#include <apps/glidar/pose_options.hpp>
#include <glidar/core/error.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <set>

namespace glidar::app {
namespace {

const std::vector<std::string>& default_columns() {
  static const std::vector<std::string> kColumns = {"xyz",    "intensity", "range",
                                                    "normal", "instance",  "class"};
  return kColumns;
}

void add_missing(const std::string& name, std::vector<std::string>& names) {
  if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
}

/// The columns asked for, every name known.
std::vector<std::string> asked_columns(const std::string& text) {
  if (text == "default") return default_columns();
  if (text == "all") return {cloud_column_names().begin(), cloud_column_names().end()};
  std::vector<std::string> columns;
  for (const std::string& name : parse_list("--columns", text)) add_missing(name, columns);
  glidar::fields_for(columns);  // throws on an unknown name
  return columns;
}

/// Formats that hold no points (images, poses) take what they need and nothing else.
std::vector<std::string> columns_of(const FileFormat& format,
                                    const std::vector<std::string>& asked) {
  if (!format.takes_more) return format.columns;
  std::vector<std::string> columns = asked;
  for (const std::string& name : format.columns) add_missing(name, columns);
  return columns;
}

FileSinkOptions sink_options(const OutputFlags& flags) {
  FileSinkOptions options;
  options.pcd = flags.pcd_encoding == "ascii"    ? PcdEncoding::ascii
                : flags.pcd_encoding == "binary" ? PcdEncoding::binary
                                                 : PcdEncoding::binary_compressed;
  options.ply_ascii = flags.ply_ascii;
  options.dense = flags.dense;
  options.sidecar = !flags.no_sidecar;
  options.depth_png_units_per_m = flags.depth_scale;
  return options;
}

/// NAME.pcd and NAME.transform as the 2015 program wrote them.
void plan_legacy(const std::string& name, const SidecarContext& context,
                 std::vector<Output>& outputs) {
  const FileSinkOptions options{.dense = true, .sidecar = false};
  for (const char* suffix : {".pcd", ".transform"}) {
    const std::filesystem::path path = name + suffix;
    outputs.push_back({.path = path,
                       .columns = columns_of(format_for(path), {"xyz", "intensity"}),
                       .cloud_frame = "legacy",
                       .sink = make_file_sink(path, options, context)});
  }
}

/// True when the path is a file that was read: the input itself or a model of the scene.
bool was_read(const std::filesystem::path& path, const std::string& input, const Scene& scene) {
  std::error_code no_such_file;  // then it was not read either
  if (std::filesystem::equivalent(path, input, no_such_file)) return true;
  return std::any_of(scene.sources.begin(), scene.sources.end(), [&](const MeshSource& source) {
    return std::filesystem::equivalent(path, source.path, no_such_file);
  });
}

void check_names(const std::vector<Output>& outputs, const std::string& input, const Scene& scene) {
  std::set<std::filesystem::path> seen;
  for (const Output& output : outputs) {
    const bool is_input = was_read(output.path, input, scene);
    const bool twice =
        !seen.insert(std::filesystem::absolute(output.path).lexically_normal()).second;
    if (!is_input && !twice) continue;
    throw Error({.where = output.path.string(),
                 .found = is_input ? "is an input file" : "is given twice as output",
                 .allowed = "",
                 .remedy = "choose another name"});
  }
}

std::string suffix_list() {
  std::string text;
  for (const FileFormat& format : file_formats()) text += " " + format.suffix;
  return text;
}

}  // namespace

void add_output_flags(CLI::App& command, OutputFlags& flags) {
  const std::string group = "Output";
  command
      .add_option("-o,--output", flags.paths,
                  wrapped("Output file, repeatable; the suffix says what:" + suffix_list()))
      ->type_name("OUT")
      ->allow_extra_args(false)
      ->group(group);
  command
      .add_option(
          "--pcd", flags.legacy_name,
          wrapped("As in the 2015 program: NAME.pcd (x left, y up, z forward) and NAME.transform"))
      ->type_name("NAME")
      ->group(group);
  command
      .add_option("--columns", flags.columns,
                  wrapped(fmt::format(
                      "Columns of clouds: all, default or a list a,b,c of {} [default: {}]",
                      fmt::join(cloud_column_names(), " "), fmt::join(default_columns(), " "))))
      ->type_name("LIST")
      ->group(group);
  command
      .add_option(
          "--cloud-frame", flags.cloud_frame,
          wrapped(
              "Axes of clouds: sensor (its own), optical (x right, y down, z forward), ros (x "
              "forward, y left, z "
              "up), gl (x right, y up, z back), legacy (x left, y up, z forward), world [sensor]"))
      ->check(CLI::IsMember({"sensor", "optical", "ros", "gl", "world", "legacy"}))
      ->type_name("NAME")
      ->group(group);
  command.add_flag("--dense", flags.dense, "Leave misses out of clouds")->group(group);
  command
      .add_option("--pcd-encoding", flags.pcd_encoding, "ascii, binary, binary_compressed [binary]")
      ->check(CLI::IsMember({"ascii", "binary", "binary_compressed"}))
      ->type_name("NAME")
      ->group(group);
  command.add_flag("--ply-ascii", flags.ply_ascii, "PLY as text")->group(group);
  command
      .add_option("--depth-scale", flags.depth_scale,
                  "Units per metre in 16-bit depth images [1000, millimetres]")
      ->type_name("UNITS")
      ->group(group);
  command.add_flag("--no-sidecar", flags.no_sidecar, "Write no OUT.json beside clouds")
      ->group(group);
}

std::vector<Output> plan_outputs(const OutputFlags& flags, const std::string& input,
                                 const SidecarContext& context) {
  if (flags.paths.empty() && flags.legacy_name.empty()) {
    throw Error({.where = "output",
                 .found = "there is no -o, so nothing would be written",
                 .allowed = "files by suffix:" + suffix_list(),
                 .remedy = "for example: glidar render " + input + " -o cloud.pcd -o picture.png"});
  }
  require_positive("--depth-scale", flags.depth_scale);
  const std::vector<std::string> asked = asked_columns(flags.columns);
  std::vector<Output> outputs;
  for (const std::string& path : flags.paths) {
    outputs.push_back({.path = path,
                       .columns = columns_of(format_for(path), asked),
                       .cloud_frame = flags.cloud_frame,
                       .sink = make_file_sink(path, sink_options(flags), context)});
  }
  if (!flags.legacy_name.empty()) plan_legacy(flags.legacy_name, context, outputs);
  check_names(outputs, input, context.scene);
  return outputs;
}

HitFields fields_for(const std::vector<Output>& outputs) {
  std::vector<std::string> columns;
  for (const Output& output : outputs) {
    for (const std::string& name : output.columns) add_missing(name, columns);
  }
  return glidar::fields_for(columns);
}

CloudFrame cloud_frame(const std::string& name, const Beams& beams, const Pose& world_from_sensor) {
  const bool lidar = heads_along_x(beams);
  const std::string prefix = lidar ? "lidar" : "camera";
  const Pose optical_from_sensor = lidar ? optical_from_body() : Pose::Identity();
  if (name == "world") return {.frame_id = "world", .cloud_from_sensor = world_from_sensor};
  if (name == "ros") {
    const Pose body_from_sensor = optical_from_body().inverse() * optical_from_sensor;
    return {.frame_id = prefix + "_frame", .cloud_from_sensor = body_from_sensor};
  }
  if (name == "gl") {
    Pose gl_from_optical = Pose::Identity();
    gl_from_optical.linear().diagonal() = Eigen::Vector3d(1.0, -1.0, -1.0);
    return {.frame_id = prefix + "_gl_frame",
            .cloud_from_sensor = gl_from_optical * optical_from_sensor};
  }
  if (name == "legacy") {
    return {.frame_id = prefix + "_legacy_frame",
            .cloud_from_sensor = legacy_from_optical() * optical_from_sensor};
  }
  if (name == "optical") {
    return {.frame_id = prefix + "_optical_frame", .cloud_from_sensor = optical_from_sensor};
  }
  return {.frame_id = beams.frame_id, .cloud_from_sensor = Pose::Identity()};
}

void write_outputs(const std::vector<Output>& outputs, const Frame& frame, const Beams& beams,
                   const Scene& scene) {
  PointCloud cloud;
  const Output* made_for = nullptr;
  for (const Output& output : outputs) {
    const bool same = made_for != nullptr && made_for->columns == output.columns &&
                      made_for->cloud_frame == output.cloud_frame;
    if (!same) {
      make_point_cloud(frame, beams, scene,
                       cloud_frame(output.cloud_frame, beams, frame.world_from_sensor),
                       output.columns, cloud);
      made_for = &output;
    }
    output.sink->write(cloud, frame);
  }
}

}  // namespace glidar::app
