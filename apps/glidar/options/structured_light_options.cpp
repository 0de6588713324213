// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/options/structured_light_options.hpp>

#include <apps/glidar/options/option_group.hpp>
#include <apps/glidar/options/option_values.hpp>

#include <CLI/CLI.hpp>

namespace glidar::app {

void add_structured_light_options(CLI::App& command, StructuredLightFlags& flags) {
  command.add_option("SETUP", flags.setup, "Camera, projector and patterns (YAML)")
      ->required()
      ->type_name("");
  command
      .add_option("IMAGE", flags.images,
                  "Images of the camera, one for each pattern (.png), or one array of them (.npy)")
      ->type_name("");
  const OptionGroup output(command, "Output");
  output.add_repeatable("-o,--output", "FILE",
                        "Name that states the content, such as depth.npy; see below",
                        [&flags](const std::string& path) { flags.outputs.push_back(path); });
  output.add("--depth-unit-mm", "MM", "Unit of depth images [0.1]", flags.depth_unit_mm,
             number(kAboveZero, kFinite, "a finite number above 0"));
  output.add("--patterns", "FOLDER", "Write the images to be projected: pattern_00.png ...",
             flags.pattern_folder);
  const OptionGroup run(command, "Run");
  run.add("--threads", "N", "Number of threads; 0: one per processor [0]", flags.threads,
          whole<unsigned>(0, 4096));
  run.add_flag("--quiet", "No summary, only warnings", flags.quiet);
}

}  // namespace glidar::app
