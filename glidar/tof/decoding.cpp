// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/tof/decoding.hpp>

#include <glidar/core/error.hpp>
#include <glidar/math/constants.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace glidar::tof {
namespace {

void require_size(const char* where, std::size_t found, std::size_t needed) {
  if (found == 0 || found == needed) return;
  throw Error(
      {where, "has " + std::to_string(found) + " numbers",
       std::to_string(needed) + ", one for each pixel" + (needed == 0 ? "" : " of the raw images"),
       ""});
}

void require_images(const TofImages& images, const TofOptions& options) {
  if (images.frequencies != options.frequencies_hz.size() || images.taps != options.taps) {
    throw Error({"raw images",
                 "there are " + std::to_string(images.frequencies) + " frequencies with " +
                     std::to_string(images.taps) + " phase steps",
                 "as the options: " + std::to_string(options.frequencies_hz.size()) + " with " +
                     std::to_string(options.taps),
                 ""});
  }
  constexpr std::size_t kMaxPixels = std::size_t{1} << 26U;
  const std::size_t pixels = pixel_count(images);
  if (pixels == 0 || pixels > kMaxPixels) {
    throw Error(
        {"raw images",
         "have " + std::to_string(images.width) + "x" + std::to_string(images.height) + " pixels",
         "1 to " + std::to_string(kMaxPixels), ""});
  }
  const std::size_t needed = pixels * images.frequencies * images.taps;
  if (images.level.size() == needed) return;
  throw Error({"raw images", "have " + std::to_string(images.level.size()) + " values",
               std::to_string(needed) + ": frequencies x steps x pixels", ""});
}

void require_calibration(const TofCalibration& calibration, const TofImages& images) {
  const std::size_t pixels = pixel_count(images);
  require_size("depth_per_range", calibration.depth_per_range.size(), pixels);
  require_size("phase_offset_rad", calibration.phase_offset_rad.size(),
               pixels * images.frequencies);
  require_size("is_illuminated", calibration.is_illuminated.size(), pixels);
}

void resize(const PhasorImage& phasors, Decoding& decoding) {
  const std::size_t pixels = phasors.pixels();
  decoding.depths = {phasors.width, phasors.height, std::vector<double>(pixels),
                     std::vector<double>(pixels)};
  TofMeasurement& result = decoding.measurement;
  result.width = static_cast<std::uint32_t>(phasors.width);
  result.height = static_cast<std::uint32_t>(phasors.height);
  result.frequencies = static_cast<std::uint32_t>(phasors.frequencies);
  result.range_m.resize(pixels);
  result.status.resize(pixels);
  result.amplitude.resize(pixels * phasors.frequencies);
  result.phase_rad.resize(pixels * phasors.frequencies);
  result.misfit_rad.resize(pixels);
}

/// The result of a pixel without the tests of edges.
void store(const PixelEvidence& pixel, const TofOptions& options, std::size_t i,
           Decoding& decoding) {
  TofMeasurement& result = decoding.measurement;
  const std::size_t pixels = result.status.size();
  const TofStatus status = find_status(pixel, options);
  result.status[i] = status;
  result.range_m[i] = status == TofStatus::valid ? pixel.unwrapped.range_m : kNaN;
  for (std::size_t f = 0; f < result.frequencies; ++f) {
    result.amplitude[f * pixels + i] = static_cast<float>(pixel.amplitude[f]);
    result.phase_rad[f * pixels + i] = static_cast<float>(kTwoPi * pixel.turns[f]);
  }
  const bool has_phases = status != TofStatus::not_illuminated && status != TofStatus::saturated &&
                          status != TofStatus::low_signal;
  result.misfit_rad[i] = has_phases ? static_cast<float>(pixel.unwrapped.misfit_rad) : kNaNf;
  decoding.depths.amplitude_sum[i] = pixel.amplitude_sum;
  decoding.depths.depth_m[i] = has_phases && has_fit(pixel) ? pixel.depth_m : 0.0;
}

void test_edges(const TofOptions& options, ThreadPool* pool, Decoding& decoding) {
  if (!options.edge_test && !options.filter) return;
  TofMeasurement& result = decoding.measurement;
  for_each_row(pool, result.height, [&](std::size_t row) {
    for (std::size_t i = row * result.width; i < (row + 1) * result.width; ++i) {
      if (result.status[i] != TofStatus::valid) continue;
      const EdgeEvidence edge = gather_edge_evidence(decoding.depths, decoding.phasors, options, i);
      if (!is_depth_edge(edge, options) && !is_phase_edge(edge, options)) continue;
      result.status[i] = TofStatus::edge;
      result.range_m[i] = kNaN;
    }
  });
}

}  // namespace

Decoding decode(const TofImages& images, const TofOptions& options,
                const TofCalibration& calibration, ThreadPool* pool) {
  validate(options);
  require_images(images, options);
  require_calibration(calibration, images);
  Decoding decoding;
  decoding.unwrapping = make_unwrapping(options);
  decoding.phasors = make_phasors(images, options, calibration, pool);
  if (options.filter) decoding.phasors = smooth(decoding.phasors, *options.filter, pool);
  resize(decoding.phasors, decoding);
  for_each_row(pool, images.height, [&](std::size_t row) {
    for (std::size_t i = row * images.width; i < (row + 1) * images.width; ++i) {
      store(gather_evidence(decoding.phasors, decoding.unwrapping, options, calibration, i),
            options, i, decoding);
    }
  });
  test_edges(options, pool, decoding);
  return decoding;
}

}  // namespace glidar::tof
