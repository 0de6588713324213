// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/tof_files.hpp>

#include <apps/glidar/run/image_files.hpp>
#include <glidar/core/error.hpp>
#include <glidar/io/files/staged_files.hpp>

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace glidar::app {
namespace {

constexpr std::array<Colour, kTofStatusCount> kTofColours = {{{235, 235, 235},
                                                              {110, 110, 110},
                                                              {240, 200, 40},
                                                              {30, 30, 30},
                                                              {230, 120, 30},
                                                              {60, 140, 90},
                                                              {130, 70, 160},
                                                              {40, 90, 200}}};

ImageSize size_of(const TofMeasurement& measured) {
  return {measured.width, measured.height};
}

/// Ranges, or depths along the boresight; NaN where there is none.
std::vector<float> lengths_of(const TofResult& result, bool is_depth) {
  std::vector<float> lengths;
  lengths.reserve(result.measured.range_m.size());
  for (std::size_t i = 0; i < result.measured.range_m.size(); ++i) {
    const bool is_scaled = is_depth && !result.depth_per_range.empty();
    const double cosine = is_scaled ? double{result.depth_per_range[i]} : 1.0;
    lengths.push_back(static_cast<float>(cosine * result.measured.range_m[i]));
  }
  return lengths;
}

void write_lengths(const std::string& path, const TofResult& result, bool is_depth,
                   AtomicFile& file) {
  const std::vector<float> lengths = lengths_of(result, is_depth);
  if (is_npy(path)) {
    return write_image_npy(std::span<const float>(lengths), "<f4", size_of(result.measured), file);
  }
  write_multiples_png(lengths, result.unit_m,
                      std::string(is_depth ? "depth" : "range") + " in units of " +
                          number_text(result.unit_m) + " m, 0: none",
                      size_of(result.measured), file);
}

void write_amplitude(const std::string& path, const TofMeasurement& measured, AtomicFile& file) {
  const std::size_t pixels = measured.status.size();
  if (is_npy(path)) {
    const std::array<std::size_t, 3> shape = {measured.frequencies, measured.height,
                                              measured.width};
    file.write(npy_header("<f4", shape));
    return file.write(std::as_bytes(std::span(measured.amplitude)));
  }
  std::vector<float> mean(pixels);
  for (std::size_t i = 0; i < pixels; ++i) {
    double sum = 0.0;
    for (std::size_t f = 0; f < measured.frequencies; ++f) {
      sum += double{measured.amplitude[f * pixels + i]};
    }
    mean[i] = static_cast<float>(sum / measured.frequencies);
  }
  write_multiples_png(mean, 1.0, "amplitude, mean of the frequencies, in units of the raw values",
                      size_of(measured), file);
}

void write_status(const std::string& path, const TofMeasurement& measured, AtomicFile& file) {
  const std::span values(reinterpret_cast<const std::uint8_t*>(measured.status.data()),
                         measured.status.size());
  if (is_npy(path)) return write_image_npy(values, "|u1", size_of(measured), file);
  write_colours_png(values, kTofColours, "status of each pixel", size_of(measured), file);
}

void write_quantity(const std::string& path, const TofResult& result, AtomicFile& file) {
  switch (tof_quantity(path)) {
    case TofQuantity::depth:
      return write_lengths(path, result, true, file);
    case TofQuantity::range:
      return write_lengths(path, result, false, file);
    case TofQuantity::amplitude:
      return write_amplitude(path, result.measured, file);
    case TofQuantity::status:
      return write_status(path, result.measured, file);
  }
}

}  // namespace

TofQuantity tof_quantity(const std::string& path) {
  const std::filesystem::path file(path);
  const std::string stem = file.stem().string();
  if (file.extension() == ".png" || file.extension() == ".npy") {
    if (stem.ends_with("depth")) return TofQuantity::depth;
    if (stem.ends_with("range")) return TofQuantity::range;
    if (stem.ends_with("amplitude")) return TofQuantity::amplitude;
    if (stem.ends_with("status")) return TofQuantity::status;
  }
  throw Error({"--output, " + path, "its name does not state what to write",
               "names ending in depth, range, amplitude or status, and .png or .npy",
               "use a name such as depth.png or wall_range.npy"});
}

void write_tof_files(std::span<const std::string> paths, std::span<const std::string> read,
                     const TofResult& result) {
  StagedFiles files;
  files.protect(read);
  for (const std::string& path : paths) {
    AtomicFile& file = files.add(path);
    write_quantity(path, result, file);
    file.finish();
  }
  files.commit();
}

}  // namespace glidar::app
