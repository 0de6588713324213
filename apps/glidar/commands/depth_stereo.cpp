// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/commands/depth.hpp>
#include <apps/glidar/options/option_group.hpp>
#include <apps/glidar/options/option_values.hpp>
#include <apps/glidar/run/console.hpp>
#include <glidar/core/error.hpp>
#include <glidar/depth_camera/stereo.hpp>
#include <glidar/io/formats/grey_image_file.hpp>
#include <glidar/math/constants.hpp>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <vector>

namespace glidar::app {
namespace {

constexpr std::array<std::string_view, 3> kNames = {"depth", "disparity", "status"};
constexpr ImageContents kStereoContents = {kNames, kNames.size()};

constexpr std::array<Colour, kStereoStatusCount> kStereoColours = {{{235, 235, 235},
                                                                    {110, 110, 110},
                                                                    {30, 30, 30},
                                                                    {240, 200, 40},
                                                                    {150, 90, 200},
                                                                    {225, 110, 40},
                                                                    {50, 110, 200}}};

/// The command line of `glidar depth stereo`.
struct StereoFlags {
  std::string left;
  std::string right;
  ImageOutputs outputs;
  StereoOptions options;
  double focal_length_px = 0.0;  ///< 0: not given
  double baseline_mm = 0.0;      ///< 0: not given
  double column_offset_px = 0.0;
};

void add_search_options(CLI::App& command, StereoOptions& options) {
  const OptionGroup group(command, "Matching");
  group.add("--min-disparity", "PX", "Least disparity searched [0]", options.min_disparity_px,
            whole<std::uint32_t>(0, 16384));
  group.add("--disparities", "N", "Number of disparities searched [128]", options.disparities,
            whole<std::uint32_t>(2, 4096));
  group.add("--census", "KIND", "Pixels compared: 9x9, 7x7, 7x7-symmetric [7x7]", options.census,
            one_of<StereoCensus>({{"9x9", StereoCensus::window_9x9},
                                  {"7x7", StereoCensus::window_7x7},
                                  {"7x7-symmetric", StereoCensus::symmetric_7x7}}));
  group.add("--box", "PX", "Odd side of the window that sums costs, 1 to 9 [5]", options.box_px,
            whole<std::uint32_t>(1, 9));
  group.add("--paths", "N", "4: rows and columns; 8: diagonals too [8]", options.paths,
            whole<std::uint32_t>(4, 8));
  group.add("--p1", "BITS", "Penalty of a step of 1 px, per pixel of the box [4]", options.p1,
            number(0.0, 1000.0, "a number from 0 to 1000"));
  group.add("--p2", "BITS", "Penalty of a larger step, bits per pixel [16]", options.p2,
            number(0.0, 1000.0, "a number from 0 to 1000"));
  group.add("--subpixel", "CURVE", "Curve through three costs: v, parabola, none [v]",
            options.subpixel,
            one_of<StereoSubpixel>({{"v", StereoSubpixel::v_shape},
                                    {"parabola", StereoSubpixel::parabola},
                                    {"none", StereoSubpixel::none}}));
  group.add("--a-factor", "PX", "Adds this times sin(2 pi fraction) [0.04]", options.a_factor,
            number(-0.15, 0.15, "a number from -0.15 to 0.15"));
  group.add("--steps-per-px", "N", "Disparities are multiples of 1/N; 0: not rounded [32]",
            options.steps_per_px, whole<std::uint32_t>(0, 4096));
}

void add_test_options(CLI::App& command, StereoOptions& options) {
  const OptionGroup group(command, "Tests of a pixel");
  group.add("--uniqueness", "PERCENT", "How much more others must cost; 0: no test [15]",
            options.uniqueness_percent, whole<std::uint32_t>(0, 99));
  group.add("--left-right", "PX", "Greatest difference of both views [1]", options.left_right_px,
            whole<std::uint32_t>(0, 4096));
  group.add_flag("--no-left-right", "Without the comparison of both views",
                 options.has_left_right_test, false);
  group.add("--min-texture", "LEVELS", "Mean step of grey levels; 0: no test [0.5]",
            options.min_texture, number(0.0, 65535.0, "a number from 0 to 65535"));
  group.add("--saturation", "LEVEL", "Grey level of saturated pixels; 0: the greatest [0]",
            options.saturation_level, whole<std::uint32_t>(0, 65535));
}

/// Declares all options but LEFT and RIGHT.
void add_stereo_options(CLI::App& command, StereoFlags& flags) {
  add_output_options(command, kStereoContents, flags.outputs);
  add_explain_option(command, "Print the costs and tests of a pixel (column, row)", flags.outputs);
  const OptionGroup camera(command, "Camera, for depth");
  camera.add("--focal-length-px", "PX", "Focal length of the rectified images",
             flags.focal_length_px, number(kAboveZero, kFinite, "a finite number above 0"));
  camera.add("--baseline-mm", "MM", "Distance of the cameras", flags.baseline_mm,
             number(kAboveZero, kFinite, "a finite number above 0"));
  camera.add("--column-offset-px", "PX", "Principal column of the right minus the left image [0]",
             flags.column_offset_px, number(-kFinite, kFinite, "a finite number"));
  add_search_options(command, flags.options);
  add_test_options(command, flags.options);
  add_run_options(command, flags.outputs);
}

constexpr const char* kSample = "builtin:dots";

constexpr const char* kStereoExamples =
    R"(Matches a rectified pair of grey PNG images of 8 or 16 bits: for each pixel of the left image, its
disparity in the right one or the cause of a hole.
Examples:
  glidar depth stereo builtin:dots -o disparity.npy -o status.png
  glidar depth stereo builtin:dots --focal-length-px 430 --baseline-mm 50 -o depth.png
  glidar depth stereo builtin:dots --explain 128,81
With your own files:
  glidar depth stereo left.png right.png --disparities 96 -o disparity.png

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

void check_stereo_flags(const StereoFlags& flags) {
  check_outputs(flags.outputs, kStereoContents, "--explain", flags.outputs.explained.has_value());
  const bool has_geometry = flags.focal_length_px > 0.0 && flags.baseline_mm > 0.0;
  for (const std::string& path : flags.outputs.paths) {
    if (has_geometry || content_of(path, kStereoContents) != "depth") continue;
    throw Error({"--output", "depth needs the geometry of the cameras",
                 "--focal-length-px and --baseline-mm", "add both, or write the disparity"});
  }
}

void write_stereo_image(const std::string& path, std::string_view content, const StereoFlags& flags,
                        const StereoMatch& match, AtomicFile& file) {
  const ImageSize size = {match.width, match.height};
  if (content == "status") {
    return write_status_image(path, numbers_of(match.status), kStereoColours, size, file);
  }
  if (content == "disparity") {
    return write_number_image(path, match.disparity_px, 1.0 / 32.0,
                              "disparity in units of 1/32 px, 0: none", size, file);
  }
  const StereoGeometry geometry = {.focal_length_px = flags.focal_length_px,
                                   .baseline_m = flags.baseline_mm * kMillimetre_m,
                                   .column_offset_px = flags.column_offset_px,
                                   .depth_unit_m = flags.outputs.depth_unit_mm * kMillimetre_m};
  write_length_image(path, stereo_depth_m(match, geometry), flags.outputs, "depth", size, file);
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
  const std::vector<std::string> read = {flags.left, flags.right};
  StagedFiles files;
  if (!flags.right.empty()) files.protect(read);
  add_images(
      flags.outputs, kStereoContents,
      [&](const std::string& path, std::string_view content, AtomicFile& file) {
        write_stereo_image(path, content, flags, match, file);
      },
      files);
  files.commit();
  print_shares(numbers_of(match.status), status_names<StereoStatus>(kStereoStatusCount),
               {match.width, match.height}, flags.outputs);
}

int run_stereo(const StereoFlags& flags) {
  check_stereo_flags(flags);
  Console console(flags.outputs.quiet);
  const StereoPair pair = load_pair(flags);
  ThreadPool pool(flags.outputs.threads);
  std::string trace;  // before any file is written, because the pixel may be outside the image
  if (flags.outputs.explained) {
    trace = format_stereo_trace(explain_stereo(pair.left, pair.right, flags.options,
                                               *flags.outputs.explained, {.pool = &pool}));
  }
  if (!flags.outputs.paths.empty()) match_and_write(flags, pair, console, pool);
  print_lines(stdout, trace);
  return kDone;
}

}  // namespace

Command add_stereo(CLI::App& depth) {
  CLI::App& command =
      *depth.add_subcommand("stereo", "Match a rectified stereo pair: disparity and depth");
  const auto flags = std::make_shared<StereoFlags>();
  command.footer(kStereoExamples);
  command.add_option("LEFT", flags->left, "Left image, or builtin:dots")->required()->type_name("");
  command.add_option("RIGHT", flags->right, "Right image")->type_name("");
  add_stereo_options(command, *flags);
  return [flags] { return run_stereo(*flags); };
}

}  // namespace glidar::app
