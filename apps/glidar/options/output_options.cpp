// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/options/output_options.hpp>

#include <apps/glidar/options/help_text.hpp>
#include <apps/glidar/options/option_group.hpp>
#include <apps/glidar/options/option_values.hpp>
#include <glidar/io/formats/cloud_layout.hpp>
#include <glidar/io/packets/livox.hpp>
#include <glidar/io/packets/ouster.hpp>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>

namespace glidar::app {
namespace {

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// The columns of a list; each name is known.
std::vector<std::string> parse_columns(const std::string& text) {
  if (text == "default") return default_columns();
  if (text == "all") return {cloud_column_names().begin(), cloud_column_names().end()};
  std::vector<std::string> columns;
  for (const std::string& name : parse_list(text)) {
    if (!contains(columns, name)) columns.push_back(name);
  }
  hit_columns_for(columns);  // throws Error for an unknown name
  return columns;
}

std::vector<std::string> layout_names() {
  std::vector<std::string> names;
  for (const PointFieldLayout& layout : cloud_layouts()) names.push_back(layout.name);
  return names;
}

std::vector<std::pair<std::string, OusterProfile>> ouster_profiles() {
  std::vector<std::pair<std::string, OusterProfile>> profiles;
  for (const std::string_view profile : ouster_profile_names()) {
    profiles.emplace_back(profile, static_cast<OusterProfile>(profiles.size()));
  }
  return profiles;
}

/// Formats that can go to standard output.
std::vector<std::string> stream_formats() {
  std::vector<std::string> names;
  for (const FileFormat& format : file_formats()) {
    if (!format.is_folder) names.push_back(format.suffix.substr(1));
  }
  return names;
}

/// The list for an output of this name.
std::vector<std::string>& paths_for(const std::string& path, OutputFlags& flags) {
  if (path == kStandardOutput) return flags.paths;
  OutputKind kind{};
  with_option_name("--output", [&] { kind = output_kind(path); });
  if (kind == OutputKind::imu_samples) return flags.imu_paths;
  return kind == OutputKind::frame_file ? flags.paths : flags.recording_paths;
}

void add_cloud_options(const OptionGroup& group, OutputFlags& flags) {
  group.add("--columns", "LIST", "Columns of clouds: a,b,c or all or default", flags.columns,
            parse_columns);
  group.add("--layout", "NAME", "Point layout of another sensor's clouds, see below",
            flags.sink.layout, one_of(layout_names()));
  group.add("--frame", "NAME", "Axes, see below [sensor; of .las files: world]", flags.frame,
            one_of({output_frame_names().begin(), output_frame_names().end()}));
  group.add_flag("--deskew", "Compensate the sensor's motion within a frame (.las: always)",
                 flags.deskew);
  group.add("--crs", "CRS", "Coordinate system of .las: EPSG:CODE, WKT or its file [local]",
            flags.sink.crs);
  group.add_flag("--drop-invalid", "Drop points without a return", flags.sink.drop_invalid);
  group.add("--pcd-encoding", "NAME", "ascii, binary or binary_compressed [binary]", flags.sink.pcd,
            one_of<PcdEncoding>({{"ascii", PcdEncoding::ascii},
                                 {"binary", PcdEncoding::binary},
                                 {"binary_compressed", PcdEncoding::binary_compressed}}));
  group.add_flag("--ply-ascii", "PLY as text", flags.sink.ply_ascii);
  group.add("--ouster-profile", "NAME", "Packets of Ouster sensors: LEGACY ... [by the returns]",
            flags.ouster_profile, one_of(ouster_profiles()));
  group.add("--livox-data-type", "N",
            "Packets of Livox sensors: 1 x y z in mm, 2 in cm, 3 angles [1]",
            [&flags](const std::string& text) {
              flags.livox_type = static_cast<LivoxDataType>(whole(1, 3)(text));
            });
  group.add("--depth-scale", "UNITS", "Units per metre in 16-bit depth images [1000]",
            flags.sink.depth_png_units_per_m,
            number(kAboveZero, kFinite, "a finite number above 0"));
}

void add_picture_options(const OptionGroup& group, CloudPictureOptions& picture) {
  std::vector<std::pair<std::string, ColourBy>> colours;
  for (const std::string& name : colour_by_names()) {
    colours.emplace_back(name, static_cast<ColourBy>(colours.size()));
  }
  group.add("--colour-by", "NAME",
            "By range intensity ring class instance radial_velocity [height]", picture.colour_by,
            one_of(colours));
  group.add("--picture-size", "WxH", "Size of .bev.png and .view.png in pixels [1400x1000]",
            [&picture](const std::string& text) {
              const auto size = image_size(kMinPictureSide, kMaxPictureSide)(text);
              picture.width = size[0];
              picture.height = size[1];
            });
  group.add("--view-eye", "X,Y,Z", "Camera of .view.png, m, axes of the cloud [shows all points]",
            picture.eye_m, parse_position);
  group.add("--view-target", "X,Y,Z", "Point that this camera looks at, m [shows all points]",
            picture.target_m, parse_position);
}

}  // namespace

void add_output_options(CLI::App& command, OutputFlags& flags) {
  const OptionGroup group(command, kOutputHeading);
  group.add_repeatable(
      "-o,--output", "FILE", "File to write, repeatable; -: standard output",
      [&flags](const std::string& text) { paths_for(text, flags).push_back(text); });
  group.add("--format", "NAME", "Format of -o -, standard output: csv, pcd ...", flags.format,
            one_of(stream_formats()));
  add_cloud_options(group, flags);
  add_picture_options(group, flags.sink.picture);
  group.add_flag("--no-sidecar", "Write no NAME.glidar.json beside files", flags.sink.sidecar,
                 false);
  add_message_options(command, flags.messages);
  forbid_together(command, {"--layout", "--as"}, {"--columns"});
}

void add_box_classes_option(CLI::App& command, OutputFlags& flags) {
  OptionGroup(command, kOutputHeading)
      .add("--box-classes", "LIST", "Classes whose objects have boxes, or all [countable ones]",
           flags.box_classes, parse_list);
}

void add_per_frame_option(CLI::App& command, OutputFlags& flags) {
  OptionGroup(command, kOutputHeading)
      .add_flag("--per-frame", "A file for each frame: .pcd .ply .csv .las [one for all frames]",
                flags.per_frame);
}

void add_legacy_output_option(CLI::App& command, OutputFlags& flags) {
  OptionGroup(command, kWoods2016Heading)
      .add("--legacy-output", "NAME", "Write NAME.pcd and NAME.transform", flags.legacy_name);
}

void hide_standard_output(CLI::App& command) {
  command.get_option("--output")->description("File to write, repeatable");
  command.get_option("--format")->group("");
}

std::string output_names_text() {
  std::string text = "Output files by suffix:\n";
  for (const OutputFormat& format : output_formats()) {
    text += fmt::format("  {:<17} {}{}\n", format.suffix, format.description,
                        format.missing.empty() ? "" : "; not in this build");
  }
  text += "\nColumns of clouds (* by default):\n";
  std::string names;
  for (const std::string& name : cloud_column_names()) {
    names += (names.empty() ? "" : " ") + name + (contains(default_columns(), name) ? "*" : "");
  }
  text += indented(names);
  text += "\nLayouts of clouds (" + suffixes_with_layouts() + " and bags):\n";
  for (const PointFieldLayout& layout : cloud_layouts()) {
    text += fmt::format("  {:<14} {}\n", layout.name, layout.description);
  }
  return text + driver_names_text() +
         "\nAxes of clouds:\n"
         "  optical      x right, y down, z forward\n"
         "  ros          x forward, y left, z up\n"
         "  gl           x right, y up, z back\n"
         "  legacy       x left, y up, z forward\n"
         "  world        those of the scene\n\n";
}

bool has_run_outputs(const OutputFlags& flags) {
  return !flags.imu_paths.empty() || !flags.recording_paths.empty();
}

}  // namespace glidar::app
