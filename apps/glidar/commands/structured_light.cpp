// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/commands/commands.hpp>
#include <apps/glidar/options/structured_light_options.hpp>
#include <apps/glidar/run/exit_code.hpp>
#include <apps/glidar/run/structured_light_files.hpp>
#include <glidar/core/error.hpp>
#include <glidar/io/config/structured_light_file.hpp>
#include <glidar/io/formats/grey_image_file.hpp>
#include <glidar/math/constants.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include <array>
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

/// "76.2 % valid, 11.3 % low_modulation ...": every status that occurs.
std::string fringe_share_text(const DecodedFringes& decoded) {
  std::array<std::size_t, kFringeStatusCount> counts{};
  for (const FringeStatus status : decoded.status) ++counts[static_cast<std::size_t>(status)];
  std::string text;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] == 0) continue;
    text += fmt::format(
        "{}{:.1f} % {}", text.empty() ? "" : ", ",
        100.0 * static_cast<double>(counts[i]) / static_cast<double>(decoded.status.size()),
        to_string(static_cast<FringeStatus>(i)));
  }
  return text;
}

MeasuredFringes decode_images(const StructuredLightFlags& flags, const StructuredLight& setup) {
  std::vector<GreyImage> images;
  for (const std::string& path : flags.images) images.push_back(load_grey_image(path));
  ThreadPool pool(flags.threads);
  MeasuredFringes measured;
  measured.decoded = decode_fringes(images, setup.patterns, setup.decoding, &pool);
  measured.depth_m = triangulate(measured.decoded, setup);
  return measured;
}

/// "60x2 pixels: 76.2 % valid ..." and the files.
std::string summary_text(const StructuredLightFlags& flags, const DecodedFringes& decoded) {
  return fmt::format("{}x{} pixels: {}\nwrote {}\n", decoded.width, decoded.height,
                     fringe_share_text(decoded), fmt::join(flags.outputs, " "));
}

/// Patterns and results appear together, so that an error leaves none.
int run_structured_light(const StructuredLightFlags& flags) {
  check_structured_light_flags(flags);
  const StructuredLight setup = load_structured_light(flags.setup);
  std::vector<std::string> read = flags.images;
  read.push_back(flags.setup);
  StagedFiles files;
  files.protect(read);
  std::string summary;
  if (!flags.pattern_folder.empty()) {
    const std::vector<std::string> names =
        stage_patterns(flags.pattern_folder, setup.patterns, files);
    summary = fmt::format("wrote {} to {} ({} files)\n", names.front(), names.back(), names.size());
  }
  if (!flags.outputs.empty()) {
    const MeasuredFringes measured = decode_images(flags, setup);
    stage_fringe_files(flags.outputs, measured, flags.depth_unit_mm * kMillimetre_m, files);
    summary += summary_text(flags, measured.decoded);
  }
  files.commit();
  if (!flags.quiet) fmt::print("{}", summary);
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
