// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/commands/commands.hpp>
#include <apps/glidar/options/structured_light_options.hpp>
#include <apps/glidar/run/exit_code.hpp>
#include <apps/glidar/run/printing.hpp>
#include <apps/glidar/run/status_shares.hpp>
#include <apps/glidar/run/structured_light_files.hpp>
#include <glidar/core/error.hpp>
#include <glidar/io/config/structured_light_file.hpp>
#include <glidar/math/constants.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include <memory>
#include <string>
#include <vector>

namespace glidar::app {
namespace {

constexpr const char* kStructuredLightExamples =
    R"(Phase-shifted fringes with a Gray code: writes the images to be projected, and turns the camera's
images of them into depth.
Examples:
  glidar structured-light examples/scanner.yaml --patterns patterns/
With your own files, the images in the order of the patterns:
  glidar structured-light setup.yaml image_*.png -o depth.npy -o status.png -o phase.npy
With the images of a simulated scanner, as one NumPy array:
  glidar structured-light examples/scanner.yaml view.patterns.npy -o depth.npy

setup.yaml is a sensor file with a depth_camera of type structured_light, which glidar render
simulates, or has the keys of pinhole optics in sensor files:
  camera: {width: 1280, height: 1024, fx: 1800, fy: 1800, cx: 640, cy: 512}
  projector: {width: 1280, height: 800, fx: 1500, fy: 1500, cx: 640, cy: 400}
  projector_from_camera: {position: [-0.2, 0, 0], rotation_vector: [0, 0.25, 0]}
  patterns: {steps: 4, period_px: 32}

The end of a name states the content: depth.npy float32, m; depth.png 16 bits, --depth-unit-mm;
coordinate.npy column (or row) of the projector, pixels; phase.npy rad; modulation.npy grey levels;
status.npy a number and status.png a colour for each cause of a hole.
Exit codes: 0 done, 2 the images or options are not valid.)";

void check_structured_light_flags(const StructuredLightFlags& flags) {
  check_fringe_outputs(flags.outputs);
  if (flags.outputs.empty() && flags.pattern_folder.empty()) {
    throw Error({"--output", "there is neither -o nor --patterns, so nothing would be written", "",
                 "add -o depth.npy or --patterns FOLDER, for example"});
  }
  if (flags.images.empty() == flags.outputs.empty()) return;
  if (flags.images.empty()) {
    throw Error({"IMAGE", "there are no images to be decoded", "one for each pattern",
                 "add the images in the order of the patterns"});
  }
  throw Error({"--output", "there are images but no output", "", "add -o depth.npy, for example"});
}

MeasuredFringes measure_images(const StructuredLightFlags& flags, const StructuredLight& setup) {
  ThreadPool pool(flags.threads);
  return measure_fringes(load_camera_images(flags.images, setup), setup, &pool);
}

void print_summary(const StructuredLightFlags& flags, const std::vector<std::string>& patterns,
                   const DecodedFringes& decoded) {
  if (!patterns.empty()) {
    print("wrote {} to {} ({} files)\n", patterns.front(), patterns.back(), patterns.size());
  }
  if (flags.outputs.empty()) return;
  print("{}x{} pixels: {}\nwrote {}\n", decoded.width, decoded.height,
        status_shares(decoded.status, kFringeStatusCount),
        fmt::format("{}", fmt::join(flags.outputs, " ")));
}

int run_structured_light(const StructuredLightFlags& flags) {
  check_structured_light_flags(flags);
  const StructuredLight setup = load_structured_light(flags.setup);
  MeasuredFringes measured;
  if (!flags.outputs.empty()) measured = measure_images(flags, setup);
  std::vector<std::string> read = flags.images;
  read.push_back(flags.setup);
  StagedFiles files;
  files.protect(read);
  std::vector<std::string> patterns;
  if (!flags.pattern_folder.empty()) {
    patterns = add_patterns(flags.pattern_folder, setup.patterns, files);
  }
  add_fringe_files(flags.outputs, measured, flags.depth_unit_mm * kMillimetre_m, files);
  files.commit();
  if (!flags.quiet) print_summary(flags, patterns, measured.decoded);
  return kDone;
}

}  // namespace

Command add_structured_light(CLI::App& program) {
  CLI::App& command =
      *program.add_subcommand("structured-light", "Fringe patterns, and depth from images of them");
  const auto flags = std::make_shared<StructuredLightFlags>();
  command.footer(kStructuredLightExamples);
  add_structured_light_options(command, *flags);
  return [flags] { return run_structured_light(*flags); };
}

}  // namespace glidar::app
