// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/structured_light_files.hpp>

#include <apps/glidar/run/image_files.hpp>
#include <glidar/core/error.hpp>
#include <glidar/io/formats/grey_image_file.hpp>
#include <glidar/io/formats/raw_image_file.hpp>
#include <glidar/io/pictures/png_image.hpp>

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <optional>

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

void write_fringe_status(bool is_png, const DecodedFringes& decoded, AtomicFile& file) {
  const std::span numbers(reinterpret_cast<const std::uint8_t*>(decoded.status.data()),
                          decoded.status.size());
  const ImageSize size = {decoded.width, decoded.height};
  if (!is_png) return write_image_npy(numbers, "|u1", size, file);
  write_colours_png(numbers, kFringeColours, "status of each pixel", size, file);
}

void write_fringe_file(const std::string& path, const MeasuredFringes& measured,
                       double depth_unit_m, AtomicFile& file) {
  const FringeQuantity quantity = fringe_quantity(path);
  const bool is_png = path.ends_with(".png");
  if (quantity == FringeQuantity::status) {
    return write_fringe_status(is_png, measured.decoded, file);
  }
  const ImageSize size = {measured.decoded.width, measured.decoded.height};
  const std::span<const float> values(values_of(quantity, measured));
  if (!is_png) return write_image_npy(values, "<f4", size, file);
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

}  // namespace

void check_fringe_outputs(std::span<const std::string> paths) {
  for (const std::string& path : paths) fringe_quantity(path);
}

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

void add_fringe_files(std::span<const std::string> paths, const MeasuredFringes& measured,
                      double depth_unit_m, StagedFiles& files) {
  for (const std::string& path : paths) {
    AtomicFile& file = files.add(path);
    write_fringe_file(path, measured, depth_unit_m, file);
    file.finish();
  }
}

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

}  // namespace glidar::app
