// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/options/stereo_options.hpp>

#include <apps/glidar/options/option_group.hpp>
#include <apps/glidar/options/option_values.hpp>

#include <CLI/CLI.hpp>

namespace glidar::app {
namespace {

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

}  // namespace

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
  run.add("--threads", "N", "Number of threads; 0: one per processor [0]", flags.threads,
          whole<unsigned>(0, 4096));
  run.add_flag("--quiet", "No summary, only warnings", flags.quiet);
}

}  // namespace glidar::app
