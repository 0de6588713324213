// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/options/filter_options.hpp>

#include <apps/glidar/options/option_group.hpp>
#include <apps/glidar/options/option_values.hpp>
#include <glidar/io/config/depth_filter_text.hpp>

#include <CLI/CLI.hpp>

namespace glidar::app {

void add_filter_options(CLI::App& command, FilterFlags& flags) {
  command.add_option("IMAGE", flags.files.images, "Depth images in the order of time")
      ->required()
      ->type_name("");
  const OptionGroup output(command, "Output");
  output.add("-o,--output", "FILE|FOLDER",
             "PNG file, or folder for several images, which keep their names", flags.files.output);
  const OptionGroup filters(command, "Filters");
  filters.add_repeatable(
      "--filter", "TYPE[,KEY=VALUE]", "Next filter, such as spatial,alpha=0.6 [recommended ones]",
      [&flags](const std::string& text) { flags.filters.push_back(parse_depth_filter(text)); });
  const OptionGroup camera(command, "Camera");
  camera.add("--focal-length-px", "PX", "Focal length of the images, for disparities",
             flags.focal_length_px, number(kAboveZero, kFinite, "a finite number above 0"));
  camera.add("--baseline-mm", "MM", "Baseline: recommended filters smooth disparities [depths]",
             flags.baseline_mm, number(kAboveZero, 1e6, "millimetres above 0, up to 1e6"));
  camera.add("--depth-unit-mm", "MM", "Unit of the images [1]", flags.files.unit_mm,
             number(kAboveZero, kFinite, "a finite number above 0"));
  const OptionGroup run(command, "Run");
  run.add_flag("--quiet", "No summary, only warnings", flags.quiet);
}

}  // namespace glidar::app
