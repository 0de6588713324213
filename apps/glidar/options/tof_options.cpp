// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/options/tof_options.hpp>

#include <apps/glidar/options/option_group.hpp>
#include <apps/glidar/options/option_values.hpp>

#include <CLI/CLI.hpp>

namespace glidar::app {

void add_tof_options(CLI::App& command, TofFlags& flags) {
  const OptionGroup camera(command, "Camera");
  camera.add("--sensor", "NAME", "Preset or sensor file of the time-of-flight camera",
             flags.sensor);
  const OptionGroup output(command, "Output");
  output.add_repeatable("-o,--output", "FILE",
                        "Name ending in depth, range, amplitude or status, .npy or .png",
                        [&flags](const std::string& path) { flags.outputs.push_back(path); });
  output.add("--depth-unit-mm", "MM", "Unit of PNG images of depth and range [1]",
             flags.depth_unit_mm, number(kAboveZero, kFinite, "a finite number above 0"));
  output.add("--explain", "X,Y", "Print the phases and tests of a pixel (column, row)",
             flags.explained, parse_pixel);
  const OptionGroup run(command, "Run");
  run.add("--threads", "N", "Number of threads; 0: one per processor [0]", flags.threads,
          whole<unsigned>(0, 4096));
  run.add_flag("--quiet", "No summary, only warnings", flags.quiet);
}

}  // namespace glidar::app
