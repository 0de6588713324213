// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/commands/commands.hpp>
#include <apps/glidar/options/option_group.hpp>
#include <apps/glidar/options/option_values.hpp>
#include <apps/glidar/run/console.hpp>
#include <apps/glidar/run/exit_code.hpp>
#include <apps/glidar/run/image_files.hpp>
#include <apps/glidar/run/printing.hpp>
#include <apps/glidar/run/status_shares.hpp>
#include <glidar/core/error.hpp>
#include <glidar/depth_camera/stereo.hpp>
#include <glidar/io/files/staged_files.hpp>
#include <glidar/io/formats/grey_image_file.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace glidar::app {
namespace {

/// What the name of a file asks for.
enum class StereoQuantity { depth, disparity, status };

constexpr std::array<Colour, kStereoStatusCount> kStereoColours = {{{235, 235, 235},
                                                                    {110, 110, 110},
                                                                    {30, 30, 30},
                                                                    {240, 200, 40},
                                                                    {150, 90, 200},
                                                                    {225, 110, 40},
                                                                    {50, 110, 200}}};

ImageSize size_of(const StereoMatch& match) {
  return {match.width, match.height};
}

void write_depth(const std::string& path, const StereoMatch& match, const StereoGeometry& geometry,
                 AtomicFile& file) {
  const std::vector<float> depth_m = stereo_depth_m(match, geometry);
  const std::span<const float> depths(depth_m);
  if (is_npy(path)) return write_image_npy(depths, "<f4", size_of(match), file);
  write_multiples_png(depths, geometry.depth_unit_m,
                      "depth in units of " + number_text(geometry.depth_unit_m) + " m, 0: none",
                      size_of(match), file);
}

void write_disparity(const std::string& path, const StereoMatch& match, AtomicFile& file) {
  const std::span<const float> disparity(match.disparity_px);
  if (is_npy(path)) return write_image_npy(disparity, "<f4", size_of(match), file);
  write_multiples_png(disparity, 1.0 / 32.0, "disparity in units of 1/32 px, 0: none",
                      size_of(match), file);
}

/// "wall_depth.png" is depth. Throws Error for other names.
StereoQuantity stereo_quantity(const std::string& path) {
  const std::filesystem::path file(path);
  const std::string stem = file.stem().string();
  if (file.extension() == ".png" || file.extension() == ".npy") {
    if (stem.ends_with("depth")) return StereoQuantity::depth;
    if (stem.ends_with("disparity")) return StereoQuantity::disparity;
    if (stem.ends_with("status")) return StereoQuantity::status;
  }
  throw Error({"--output, " + path, "its name does not state what to write",
               "names ending in depth, disparity or status, and .png or .npy",
               "use a name such as depth.png or wall_disparity.npy"});
}

/// Writes all files, which appear together. `read` are files that must not be overwritten. Depth
/// needs a geometry. Throws Error.
void write_stereo_files(std::span<const std::string> paths, std::span<const std::string> read,
                        const StereoMatch& match, const StereoGeometry& geometry) {
  StagedFiles files;
  files.protect(read);
  for (const std::string& path : paths) {
    AtomicFile& file = files.add(path);
    const StereoQuantity quantity = stereo_quantity(path);
    if (quantity == StereoQuantity::depth) write_depth(path, match, geometry, file);
    if (quantity == StereoQuantity::disparity) write_disparity(path, match, file);
    if (quantity == StereoQuantity::status) {
      write_status_image(path, match.status, kStereoColours, size_of(match), file);
    }
    file.finish();
  }
  files.commit();
}

/// The command line of `glidar stereo`.
struct StereoFlags {
  std::string left;
  std::string right;
  std::vector<std::string> outputs;
  StereoOptions options;
  double focal_length_px = 0.0;  ///< 0: not given
  double baseline_mm = 0.0;      ///< 0: not given
  double column_offset_px = 0.0;
  double depth_unit_mm = 1.0;
  std::optional<std::array<std::uint32_t, 2>> explained;  ///< column and row
  unsigned threads = 0;
  bool quiet = false;
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
  const OptionGroup output(command, "Output");
  output.add_repeatable("-o,--output", "FILE",
                        "Name ending in depth, disparity or status, and .npy or .png",
                        [&flags](const std::string& path) { flags.outputs.push_back(path); });
  output.add("--explain", "X,Y", "Print the costs and tests of a pixel (column, row)",
             flags.explained, parse_pixel);
  const OptionGroup camera(command, "Camera, for depth");
  camera.add("--focal-length-px", "PX", "Focal length of the rectified images",
             flags.focal_length_px, number(kAboveZero, kFinite, "a finite number above 0"));
  camera.add("--baseline-mm", "MM", "Distance of the cameras", flags.baseline_mm,
             number(kAboveZero, kFinite, "a finite number above 0"));
  camera.add("--column-offset-px", "PX", "Principal column of the right minus the left image [0]",
             flags.column_offset_px, number(-kFinite, kFinite, "a finite number"));
  camera.add("--depth-unit-mm", "MM", "Unit of depth images [1]", flags.depth_unit_mm,
             number(kAboveZero, kFinite, "a finite number above 0"));
  add_search_options(command, flags.options);
  add_test_options(command, flags.options);
  const OptionGroup run(command, "Run");
  run.add("-j,--threads", "N", "Number of threads; 0: one per processor [0]", flags.threads,
          whole<unsigned>(0, 4096));
  run.add_flag("-q,--quiet", "No summary, only warnings", flags.quiet);
}

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
