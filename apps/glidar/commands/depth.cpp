// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/commands/depth.hpp>

#include <apps/glidar/options/option_group.hpp>
#include <apps/glidar/options/option_values.hpp>
#include <apps/glidar/run/console.hpp>
#include <glidar/core/error.hpp>
#include <glidar/core/text.hpp>
#include <glidar/depth_camera/depth_filters.hpp>
#include <glidar/io/config/depth_camera_files.hpp>
#include <glidar/io/formats/grey_image_file.hpp>
#include <glidar/io/pictures/picture.hpp>
#include <glidar/math/constants.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <set>
#include <utility>

namespace glidar::app {
namespace {

namespace fs = std::filesystem;

/// "depth, range or status".
std::string any_of_names(std::span<const std::string_view> names) {
  return fmt::format("{} or {}", fmt::join(names.first(names.size() - 1), ", "), names.back());
}

/// What the end of a name may be.
std::string allowed_names(const ImageContents& contents) {
  const std::string names = "names ending in " + any_of_names(contents.names);
  if (contents.png == contents.names.size()) return names + ", and .png or .npy";
  return fmt::format("{}, and .npy; {} also .png", names,
                     fmt::join(contents.names.first(contents.png), " and "));
}

}  // namespace

void add_output_options(CLI::App& command, const ImageContents& contents, ImageOutputs& outputs) {
  const OptionGroup group(command, "Output");
  group.add_repeatable("-o,--output", "FILE", "Name ending in " + any_of_names(contents.names),
                       [&outputs](const std::string& path) { outputs.paths.push_back(path); });
  group.add("--depth-unit-mm", "MM",
            fmt::format("Unit of PNG images of depth and range [{}]", outputs.depth_unit_mm),
            outputs.depth_unit_mm, number(kAboveZero, kFinite, "a finite number above 0"));
}

void add_explain_option(CLI::App& command, const std::string& help, ImageOutputs& outputs) {
  const OptionGroup group(command, "Output");
  group.add("--explain", "X,Y", help, outputs.explained, parse_pixel);
}

void add_run_options(CLI::App& command, ImageOutputs& outputs) {
  const OptionGroup run(command, "Run");
  run.add("-j,--threads", "N", "Number of threads; 0: one per processor [0]", outputs.threads,
          whole<unsigned>(0, 4096));
  run.add_flag("-q,--quiet", "No summary, only warnings", outputs.quiet);
}

std::string_view content_of(const std::string& path, const ImageContents& contents) {
  const fs::path file(path);
  const std::string stem = file.stem().string();
  for (std::size_t i = 0; i < contents.names.size(); ++i) {
    if (!stem.ends_with(contents.names[i])) continue;
    if (is_npy(path) || (file.extension() == ".png" && i < contents.png)) return contents.names[i];
  }
  throw Error({"--output, " + path, "its name does not state what to write",
               allowed_names(contents), "use a name such as depth.png or wall_status.npy"});
}

void check_outputs(const ImageOutputs& outputs, const ImageContents& contents,
                   const std::string& other, bool has_other) {
  for (const std::string& path : outputs.paths) (void)content_of(path, contents);
  if (!outputs.paths.empty() || has_other) return;
  throw Error({"--output", "there is neither -o nor " + other + ", so nothing would be written", "",
               "add -o depth.npy, for example"});
}

void add_images(const ImageOutputs& outputs, const ImageContents& contents, const WriteImage& write,
                StagedFiles& files) {
  for (const std::string& path : outputs.paths) {
    AtomicFile& file = files.add(path);
    write(path, content_of(path, contents), file);
    file.finish();
  }
}

void write_number_image(const std::string& path, std::span<const float> values, double unit,
                        const std::string& description, ImageSize size, AtomicFile& file) {
  if (is_npy(path)) {
    file.write(npy_header("<f4", std::array<std::size_t, 2>{size.height, size.width}));
    return file.write(std::as_bytes(values));
  }
  constexpr double kMaxPngNumber = 65535.0;
  std::vector<std::uint16_t> pixels;
  pixels.reserve(values.size());
  for (const float value : values) {
    const double multiple = std::round(static_cast<double>(value) / unit);
    const bool fits = multiple > 0.0 && multiple <= kMaxPngNumber;
    pixels.push_back(fits ? static_cast<std::uint16_t>(multiple) : std::uint16_t{0});
  }
  write_png(
      {PngKind::grey16, size.width, size.height, std::as_bytes(std::span(pixels)), description},
      file);
}

void write_length_image(const std::string& path, std::span<const float> lengths_m,
                        const ImageOutputs& outputs, const char* kind, ImageSize size,
                        AtomicFile& file) {
  const double unit_m = outputs.depth_unit_mm * kMillimetre_m;
  write_number_image(path, lengths_m, unit_m,
                     fmt::format("{} in units of {} m, 0: none", kind, number_text(unit_m)), size,
                     file);
}

void write_status_image(const std::string& path, std::span<const std::uint8_t> numbers,
                        std::span<const Colour> colours, ImageSize size, AtomicFile& file) {
  if (is_npy(path)) {
    file.write(npy_header("|u1", std::array<std::size_t, 2>{size.height, size.width}));
    return file.write(std::as_bytes(numbers));
  }
  Picture picture = make_picture(size.width, size.height, Colour{});
  for (std::size_t i = 0; i < numbers.size(); ++i) picture.pixels[i] = colours[numbers[i]];
  write_png(picture, "status of each pixel", file);
}

void print_shares(std::span<const std::uint8_t> numbers, std::span<const std::string> names,
                  ImageSize size, const ImageOutputs& outputs) {
  if (outputs.quiet) return;
  std::vector<std::string> shares;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto count = std::count(numbers.begin(), numbers.end(), static_cast<std::uint8_t>(i));
    if (count == 0) continue;
    shares.push_back(fmt::format(
        "{:.1f} % {}", 100.0 * static_cast<double>(count) / static_cast<double>(numbers.size()),
        names[i]));
  }
  print("{}x{} pixels: {}\nwrote {}\n", size.width, size.height,
        fmt::format("{}", fmt::join(shares, ", ")),
        fmt::format("{}", fmt::join(outputs.paths, " ")));
}

namespace {

/// Depth images to be changed, and where the results are written: a file for one image; for
/// several, or if it is a folder, a folder for files of the same names.
struct DepthImageFiles {
  std::vector<std::string> images;
  std::string settings = {};  ///< a further file that must not be overwritten; empty: none
  std::string output;
  double unit_mm = 1.0;
};

/// What change_depth_images() did.
struct DepthImageSummary {
  std::size_t pixels = 0;  ///< of all images that were read
  std::size_t pixels_with_depth = 0;
  std::size_t written_pixels = 0;  ///< of all images that were written
  std::size_t written_pixels_with_depth = 0;
  std::vector<std::string> files;
};

DepthImage load_depth_image(const std::string& path) {
  GreyImage grey = load_grey_image(path);
  if (grey.max_level != std::numeric_limits<std::uint16_t>::max()) {
    throw Error({path, "a PNG of 8 bits", "a depth image of 16 bits, 0 for none",
                 "write depths with 'glidar render -o NAME.depth.png', for example"});
  }
  return {grey.width, grey.height, std::move(grey.level)};
}

bool writes_folder(const DepthImageFiles& files) {
  std::error_code error;
  return files.images.size() > 1 || files.output.ends_with('/') ||
         fs::is_directory(files.output, error);
}

/// The output of each image.
std::vector<std::string> output_names(const DepthImageFiles& files) {
  if (!writes_folder(files)) return {files.output};
  std::vector<std::string> names;
  std::set<std::string> known;
  for (const std::string& image : files.images) {
    const fs::path name = fs::path(files.output) / fs::path(image).filename();
    if (!known.insert(name.string()).second) {
      throw Error({"--output " + files.output,
                   "two images have the name " + name.filename().string(),
                   "images with different names", "take the images of each folder by themselves"});
    }
    names.push_back(name.string());
  }
  return names;
}

std::size_t count_depths(const DepthImage& image) {
  const auto holes = std::count(image.depth.begin(), image.depth.end(), std::uint16_t{0});
  return image.depth.size() - static_cast<std::size_t>(holes);
}

void write_depth_image(const DepthImage& image, double unit_mm, AtomicFile& file) {
  write_png({PngKind::grey16, image.width, image.height, std::as_bytes(std::span(image.depth)),
             "depth in units of " + number_text(unit_mm) + " mm, 0: none"},
            file);
  file.finish();
}

double percent(std::size_t part, std::size_t whole) {
  return 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

/// Reads the images in their order, and writes what `change` returns for each, together. Throws
/// Error: no output, an image that is no PNG of 16 bits, two images of one name.
DepthImageSummary change_depth_images(const DepthImageFiles& files,
                                      const std::function<DepthImage(const DepthImage&)>& change) {
  if (files.output.empty()) {
    throw Error({"--output", "there is no -o, so nothing would be written", "",
                 "add -o changed.png, for example"});
  }
  DepthImageSummary summary;
  summary.files = output_names(files);
  std::vector<std::string> read = files.images;
  if (!files.settings.empty()) read.push_back(files.settings);
  StagedFiles staged;
  staged.protect(read);
  if (writes_folder(files)) staged.add_folder(files.output);
  for (std::size_t i = 0; i < files.images.size(); ++i) {
    const DepthImage image = load_depth_image(files.images[i]);
    const DepthImage changed = change(image);
    write_depth_image(changed, files.unit_mm, staged.add(summary.files[i]));
    summary.pixels += image.depth.size();
    summary.pixels_with_depth += count_depths(image);
    summary.written_pixels += changed.depth.size();
    summary.written_pixels_with_depth += count_depths(changed);
  }
  staged.commit();
  return summary;
}

/// "95.0 % of pixels with depth, 99.1 % after filtering" and the files, in two lines.
std::string summary_text(const DepthImageSummary& summary, const std::string& after) {
  std::string text = fmt::format("{:.1f} % of pixels with depth, {:.1f} % after {}\nwrote {}",
                                 percent(summary.pixels_with_depth, summary.pixels),
                                 percent(summary.written_pixels_with_depth, summary.written_pixels),
                                 after, printable_line(summary.files.front()));
  if (summary.files.size() > 1) {
    text += fmt::format(" to {} ({} files)", printable_line(summary.files.back()),
                        summary.files.size());
  }
  return text + "\n";
}

/// The command line of `glidar depth filter`.
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
  glidar depth filter asteroid.depth.png --filter spatial --filter hole_filling -o filtered.png
  glidar depth filter asteroid.depth.png --focal-length-px 430 --baseline-mm 50 -o filtered.png
With your own files:
  glidar depth filter depth_*.png --filter temporal,alpha=0.2,persistence=8 -o filtered/
  glidar depth filter depth_*.png --filter to_disparity,baseline_m=0.05 --filter spatial,delta=8
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

Command add_filter(CLI::App& depth) {
  CLI::App& command =
      *depth.add_subcommand("filter", "Filter depth images as the driver of a camera does");
  const auto flags = std::make_shared<FilterFlags>();
  command.footer(kFilterExamples);
  add_filter_options(command, *flags);
  return [flags] { return run_filter(*flags); };
}

/// The command line of `glidar depth align`.
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

constexpr const char* kDepthExamples =
    R"(What GLIDAR's depth cameras do with their images, for your own images.
Examples:
  glidar depth stereo builtin:dots -o disparity.npy -o status.png
  glidar depth tof builtin:disc -o depth.png
  glidar render builtin:asteroid --sensor D435 -o asteroid.depth.png
  glidar depth filter asteroid.depth.png -o filtered.png
More: glidar depth TOOL --help
Exit codes: 0 done, 2 the images or options are not valid.)";

constexpr const char* kAlignExamples =
    R"(Moves the depths of depth images (PNG of 16 bits, 0 for none) to the pixels of a colour camera.
Pixels that only the colour camera sees have no depth.
Examples:
  glidar render builtin:asteroid --sensor D435 -o asteroid.depth.png
  glidar depth align asteroid.depth.png --cameras examples/d435_cameras.yaml -o aligned.png
With your own files:
  glidar depth align depth_*.png --cameras cameras.yaml --keep-depth -o aligned/

cameras.yaml, with the keys of pinhole optics in sensor files:
  depth: {width: 848, height: 480, fx: 430, fy: 430, cx: 424, cy: 240}
  colour: {width: 1280, height: 720, fx: 920, fy: 920, cx: 640, cy: 360}
  colour_from_depth: {position: [0.015, 0, 0], orientation: {w: 1, x: 0, y: 0, z: 0}}
Exit codes: 0 done, 2 the images or options are not valid.)";

int run_align(const AlignFlags& flags) {
  if (flags.cameras.empty()) {
    throw Error({"--cameras", "there is no file of the cameras", "a YAML file",
                 "add --cameras cameras.yaml; glidar depth align --help shows its keys"});
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

Command add_align(CLI::App& depth) {
  CLI::App& command =
      *depth.add_subcommand("align", "Move depth images to the pixels of a colour camera");
  const auto flags = std::make_shared<AlignFlags>();
  command.footer(kAlignExamples);
  add_align_options(command, *flags);
  return [flags] { return run_align(*flags); };
}

}  // namespace

Command add_depth(CLI::App& program) {
  CLI::App& command = *program.add_subcommand(
      "depth", "Depth from a camera's own images, and filters of depth images");
  command.require_subcommand(1);
  command.footer(kDepthExamples);
  const std::vector<std::pair<std::string, Command>> tools = {
      {"filter", add_filter(command)},
      {"align", add_align(command)},
      {"stereo", add_stereo(command)},
      {"structured-light", add_structured_light(command)},
      {"tof", add_tof(command)}};
  return [tools, &command] {
    const auto chosen = std::find_if(tools.begin(), tools.end(), [&](const auto& tool) {
      return command.got_subcommand(tool.first);
    });
    return chosen->second();
  };
}

}  // namespace glidar::app
