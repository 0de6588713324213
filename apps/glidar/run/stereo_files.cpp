// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/stereo_files.hpp>

#include <apps/glidar/run/image_files.hpp>
#include <glidar/core/error.hpp>
#include <glidar/io/files/staged_files.hpp>

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace glidar::app {
namespace {

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

void write_status(const std::string& path, const StereoMatch& match, AtomicFile& file) {
  const std::span values(reinterpret_cast<const std::uint8_t*>(match.status.data()),
                         match.status.size());
  if (is_npy(path)) return write_image_npy(values, "|u1", size_of(match), file);
  write_colours_png(values, kStereoColours, "status of each pixel", size_of(match), file);
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
