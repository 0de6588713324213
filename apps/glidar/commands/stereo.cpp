// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/commands/commands.hpp>
#include <apps/glidar/options/stereo_options.hpp>
#include <apps/glidar/run/console.hpp>
#include <apps/glidar/run/exit_code.hpp>
#include <apps/glidar/run/printing.hpp>
#include <apps/glidar/run/status_shares.hpp>
#include <apps/glidar/run/stereo_files.hpp>
#include <glidar/core/error.hpp>
#include <glidar/io/formats/grey_image_file.hpp>
#include <glidar/stereo/sample_pair.hpp>
#include <glidar/stereo/stereo_trace.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace glidar::app {
namespace {

constexpr const char* kSample = "builtin:dots";

constexpr const char* kStereoExamples =
    R"(Matches a rectified pair of grey PNG images of 8 or 16 bits: for each pixel of the left image, its
disparity in the right one or the cause of a hole.
Examples:
  glidar stereo builtin:dots -o disparity.npy -o status.png
  glidar stereo builtin:dots --focal-length-px 430 --baseline-mm 50 -o depth.png
  glidar stereo builtin:dots --explain 128,81
With your own files:
  glidar stereo left.png right.png --disparities 96 -o disparity.png

The end of a name states the content: disparity.npy float32, pixels, NaN in holes; disparity.png
16 bits, 1/32 px; depth.npy float32, m; depth.png 16 bits, --depth-unit-mm; status.npy a number and
status.png a colour for each cause.
Exit codes: 0 done, 2 the images or options are not valid.)";

StereoPair load_pair(const StereoFlags& flags) {
  if (flags.left == kSample && flags.right.empty()) return sample_stereo_pair();
  if (flags.right.empty()) {
    throw Error({"RIGHT", "there is no right image", "two PNG images, or builtin:dots alone",
                 "add the right image"});
  }
  return {load_grey_image(flags.left), load_grey_image(flags.right)};
}

bool writes_depth(const StereoFlags& flags) {
  return std::any_of(flags.outputs.begin(), flags.outputs.end(), [](const std::string& path) {
    return stereo_quantity(path) == StereoQuantity::depth;
  });
}

void check_stereo_flags(const StereoFlags& flags) {
  if (flags.outputs.empty() && !flags.explained) {
    throw Error({"--output", "there is neither -o nor --explain, so nothing would be written", "",
                 "add -o disparity.npy, for example"});
  }
  if (!writes_depth(flags) || (flags.focal_length_px > 0.0 && flags.baseline_mm > 0.0)) return;
  throw Error({"--output", "depth needs the geometry of the cameras",
               "--focal-length-px and --baseline-mm", "add both, or write the disparity"});
}

StereoGeometry geometry_of(const StereoFlags& flags) {
  return {.focal_length_px = flags.focal_length_px,
          .baseline_m = flags.baseline_mm * 1e-3,
          .column_offset_px = flags.column_offset_px,
          .depth_unit_m = flags.depth_unit_mm * 1e-3};
}

void match_and_write(const StereoFlags& flags, const StereoPair& pair, Console& console,
                     ThreadPool& pool) {
  StereoMatch match;
  {
    const ProgressScope progress(console, "matching");
    match =
        match_stereo(pair.left, pair.right, flags.options,
                     {.pool = &pool, .progress = [&](double done) { console.set_progress(done); }});
  }
  std::vector<std::string> read;
  if (!flags.right.empty()) read = {flags.left, flags.right};
  write_stereo_files(flags.outputs, read, match, geometry_of(flags));
  if (flags.quiet) return;
  print("{}x{} pixels: {}\nwrote {}\n", match.width, match.height,
        status_shares(match.status, kStereoStatusCount),
        fmt::format("{}", fmt::join(flags.outputs, " ")));
}

int run_stereo(const StereoFlags& flags) {
  check_stereo_flags(flags);
  Console console(flags.quiet);
  const StereoPair pair = load_pair(flags);
  ThreadPool pool(flags.threads);
  std::string trace;  // before any file is written, because the pixel may be outside the image
  if (flags.explained) {
    trace = format_stereo_trace(
        explain_stereo(pair.left, pair.right, flags.options, *flags.explained, {.pool = &pool}));
  }
  if (!flags.outputs.empty()) match_and_write(flags, pair, console, pool);
  print_lines(stdout, trace);
  return kDone;
}

}  // namespace

Command add_stereo(CLI::App& program) {
  CLI::App& command =
      *program.add_subcommand("stereo", "Match a rectified stereo pair: disparity and depth");
  const auto flags = std::make_shared<StereoFlags>();
  command.footer(kStereoExamples);
  command.add_option("LEFT", flags->left, "Left image, or builtin:dots")->required()->type_name("");
  command.add_option("RIGHT", flags->right, "Right image")->type_name("");
  add_stereo_options(command, *flags);
  return [flags] { return run_stereo(*flags); };
}

}  // namespace glidar::app
