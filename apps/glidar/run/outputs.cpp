// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/outputs.hpp>

#include <apps/glidar/options/option_values.hpp>
#include <glidar/core/error.hpp>
#include <glidar/io/bags/bag.hpp>
#include <glidar/io/files/atomic_file.hpp>
#include <glidar/io/formats/cloud_layout.hpp>

#include <fmt/format.h>

#include <unistd.h>

#include <algorithm>
#include <set>

namespace glidar::app {
namespace {

void add_missing(const std::string& name, std::vector<std::string>& names) {
  if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
}

std::vector<std::string> requested_columns(const OutputFlags& flags) {
  if (!flags.sink.layout.empty()) return find_layout(flags.sink.layout).columns;
  return flags.columns.empty() ? default_columns() : flags.columns;
}

/// Throws Error unless there is at most one standard output and its format is given.
void check_standard_output(const OutputFlags& flags) {
  const auto count = std::count(flags.paths.begin(), flags.paths.end(), kStandardOutput);
  if (count > 1) {
    throw Error(
        {"--output -", "is given twice", "one standard output", "write the other one to a file"});
  }
  if (count == 0 && !flags.format.empty()) {
    throw Error({"--format " + flags.format, "there is no -o -", "--format with -o -",
                 "leave it out: the suffix of a file selects its format"});
  }
  if (count == 1 && flags.format.empty()) {
    throw Error({"--output -", "the format of standard output is not given", "-o - with --format",
                 "add --format csv, or another of those that --help lists"});
  }
}

void check_picture(const CloudPictureOptions& picture) {
  if (!picture.eye_m || !picture.target_m || *picture.eye_m != *picture.target_m) return;
  throw Error({.where = "--view-eye",
               .found = "it is the point that the camera looks at",
               .allowed = "a position other than --view-target"});
}

void refuse_terminal(const FileFormat& format, const FileSinkOptions& options) {
  if (::isatty(STDOUT_FILENO) == 0 || is_text(format, options)) return;
  throw Error({"--output -", "standard output is a terminal, and this format is binary",
               "text on a terminal",
               "pipe it to a program or a file, or write text: --format csv"});
}

/// Formats that hold no points (images, poses) have a fixed set of columns.
std::vector<std::string> columns_of(const FileFormat& format,
                                    const std::vector<std::string>& requested) {
  if (!format.takes_more) return needed_columns(format);
  std::vector<std::string> columns = requested;
  for (const std::string& name : needed_columns(format)) add_missing(name, columns);
  return columns;
}

/// NAME.pcd and NAME.transform as the original GLIDAR writes them.
void plan_legacy(const std::string& name, const SidecarContext& context, const Report& report,
                 std::vector<Output>& outputs) {
  const FileSinkOptions options{.drop_invalid = true, .sidecar = false};
  for (const char* suffix : {".pcd", ".transform"}) {
    const std::filesystem::path path = name + suffix;
    outputs.push_back({.path = path,
                       .columns = columns_of(format_for(path), {"xyz", "intensity"}),
                       .frame_name = "legacy",
                       .sink = make_file_sink(path, options, context, report)});
  }
}

/// The output of one -o.
Output plan_output(const std::string& path, const OutputFlags& flags,
                   const FileSinkOptions& options, const SidecarContext& context,
                   const Report& report) {
  const FileFormat& format = format_of(flags, path);
  Output output{.path = path == kStandardOutput ? std::filesystem::path(path) : output_path(path),
                .columns = columns_of(format, requested_columns(flags)),
                .frame_name = frame_for(format, flags.frame),
                .deskew = flags.deskew || format.is_survey,
                .has_boxes = path != kStandardOutput && has_boxes(format, options),
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

/// Standard output comes last: when its reader closes it early, all files exist.
std::vector<std::string> in_order(std::vector<std::string> paths) {
  std::stable_partition(paths.begin(), paths.end(),
                        [](const std::string& path) { return path != kStandardOutput; });
  return paths;
}

void check_names(const std::vector<Output>& outputs, const std::string& input) {
  std::set<std::filesystem::path> seen;
  for (const Output& output : outputs) {
    const bool is_input = is_same_file(output.path, input);
    const bool is_repeated = !seen.insert(real_path(output.path)).second;
    if (!is_input && !is_repeated) continue;
    throw Error({.where = "--output, " + output.path.string(),
                 .found = is_input ? "is an input file" : "is given twice as output",
                 .remedy = "choose another name"});
  }
}

/// Gives the outputs of a frame their names, one after the other.
void commit_all(const std::vector<Output>& outputs) {
  std::string written;
  for (const Output& output : outputs) {
    try {
      output.sink->commit();
    } catch (const ClosedPipe&) {
      throw;
    } catch (const Error& error) {
      ErrorParts parts = error.parts();
      parts.remedy += (parts.remedy.empty() ? "" : "; ") +
                      (written.empty() ? "no file of this frame was written"
                                       : "these outputs are written:" + written);
      throw Error(parts);
    }
    written += " " + output.path.string();
  }
}

/// Throws Error when a coordinate reference system is given, but no output takes one.
void check_crs(const OutputFlags& flags) {
  if (flags.sink.crs.empty()) return;
  const auto is_survey = [&](const std::string& path) { return format_of(flags, path).is_survey; };
  if (std::any_of(flags.paths.begin(), flags.paths.end(), is_survey)) return;
  throw Error({.where = "--crs",
               .found = "no output takes a coordinate reference system",
               .allowed = "an output with the suffix .las",
               .remedy = "add one, such as -o survey.las, or leave --crs out"});
}

}  // namespace

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

void check_layout(const OutputFlags& flags) {
  check_crs(flags);
  if (flags.sink.layout.empty()) return;
  const std::vector<std::string>& recordings = flags.recording_paths;
  if (std::any_of(recordings.begin(), recordings.end(), bags::is_bag_name)) return;
  const auto is_laid_out = [&](const std::string& path) {
    return takes_layout(path == kStandardOutput ? "stdout." + flags.format : path);
  };
  if (std::any_of(flags.paths.begin(), flags.paths.end(), is_laid_out)) return;
  throw Error({.where = "--layout",
               .found = "no output takes a layout",
               .allowed = "a bag, or an output with the suffix " + suffixes_with_layouts(),
               .remedy = "add one, such as -o scan.pcd, or leave --layout out"});
}

std::vector<Output> plan_outputs(const OutputFlags& flags, const std::string& input,
                                 const SidecarContext& context, const Report& report,
                                 const ProgressCallback& progress) {
  if (!has_outputs(flags)) {
    throw Error({.where = "--output",
                 .found = "there is no -o, so nothing would be written",
                 .allowed = "files by suffix: " + all_suffixes(),
                 .remedy = "for example: glidar render " + input + " -o cloud.pcd -o picture.png"});
  }
  check_standard_output(flags);
  check_picture(flags.sink.picture);
  FileSinkOptions options = flags.sink;
  options.progress = progress;
  std::vector<Output> outputs;
  for (const std::string& path : in_order(flags.paths)) {
    with_option_name(
        "--output", [&] { outputs.push_back(plan_output(path, flags, options, context, report)); });
  }
  if (!flags.legacy_name.empty()) {
    with_option_name("--legacy-output",
                     [&] { plan_legacy(flags.legacy_name, context, report, outputs); });
  }
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

HitColumnMask hit_columns_for_outputs(const std::vector<Output>& outputs) {
  std::vector<std::string> columns;
  for (const Output& output : outputs) {
    for (const std::string& name : output.columns) add_missing(name, columns);
  }
  HitColumnMask hit_columns = hit_columns_for(columns);
  hit_columns.boxes = std::any_of(outputs.begin(), outputs.end(),
                                  [](const Output& output) { return output.has_boxes; });
  return hit_columns;
}

void write_outputs(const std::vector<Output>& outputs, const Frame& frame, const Beams& beams,
                   const Scene& scene, const Report& report) {
  PointCloud cloud;
  const Output* previous = nullptr;
  for (const Output& output : outputs) {
    if (report.progress) report.progress("writing " + output.path.string(), -1.0);
    const bool is_same_cloud = previous != nullptr && previous->columns == output.columns &&
                               previous->frame_name == output.frame_name &&
                               previous->deskew == output.deskew;
    if (!is_same_cloud) {
      OutputFrame axes = output_frame(output.frame_name, beams, frame.world_from_sensor);
      axes.deskew = output.deskew;
      make_point_cloud(frame, beams, scene, axes, output.columns, cloud);
      previous = &output;
    }
    output.sink->stage(cloud, frame);
  }
  commit_all(outputs);
}

}  // namespace glidar::app
