// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/commands/commands.hpp>
#include <apps/glidar/options/option_group.hpp>
#include <apps/glidar/options/option_values.hpp>
#include <apps/glidar/run/exit_code.hpp>
#include <apps/glidar/run/image_files.hpp>
#include <apps/glidar/run/printing.hpp>
#include <apps/glidar/run/status_shares.hpp>
#include <glidar/core/error.hpp>
#include <glidar/depth_camera/structured_light.hpp>
#include <glidar/io/config/structured_light_file.hpp>
#include <glidar/io/files/staged_files.hpp>
#include <glidar/io/formats/grey_image_file.hpp>
#include <glidar/io/formats/raw_image_file.hpp>
#include <glidar/io/pictures/png_image.hpp>
#include <glidar/math/constants.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include <array>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace glidar::app {
namespace {

namespace fs = std::filesystem;

enum class FringeQuantity { depth, coordinate, phase, modulation, status };

constexpr std::array<Colour, kFringeStatusCount> kFringeColours = {{{235, 235, 235},
                                                                    {240, 200, 40},
                                                                    {30, 30, 30},
                                                                    {225, 110, 40},
                                                                    {50, 110, 200},
                                                                    {150, 90, 200}}};

std::optional<FringeQuantity> quantity_named(const std::string& stem) {
  if (stem.ends_with("depth")) return FringeQuantity::depth;
  if (stem.ends_with("coordinate")) return FringeQuantity::coordinate;
  if (stem.ends_with("phase")) return FringeQuantity::phase;
  if (stem.ends_with("modulation")) return FringeQuantity::modulation;
  if (stem.ends_with("status")) return FringeQuantity::status;
  return {};
}

FringeQuantity fringe_quantity(const std::string& path) {
  const fs::path file(path);
  const std::optional<FringeQuantity> quantity = quantity_named(file.stem().string());
  const bool has_png = quantity == FringeQuantity::depth || quantity == FringeQuantity::status;
  if (quantity && (file.extension() == ".npy" || (file.extension() == ".png" && has_png))) {
    return *quantity;
  }
  throw Error(
      {"--output, " + path, "its name does not state what to write",
       "names ending in depth, coordinate, phase, modulation or status, and .npy; depth and "
       "status also .png",
       "use a name such as depth.png or part_phase.npy"});
}

const std::vector<float>& values_of(FringeQuantity quantity, const MeasuredFringes& measured) {
  if (quantity == FringeQuantity::depth) return measured.depth_m;
  if (quantity == FringeQuantity::coordinate) return measured.decoded.coordinate_px;
  if (quantity == FringeQuantity::phase) return measured.decoded.phase_rad;
  return measured.decoded.modulation;
}

void write_fringe_file(const std::string& path, const MeasuredFringes& measured,
                       double depth_unit_m, AtomicFile& file) {
  const FringeQuantity quantity = fringe_quantity(path);
  const ImageSize size = {measured.decoded.width, measured.decoded.height};
  if (quantity == FringeQuantity::status) {
    return write_status_image(path, measured.decoded.status, kFringeColours, size, file);
  }
  const std::span<const float> values(values_of(quantity, measured));
  if (is_npy(path)) return write_image_npy(values, "<f4", size, file);
  write_multiples_png(values, depth_unit_m,
                      "depth in units of " + number_text(depth_unit_m) + " m, 0: none", size, file);
}

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

/// Throws Error unless every name states its content: depth, coordinate, phase, modulation or
/// status, and .npy, or .png of depth and status.
void check_fringe_outputs(std::span<const std::string> paths) {
  for (const std::string& path : paths) fringe_quantity(path);
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

/// Writes all outputs. Throws Error.
void add_fringe_files(std::span<const std::string> paths, const MeasuredFringes& measured,
                      double depth_unit_m, StagedFiles& files) {
  for (const std::string& path : paths) {
    AtomicFile& file = files.add(path);
    write_fringe_file(path, measured, depth_unit_m, file);
    file.finish();
  }
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

/// The command line of `glidar structured-light`.
struct StructuredLightFlags {
  std::string setup;
  std::vector<std::string> images;
  std::vector<std::string> outputs;
  std::string pattern_folder;  ///< empty: no patterns are written
  double depth_unit_mm = 0.1;
  unsigned threads = 0;
  bool quiet = false;
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
  const OptionGroup output(command, "Output");
  output.add_repeatable("-o,--output", "FILE",
                        "Name that states the content, such as depth.npy; see below",
                        [&flags](const std::string& path) { flags.outputs.push_back(path); });
  output.add("--depth-unit-mm", "MM", "Unit of depth images [0.1]", flags.depth_unit_mm,
             number(kAboveZero, kFinite, "a finite number above 0"));
  output.add("--patterns", "FOLDER", "Write the images to be projected: pattern_00.png ...",
             flags.pattern_folder);
  const OptionGroup run(command, "Run");
  run.add("-j,--threads", "N", "Number of threads; 0: one per processor [0]", flags.threads,
          whole<unsigned>(0, 4096));
  run.add_flag("-q,--quiet", "No summary, only warnings", flags.quiet);
}

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
