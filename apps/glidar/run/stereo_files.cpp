// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/stereo_files.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/files/staged_files.hpp>
#include <glidar/io/formats/npy_file.hpp>
#include <glidar/io/pictures/png_image.hpp>

#include <array>
#include <cmath>
#include <filesystem>
#include <vector>

namespace glidar::app {
namespace {

constexpr double kMaxPngNumber = 65535.0;

bool is_npy(const std::string& path) {
  return path.ends_with(".npy");
}

template <class T>
void write_stereo_npy(std::span<const T> values, const char* type, const StereoMatch& match,
                      AtomicFile& file) {
  const std::array<std::size_t, 2> shape = {match.height, match.width};
  file.write(npy_header(type, shape));
  file.write(std::as_bytes(values));
}

/// Multiples of `unit`, 0 for none and for those beyond 16 bits.
void write_png16(std::span<const float> values, double unit, const std::string& description,
                 const StereoMatch& match, AtomicFile& file) {
  std::vector<std::uint16_t> pixels;
  pixels.reserve(values.size());
  for (const float value : values) {
    const double number = std::round(static_cast<double>(value) / unit);
    const bool fits = number > 0.0 && number <= kMaxPngNumber;
    pixels.push_back(fits ? static_cast<std::uint16_t>(number) : std::uint16_t{0});
  }
  write_png(
      {PngKind::grey16, match.width, match.height, std::as_bytes(std::span(pixels)), description},
      file);
}

void write_depth(const std::string& path, const StereoMatch& match, const StereoGeometry& geometry,
                 AtomicFile& file) {
  const std::vector<float> depth_m = stereo_depth_m(match, geometry);
  if (is_npy(path)) return write_stereo_npy(std::span<const float>(depth_m), "<f4", match, file);
  write_png16(depth_m, geometry.depth_unit_m,
              "depth in units of " + number_text(geometry.depth_unit_m) + " m, 0: none", match,
              file);
}

void write_disparity(const std::string& path, const StereoMatch& match, AtomicFile& file) {
  const std::span<const float> disparity(match.disparity_px);
  if (is_npy(path)) return write_stereo_npy(disparity, "<f4", match, file);
  write_png16(disparity, 1.0 / 32.0, "disparity in units of 1/32 px, 0: none", match, file);
}

void write_status(const std::string& path, const StereoMatch& match, AtomicFile& file) {
  if (is_npy(path)) {
    const auto* const values = reinterpret_cast<const std::uint8_t*>(match.status.data());
    return write_stereo_npy(std::span(values, match.status.size()), "|u1", match, file);
  }
  Picture picture = make_picture(match.width, match.height, Colour{});
  for (std::size_t i = 0; i < match.status.size(); ++i) {
    picture.pixels[i] = status_colour(match.status[i]);
  }
  write_png(picture, "status of each pixel", file);
}

}  // namespace

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

Colour status_colour(StereoStatus status) {
  static constexpr std::array<Colour, kStereoStatusCount> kColours = {{{235, 235, 235},
                                                                       {110, 110, 110},
                                                                       {30, 30, 30},
                                                                       {240, 200, 40},
                                                                       {150, 90, 200},
                                                                       {225, 110, 40},
                                                                       {50, 110, 200}}};
  return kColours[static_cast<std::size_t>(status)];
}

void write_stereo_files(std::span<const std::string> paths, std::span<const std::string> read,
                        const StereoMatch& match, const StereoGeometry& geometry) {
  StagedFiles files;
  files.protect(read);
  for (const std::string& path : paths) {
    AtomicFile& file = files.add(path);
    const StereoQuantity quantity = stereo_quantity(path);
    if (quantity == StereoQuantity::depth) write_depth(path, match, geometry, file);
    if (quantity == StereoQuantity::disparity) write_disparity(path, match, file);
    if (quantity == StereoQuantity::status) write_status(path, match, file);
    file.finish();
  }
  files.commit();
}

}  // namespace glidar::app
