// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/commands/commands.hpp>
#include <apps/glidar/options/option_group.hpp>
#include <apps/glidar/options/option_values.hpp>
#include <apps/glidar/run/depth_images.hpp>
#include <apps/glidar/run/exit_code.hpp>
#include <apps/glidar/run/printing.hpp>
#include <glidar/depth_camera/depth_filters.hpp>
#include <glidar/io/config/depth_filter_text.hpp>
#include <glidar/math/constants.hpp>

#include <CLI/CLI.hpp>

#include <memory>
#include <vector>

namespace glidar::app {
namespace {

/// The command line of `glidar filter`.
struct FilterFlags {
  DepthImageFiles files;
  std::vector<DepthFilter> filters;  ///< empty: the recommended ones
  double focal_length_px = 0.0;      ///< 0: not given
  double baseline_mm = 0.0;          ///< 0: not given
  bool quiet = false;
};

/// Declares all arguments.
void add_filter_options(CLI::App& command, FilterFlags& flags) {
  command.add_option("IMAGE", flags.files.images, "Depth images in the order of time")
      ->required()
      ->type_name("");
  const OptionGroup output(command, "Output");
  output.add("-o,--output", "FILE|FOLDER",
             "PNG file, or folder for several images, which keep their names", flags.files.output);
  const OptionGroup filters(command, "Filters");
  filters.add_repeatable(
      "--filter", "TYPE[,KEY=VALUE]", "Next filter, such as spatial,alpha=0.6 [recommended ones]",
      [&flags](const std::string& text) { flags.filters.push_back(parse_depth_filter(text)); });
  const OptionGroup camera(command, "Camera");
  camera.add("--focal-length-px", "PX", "Focal length of the images, for disparities",
             flags.focal_length_px, number(kAboveZero, kFinite, "a finite number above 0"));
  camera.add("--baseline-mm", "MM", "Baseline: recommended filters smooth disparities [depths]",
             flags.baseline_mm, number(kAboveZero, 1e6, "millimetres above 0, up to 1e6"));
  camera.add("--depth-unit-mm", "MM", "Unit of the images [1]", flags.files.unit_mm,
             number(kAboveZero, kFinite, "a finite number above 0"));
  const OptionGroup run(command, "Run");
  run.add_flag("-q,--quiet", "No summary, only warnings", flags.quiet);
}

constexpr const char* kFilterExamples =
    R"(Filters depth images (PNG of 16 bits, 0 for none) of one camera, in the given order, as the driver
of a depth camera does: the filters, defaults and results are those of librealsense.
Examples:
  glidar render builtin:asteroid --sensor D435 -o asteroid.depth.png
  glidar filter asteroid.depth.png --filter spatial --filter hole_filling -o filtered.png
  glidar filter asteroid.depth.png --focal-length-px 430 --baseline-mm 50 -o filtered.png
With your own files:
  glidar filter depth_*.png --filter temporal,alpha=0.2,persistence=8 -o filtered/
  glidar filter depth_*.png --filter to_disparity,baseline_m=0.05 --filter spatial,delta=8
      --filter to_depth --focal-length-px 430 -o filtered/

Filters: decimation (magnitude), threshold (min_m, max_m), to_disparity (baseline_m), spatial
(alpha, delta, magnitude, hole_filling), temporal (alpha, delta, persistence), to_depth,
hole_filling (source). Without --filter: decimation, spatial, temporal, hole_filling; with
--baseline-mm, spatial and temporal filter disparities.
Exit codes: 0 done, 2 the images or options are not valid.)";

int run_filter(const FilterFlags& flags) {
  const std::vector<DepthFilter> filters =
      flags.filters.empty() ? recommended_depth_filters(flags.baseline_mm * kMillimetre_m)
                            : flags.filters;
  DepthFilterChain chain(filters, {.focal_length_px = flags.focal_length_px,
                                   .unit_m = flags.files.unit_mm * kMillimetre_m});
  const DepthImageSummary summary = change_depth_images(
      flags.files, [&chain](const DepthImage& image) { return chain.apply(image); });
  if (!flags.quiet) print_lines(stdout, summary_text(summary, "filtering"));
  return kDone;
}

}  // namespace

Command add_filter(CLI::App& program) {
  CLI::App& command =
      *program.add_subcommand("filter", "Filter depth images as the driver of a camera does");
  const auto flags = std::make_shared<FilterFlags>();
  command.footer(kFilterExamples);
  add_filter_options(command, *flags);
  return [flags] { return run_filter(*flags); };
}

}  // namespace glidar::app
