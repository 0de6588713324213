// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/commands/depth.hpp>
#include <apps/glidar/options/option_group.hpp>
#include <apps/glidar/run/console.hpp>
#include <glidar/core/error.hpp>
#include <glidar/depth_camera/structured_light.hpp>
#include <glidar/io/config/depth_camera_files.hpp>
#include <glidar/io/formats/grey_image_file.hpp>
#include <glidar/io/formats/raw_image_file.hpp>
#include <glidar/io/pictures/picture.hpp>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <array>
#include <bit>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace glidar::app {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 5> kFringeNames = {"depth", "status", "coordinate", "phase",
                                                          "modulation"};
constexpr ImageContents kFringeContents = {kFringeNames, 2};

constexpr std::array<Colour, kFringeStatusCount> kFringeColours = {{{235, 235, 235},
                                                                    {240, 200, 40},
                                                                    {30, 30, 30},
                                                                    {225, 110, 40},
                                                                    {50, 110, 200},
                                                                    {150, 90, 200}}};

void require_size(const std::string& path, const GreyImage& image,
                  const PinholeIntrinsics& camera) {
  if (image.width == camera.width && image.height == camera.height) return;
  throw Error({path, fmt::format("has {}x{} pixels", image.width, image.height),
               fmt::format("{}x{}, as the camera of the setup", camera.width, camera.height),
               "use images of this camera, or change 'width' and 'height' of the setup"});
}

std::string bits_text(const GreyImage& image) {
  return fmt::format("{} bits", std::bit_width(image.max_level));
}

/// The images of the patterns by the camera of `setup`: PNG images in their order, or one NumPy
/// array of them. Throws Error naming the file: it cannot be read, or has another size than the
/// camera, or another type than the first image.
std::vector<GreyImage> load_camera_images(std::span<const std::string> paths,
                                          const StructuredLight& setup) {
  if (paths.size() == 1 && paths.front().ends_with(".npy")) {
    std::vector<GreyImage> images = load_pattern_images(paths.front());
    require_size(paths.front(), images.front(), setup.camera.intrinsics);
    return images;
  }
  std::vector<GreyImage> images;
  for (const std::string& path : paths) {
    images.push_back(load_grey_image(path));
    require_size(path, images.back(), setup.camera.intrinsics);
    if (images.back().max_level == images.front().max_level) continue;
    throw Error({path, bits_text(images.back()),
                 bits_text(images.front()) + ", as " + paths.front(),
                 "use images of the same number of bits"});
  }
  return images;
}

/// Writes pattern_00.png ... to a folder, which is created. Returns their names. Throws Error.
std::vector<std::string> add_patterns(const std::string& folder, const FringePatterns& patterns,
                                      StagedFiles& files) {
  files.add_folder(folder);
  std::vector<std::string> names;
  for (std::size_t i = 0; i < image_count(patterns); ++i) {
    const GreyImage pattern = make_pattern(patterns, i);
    const std::vector<std::uint8_t> levels(pattern.level.begin(), pattern.level.end());
    names.push_back((fs::path(folder) / fmt::format("pattern_{:02}.png", i)).string());
    AtomicFile& file = files.add(names.back());
    write_png({PngKind::grey8, pattern.width, pattern.height, std::as_bytes(std::span(levels)),
               fmt::format("pattern {} of {}", i + 1, image_count(patterns))},
              file);
    file.finish();
  }
  return names;
}

/// The command line of `glidar depth structured-light`.
struct StructuredLightFlags {
  std::string setup;
  std::vector<std::string> images;
  ImageOutputs outputs = {.depth_unit_mm = 0.1};
  std::string pattern_folder;  ///< empty: no patterns are written
};

/// Declares all arguments.
void add_structured_light_options(CLI::App& command, StructuredLightFlags& flags) {
  command.add_option("SETUP", flags.setup, "Camera, projector and patterns (YAML)")
      ->required()
      ->type_name("");
  command
      .add_option("IMAGE", flags.images,
                  "Images of the camera, one for each pattern (.png), or one array of them (.npy)")
      ->type_name("");
  add_output_options(command, kFringeContents, flags.outputs);
  const OptionGroup output(command, "Output");
  output.add("--patterns", "FOLDER", "Write the images to be projected: pattern_00.png ...",
             flags.pattern_folder);
  add_run_options(command, flags.outputs);
}

constexpr const char* kStructuredLightExamples =
    R"(Phase-shifted fringes with a Gray code: writes the images to be projected, and turns the camera's
images of them into depth.
Examples:
  glidar depth structured-light examples/scanner.yaml --patterns patterns/
With your own files, the images in the order of the patterns:
  glidar depth structured-light setup.yaml image_*.png -o depth.npy -o status.png -o phase.npy
With the images of a simulated scanner, as one NumPy array:
  glidar depth structured-light examples/scanner.yaml view.patterns.npy -o depth.npy

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
  check_outputs(flags.outputs, kFringeContents, "--patterns", !flags.pattern_folder.empty());
  if (flags.images.empty() == flags.outputs.paths.empty()) return;
  if (flags.images.empty()) {
    throw Error({"IMAGE", "there are no images to be decoded", "one for each pattern",
                 "add the images in the order of the patterns"});
  }
  throw Error({"--output", "there are images but no output", "", "add -o depth.npy, for example"});
}

void write_fringe_image(const std::string& path, std::string_view content,
                        const ImageOutputs& outputs, const MeasuredFringes& measured,
                        AtomicFile& file) {
  const DecodedFringes& decoded = measured.decoded;
  const ImageSize size = {decoded.width, decoded.height};
  if (content == "status") {
    return write_status_image(path, numbers_of(decoded.status), kFringeColours, size, file);
  }
  if (content == "depth") {
    return write_length_image(path, measured.depth_m, outputs, "depth", size, file);
  }
  write_number_image(path,
                     content == "coordinate" ? decoded.coordinate_px
                     : content == "phase"    ? decoded.phase_rad
                                             : decoded.modulation,
                     1.0, "", size, file);
}

int run_structured_light(const StructuredLightFlags& flags) {
  check_structured_light_flags(flags);
  const StructuredLight setup = load_structured_light(flags.setup);
  MeasuredFringes measured;
  if (!flags.outputs.paths.empty()) {
    ThreadPool pool(flags.outputs.threads);
    measured = measure_fringes(load_camera_images(flags.images, setup), setup, &pool);
  }
  std::vector<std::string> read = flags.images;
  read.push_back(flags.setup);
  StagedFiles files;
  files.protect(read);
  std::vector<std::string> patterns;
  if (!flags.pattern_folder.empty()) {
    patterns = add_patterns(flags.pattern_folder, setup.patterns, files);
  }
  add_images(
      flags.outputs, kFringeContents,
      [&](const std::string& path, std::string_view content, AtomicFile& file) {
        write_fringe_image(path, content, flags.outputs, measured, file);
      },
      files);
  files.commit();
  if (!patterns.empty() && !flags.outputs.quiet) {
    print("wrote {} to {} ({} files)\n", patterns.front(), patterns.back(), patterns.size());
  }
  if (flags.outputs.paths.empty()) return kDone;
  const DecodedFringes& decoded = measured.decoded;
  print_shares(numbers_of(decoded.status), status_names<FringeStatus>(kFringeStatusCount),
               {decoded.width, decoded.height}, flags.outputs);
  return kDone;
}

}  // namespace

Command add_structured_light(CLI::App& depth) {
  CLI::App& command =
      *depth.add_subcommand("structured-light", "Fringe patterns, and depth from images of them");
  const auto flags = std::make_shared<StructuredLightFlags>();
  command.footer(kStructuredLightExamples);
  add_structured_light_options(command, *flags);
  return [flags] { return run_structured_light(*flags); };
}

}  // namespace glidar::app
