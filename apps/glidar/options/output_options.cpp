// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/options/output_options.hpp>

#include <apps/glidar/options/help_text.hpp>
#include <apps/glidar/options/naming.hpp>
#include <apps/glidar/options/numbers.hpp>
#include <apps/glidar/options/option_kinds.hpp>
#include <apps/glidar/options/picture_options.hpp>
#include <apps/glidar/options/pose_options.hpp>
#include <glidar/core/error.hpp>
#include <glidar/io/files/atomic_file.hpp>
#include <glidar/io/formats/cloud_layout.hpp>
#include <glidar/io/formats/needed_columns.hpp>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
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

/// The columns of a list, every name known.
std::vector<std::string> listed_columns(const std::string& text) {
  if (text.empty() || text == "default") return default_columns();
  if (text == "all") return {cloud_column_names().begin(), cloud_column_names().end()};
  std::vector<std::string> columns;
  for (const std::string& name : parse_list("--fields", text)) add_missing(name, columns);
  naming("--fields", [&] { glidar::fields_needed_by(columns); });  // throws on an unknown name
  return columns;
}

std::vector<std::string> asked_columns(const OutputFlags& flags) {
  return flags.layout.empty() ? listed_columns(flags.columns) : find_layout(flags.layout).columns;
}

/// Formats that take columns, for errors and help: ".pcd .ply .npz .csv".
std::string layout_suffixes() {
  std::string text;
  for (const FileFormat& format : file_formats()) {
    if (format.takes_more) text += (text.empty() ? "" : " ") + format.suffix;
  }
  return text;
}

void check_layout(const OutputFlags& flags) {
  if (flags.layout.empty()) return;
  if (!flags.columns.empty()) {
    throw Error({.where = "--layout and --fields",
                 .found = "both are given",
                 .allowed = "one of the two",
                 .remedy = "a layout has its own columns: leave --fields out"});
  }
  const auto takes_it = [&](const std::string& path) { return format_of(flags, path).takes_more; };
  if (std::any_of(flags.paths.begin(), flags.paths.end(), takes_it)) return;
  throw Error({.where = "--layout",
               .found = "no output takes a layout",
               .allowed = "an output with the suffix " + layout_suffixes(),
               .remedy = "add one, such as -o scan.pcd, or leave --layout out"});
}

/// Throws Error unless there is at most one standard output and its format is given.
void check_standard_output(const OutputFlags& flags) {
  const auto count = std::count(flags.paths.begin(), flags.paths.end(), kStandardOutput);
  if (count > 1) {
    throw Error(
        {"--output -", "is given twice", "one standard output", "write the other one to a file"});
  }
  if (count == 0 && !flags.format.empty()) {
    throw Error({"--format " + flags.format, "there is no -o -, which it is about",
                 "--format with -o -", "leave it out: the suffix of a file says its format"});
  }
  if (count == 1 && flags.format.empty()) {
    throw Error({"--output -", "the format of standard output is not given", "-o - with --format",
                 "add --format csv, or another of those that --help lists"});
  }
}

void refuse_terminal(const FileFormat& format, const FileSinkOptions& options) {
  if (::isatty(STDOUT_FILENO) == 0 || is_text(format, options)) return;
  throw Error({"--output -", "standard output is a terminal, and this format is binary",
               "text on a terminal",
               "pipe it to a program or a file, or write text: --format csv"});
}

/// Formats that hold no points (images, poses) take what they need and nothing else.
std::vector<std::string> columns_of(const FileFormat& format,
                                    const std::vector<std::string>& asked) {
  if (!format.takes_more) return needed_columns(format);
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
  options.layout = flags.layout;
  options.sidecar = !flags.no_sidecar;
  const double scale = flags.depth_scale.value_or(options.depth_png_units_per_m);
  require(scale > 0.0 && std::isfinite(scale), "--depth-scale", scale, "a finite number above 0");
  options.depth_png_units_per_m = scale;
  options.picture = picture_options(flags);
  return options;
}

/// NAME.pcd and NAME.transform as the 2015 program wrote them.
void plan_legacy(const std::string& name, const SidecarContext& context, const Report& report,
                 std::vector<Output>& outputs) {
  const FileSinkOptions options{.dense = true, .sidecar = false};
  for (const char* suffix : {".pcd", ".transform"}) {
    const std::filesystem::path path = name + suffix;
    outputs.push_back({.path = path,
                       .columns = columns_of(format_for(path), {"xyz", "intensity"}),
                       .cloud_frame = "legacy",
                       .sink = make_file_sink(path, options, context, report)});
  }
}

/// Of one -o.
Output plan_output(const std::string& path, const OutputFlags& flags,
                   const FileSinkOptions& options, const SidecarContext& context,
                   const Report& report) {
  const FileFormat& format = format_of(flags, path);
  Output output{.path = path == kStandardOutput ? std::filesystem::path(path) : output_path(path),
                .columns = columns_of(format, asked_columns(flags)),
                .cloud_frame = flags.cloud_frame,
                .deskew = flags.deskew,
                .sink = nullptr};
  if (path == kStandardOutput) {
    refuse_terminal(format, options);
    output.sink =
        make_stream_sink(STDOUT_FILENO, "stdout." + flags.format, options, context, report);
  } else {
    output.sink = make_file_sink(path, options, context, report);
  }
  return output;
}

/// Standard output comes last: whoever reads it may go away, and finds all files in place.
std::vector<std::string> in_order(std::vector<std::string> paths) {
  std::stable_partition(paths.begin(), paths.end(),
                        [](const std::string& path) { return path != kStandardOutput; });
  return paths;
}

void check_names(const std::vector<Output>& outputs, const std::string& input) {
  std::set<std::filesystem::path> seen;
  for (const Output& output : outputs) {
    const bool is_input = is_same_file(output.path, input);
    const bool twice = !seen.insert(real_path(output.path)).second;
    if (!is_input && !twice) continue;
    throw Error({.where = "--output, " + output.path.string(),
                 .found = is_input ? "is an input file" : "is given twice as output",
                 .allowed = "",
                 .remedy = "choose another name"});
  }
}

std::vector<std::string> layout_names() {
  std::vector<std::string> names;
  for (const PointFieldLayout& layout : cloud_layouts()) names.push_back(layout.name);
  return names;
}

/// Names for --format.
std::vector<std::string> stream_formats() {
  std::vector<std::string> names;
  for (const FileFormat& format : file_formats()) {
    if (!format.is_folder) names.push_back(format.suffix.substr(1));
  }
  return names;
}

/// Gives the outputs of a frame their names, one after the other.
void commit_all(const std::vector<Output>& outputs) {
  std::string placed;
  for (const Output& output : outputs) {
    try {
      output.sink->commit();
    } catch (const ClosedPipe&) {
      throw;
    } catch (const Error& error) {
      ErrorParts parts = error.parts();
      parts.remedy += (parts.remedy.empty() ? "" : "; ") +
                      (placed.empty() ? "no file of this frame was written"
                                      : "these outputs are written:" + placed);
      throw Error(parts);
    }
    placed += " " + output.path.string();
  }
}

std::string suffix_list() {
  std::string text;
  for (const FileFormat& format : file_formats()) text += " " + format.suffix;
  return text;
}

}  // namespace

void add_output_flags(CLI::App& command, OutputFlags& flags) {
  const std::string group = "Output (names are explained below)";
  command
      .add_option("-o,--output", flags.paths,
                  "File to write, repeatable; its suffix says what; -: stdout")
      ->type_name("FILE")
      ->allow_extra_args(false)
      ->group(group);
  add_choice(command, {"--format", "NAME", "Format of -o -, standard output: csv, pcd ...", group},
             stream_formats(), flags.format);
  add_text(command, {"--pcd", "NAME", "As in the 2015 program: NAME.pcd and NAME.transform", group},
           flags.legacy_name);
  add_text(command, {"--fields", "LIST", "Columns of clouds: a,b,c or all or default", group},
           flags.columns, [](std::string_view, const std::string& text) { listed_columns(text); });
  add_choice(command, {"--layout", "NAME", "Fields of another sensor's clouds, see below", group},
             layout_names(), flags.layout);
  add_choice(command,
             {"--frame", "NAME", "Axes: sensor, optical, ros, gl, legacy or world [sensor]", group},
             {output_frame_names().begin(), output_frame_names().end()}, flags.cloud_frame);
  command.add_flag("--deskew", flags.deskew, "Points where a moving sensor met them")->group(group);
  command.add_flag("--drop-invalid", flags.dense, "Leave misses out of clouds")->group(group);
  add_choice(command,
             {"--pcd-encoding", "NAME", "ascii, binary or binary_compressed [binary]", group},
             {"ascii", "binary", "binary_compressed"}, flags.pcd_encoding);
  command.add_flag("--ply-ascii", flags.ply_ascii, "PLY as text")->group(group);
  add_number(command,
             {"--depth-scale", "UNITS", "Units per metre in 16-bit depth images [1000]", group},
             flags.depth_scale);
  add_picture_flags(command, flags, group);
  command.add_flag("--no-sidecar", flags.no_sidecar, "Write no FILE.json beside clouds")
      ->group(group);
}

void hide_standard_output(CLI::App& command) {
  command.get_option("--output")->description("File to write, repeatable; its suffix says what");
  command.get_option("--format")->group("");
}

std::string output_names_text() {
  std::string text = "Output files by suffix:\n";
  for (const FileFormat& format : file_formats()) {
    text += fmt::format("  {:<13} {}\n", format.suffix, format.description);
  }
  text += "\nColumns of clouds (* those of default):\n";
  std::string names;
  for (const std::string& name : cloud_column_names()) {
    const bool usual = std::find(default_columns().begin(), default_columns().end(), name) !=
                       default_columns().end();
    names += (names.empty() ? "" : " ") + name + (usual ? "*" : "");
  }
  text += indented(names);
  text += "\nLayouts of clouds (" + layout_suffixes() + "):\n";
  for (const PointFieldLayout& layout : cloud_layouts()) {
    text += fmt::format("  {:<12} {}\n", layout.name, layout.description);
  }
  text +=
      "\nAxes of clouds:\n"
      "  optical      x right, y down, z forward\n"
      "  ros          x forward, y left, z up\n"
      "  gl           x right, y up, z back\n"
      "  legacy       x left, y up, z forward\n"
      "  world        those of the scene\n\n";
  return text;
}

const FileFormat& format_of(const OutputFlags& flags, const std::string& path) {
  return format_for(path == kStandardOutput ? "stdout." + flags.format : path);
}

bool writes_standard_output(const OutputFlags& flags) {
  return std::find(flags.paths.begin(), flags.paths.end(), kStandardOutput) != flags.paths.end();
}

OutputFlags numbered(const OutputFlags& flags, std::uint32_t frame) {
  OutputFlags result = labelled(flags, fmt::format("{:06}", frame));
  for (std::size_t i = 0; i < flags.paths.size(); ++i) {
    if (format_of(flags, flags.paths[i]).is_folder) result.paths[i] = flags.paths[i];
  }
  return result;
}

OutputFlags labelled(const OutputFlags& flags, const std::string& label) {
  if (writes_standard_output(flags)) {
    throw Error({"--output -", "several clouds are written, which one stream cannot separate",
                 "one frame of one sensor on standard output",
                 "use glidar render without --duration, and --sensor-name to choose one of a rig's "
                 "sensors, or write files"});
  }
  OutputFlags result = flags;
  for (std::string& path : result.paths) {
    path = output_path(path);
    path.insert(path.size() - format_for(path).suffix.size(), "_" + label);
  }
  if (!result.legacy_name.empty()) result.legacy_name += "_" + label;
  return result;
}

std::vector<Output> plan_outputs(const OutputFlags& flags, const std::string& input,
                                 const SidecarContext& context, const Report& report,
                                 const ProgressCallback& progress) {
  if (flags.paths.empty() && flags.legacy_name.empty()) {
    throw Error({.where = "--output",
                 .found = "there is no -o, so nothing would be written",
                 .allowed = "files by suffix:" + suffix_list(),
                 .remedy = "for example: glidar render " + input + " -o cloud.pcd -o picture.png"});
  }
  check_standard_output(flags);
  FileSinkOptions options = sink_options(flags);
  options.progress = progress;
  std::vector<Output> outputs;
  for (const std::string& path : in_order(flags.paths)) {
    naming("--output",
           [&] { outputs.push_back(plan_output(path, flags, options, context, report)); });
  }
  if (!flags.legacy_name.empty()) {
    naming("--pcd", [&] { plan_legacy(flags.legacy_name, context, report, outputs); });
  }
  check_layout(flags);
  check_names(outputs, input);
  return outputs;
}

void refuse_overwrite_of_inputs(const std::vector<std::string>& read,
                                const std::vector<Output>& outputs) {
  for (const Output& output : outputs) {
    for (const std::filesystem::path& file : output.sink->files())
      refuse_overwrite_of_inputs(read, file);
  }
}

HitFieldMask fields_for_outputs(const std::vector<Output>& outputs) {
  std::vector<std::string> columns;
  for (const Output& output : outputs) {
    for (const std::string& name : output.columns) add_missing(name, columns);
  }
  return glidar::fields_needed_by(columns);
}

void write_outputs(const std::vector<Output>& outputs, const Frame& frame, const Beams& beams,
                   const Scene& scene, const Report& report) {
  PointCloud cloud;
  const Output* made_for = nullptr;
  for (const Output& output : outputs) {
    if (report.progress) report.progress("writing " + output.path.string(), -1.0);
    const bool same = made_for != nullptr && made_for->columns == output.columns &&
                      made_for->cloud_frame == output.cloud_frame &&
                      made_for->deskew == output.deskew;
    if (!same) {
      OutputFrame axes = output_frame(output.cloud_frame, beams, frame.world_from_sensor);
      axes.deskew = output.deskew;
      make_point_cloud(frame, beams, scene, axes, output.columns, cloud);
      made_for = &output;
    }
    output.sink->stage(cloud, frame);
  }
  commit_all(outputs);
}

}  // namespace glidar::app
