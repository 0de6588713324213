// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/commands/commands.hpp>
#include <apps/glidar/options/option_group.hpp>
#include <apps/glidar/run/console.hpp>
#include <apps/glidar/run/image_files.hpp>
#include <glidar/core/error.hpp>
#include <glidar/io/config/depth_camera_files.hpp>
#include <glidar/math/constants.hpp>

#include <CLI/CLI.hpp>

#include <memory>
#include <string>

namespace glidar::app {
namespace {

/// The command line of `glidar align`.
struct AlignFlags {
  DepthImageFiles files;
  std::string cameras;
  bool keeps_depth = false;
  bool quiet = false;
};

/// Declares all arguments.
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
  run.add_flag("-q,--quiet", "No summary, only warnings", flags.quiet);
}

constexpr const char* kAlignExamples =
    R"(Moves the depths of depth images (PNG of 16 bits, 0 for none) to the pixels of a colour camera.
Pixels that only the colour camera sees have no depth.
Examples:
  glidar render builtin:asteroid --sensor D435 -o asteroid.depth.png
  glidar align asteroid.depth.png --cameras examples/d435_cameras.yaml -o aligned.png
With your own files:
  glidar align depth_*.png --cameras cameras.yaml --keep-depth -o aligned/

cameras.yaml, with the keys of pinhole optics in sensor files:
  depth: {width: 848, height: 480, fx: 430, fy: 430, cx: 424, cy: 240}
  colour: {width: 1280, height: 720, fx: 920, fy: 920, cx: 640, cy: 360}
  colour_from_depth: {position: [0.015, 0, 0], orientation: {w: 1, x: 0, y: 0, z: 0}}
Exit codes: 0 done, 2 the images or options are not valid.)";

int run_align(const AlignFlags& flags) {
  if (flags.cameras.empty()) {
    throw Error({"--cameras", "there is no file of the cameras", "a YAML file",
                 "add --cameras cameras.yaml; glidar align --help shows its keys"});
  }
  DepthAlignment alignment = load_depth_alignment(flags.cameras);
  alignment.keeps_depth = alignment.keeps_depth || flags.keeps_depth;
  DepthImageFiles files = flags.files;
  files.settings = flags.cameras;
  files.unit_mm = alignment.unit_m / kMillimetre_m;
  const DepthAligner aligner(alignment);
  const DepthImageSummary summary = change_depth_images(
      files, [&aligner](const DepthImage& image) { return aligner.align(image).image; });
  if (!flags.quiet) print_lines(stdout, summary_text(summary, "alignment"));
  return kDone;
}

}  // namespace

Command add_align(CLI::App& program) {
  CLI::App& command =
      *program.add_subcommand("align", "Move depth images to the pixels of a colour camera");
  const auto flags = std::make_shared<AlignFlags>();
  command.footer(kAlignExamples);
  add_align_options(command, *flags);
  return [flags] { return run_align(*flags); };
}

}  // namespace glidar::app
