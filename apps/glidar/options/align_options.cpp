// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/options/align_options.hpp>

#include <apps/glidar/options/option_group.hpp>

#include <CLI/CLI.hpp>

namespace glidar::app {

void add_align_options(CLI::App& command, AlignFlags& flags) {
  command.add_option("IMAGE", flags.files.images, "Depth images")->required()->type_name("");
  const OptionGroup output(command, "Output");
  output.add("-o,--output", "FILE|FOLDER",
             "PNG file, or folder for several images, which keep their names", flags.files.output);
  output.add_flag("--keep-depth", "Depths of the depth camera, not of the colour camera",
                  flags.keeps_depth);
  const OptionGroup cameras(command, "Cameras");
  cameras.add("--cameras", "FILE", "Both cameras and their poses (YAML)", flags.cameras);
  const OptionGroup run(command, "Run");
  run.add_flag("--quiet", "No summary, only warnings", flags.quiet);
}

}  // namespace glidar::app
