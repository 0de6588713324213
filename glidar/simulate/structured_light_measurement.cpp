// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/simulate/structured_light_measurement.hpp>

#include <glidar/math/constants.hpp>
#include <glidar/simulate/pattern_images.hpp>
#include <glidar/simulate/projector_occlusion.hpp>

#include <cmath>
#include <optional>
#include <utility>

namespace glidar {
namespace {

constexpr std::size_t kFringePixelsPerTask = 1024;

/// Decodes raw images, which keep their grey levels.
DecodedFringes decode(const Simulation& s, const StructuredLight& setup,
                      std::vector<RawImage>& images) {
  std::vector<GreyImage> levels;
  levels.reserve(images.size());
  for (RawImage& image : images) levels.push_back(std::move(image.grey));
  DecodedFringes decoded =
      decode_fringes(levels, setup.patterns, setup.decoding, &s.renderer.thread_pool());
  for (std::size_t i = 0; i < images.size(); ++i) images[i].grey = std::move(levels[i]);
  return decoded;
}

/// The pixel of the projector's image from which a surface would be lit; empty: none.
std::optional<Eigen::Vector2d> true_pixel(const Simulation& s,
                                          const PreparedStructuredLight& prepared, std::size_t i) {
  const Eigen::Vector3d point = s.frame.ground_truth.range_m[i] * s.beams.directions[i];
  return projector_pixel(prepared, point - prepared.projector_m);
}

Status status_of(FringeStatus status) {
  switch (status) {
    case FringeStatus::valid:
      return Status::hit;
    case FringeStatus::saturated:
      return Status::saturated;
    case FringeStatus::low_modulation:
      return Status::low_modulation;
    case FringeStatus::weak_code:
      return Status::weak_code;
    case FringeStatus::inconsistent:
      return Status::inconsistent_code;
    case FringeStatus::outside:
      return Status::outside_projector;
  }
  return Status::inconsistent_code;
}

/// Why a pixel that the decoder gave this status has no depth, by the ground truth.
Status find_cause(const Simulation& s, const PreparedStructuredLight& prepared,
                  FringeStatus decoded, std::size_t i) {
  if (decoded == FringeStatus::saturated) return Status::saturated;
  if (std::isnan(s.beams.directions[i].x())) return Status::invalid_pixel;
  if (s.frame.ground_truth.instance[i] == kInvalidId) return Status::miss;
  if (!true_pixel(s, prepared, i)) return Status::outside_projector;
  if (s.workspace.infrared.unlit[i] != 0) return Status::projector_shadow;
  return status_of(decoded);
}

/// The status of a triangulated depth, and its range.
void set_depth(const Simulation& s, double depth_m, float mean_level, std::size_t i) {
  Frame& frame = s.frame;
  if (std::isnan(depth_m)) return invalidate_return(frame, i, Status::inconsistent_code);
  const double range_m = depth_m / s.beams.directions[i].z();
  const Status status = check_limits(s.prepared.sensor.limits, s.beams, i, range_m);
  if (status != Status::hit) return invalidate_return(frame, i, status);
  frame.status[i] = Status::hit;
  const bool is_surface = frame.ground_truth.instance[i] != kInvalidId;
  frame.return_source[i] = is_surface ? ReturnSource::surface : ReturnSource::mixed_pixel;
  frame.range_m[i] = range_m;
  frame.intensity[i] = mean_level / static_cast<float>(frame.raw_images[0].grey.max_level);
}

/// Ranges and statuses from what was decoded.
void set_returns(const Simulation& s, const PreparedStructuredLight& prepared,
                 const DecodedFringes& decoded) {
  ThreadPool& threads = s.renderer.thread_pool();
  s.frame.return_source.assign(s.beams.size(), ReturnSource::none);
  const std::vector<float> depth_m = triangulate(decoded, prepared.setup, s.beams, &threads);
  const auto is_hole = [&](std::size_t i) { return decoded.status[i] != FringeStatus::valid; };
  find_hidden(s, prepared.projector_m, EntryFilter(is_hole), s.workspace.infrared.unlit);
  const auto set_pixel = [&](std::size_t i) {
    if (!is_hole(i)) return set_depth(s, double{depth_m[i]}, decoded.mean_level[i], i);
    invalidate_return(s.frame, i, find_cause(s, prepared, decoded.status[i], i));
  };
  const auto set = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) set_pixel(i);
  };
  threads.parallel_for(depth_m.size(), kFringePixelsPerTask, set);
}

/// A pixel of all images.
std::vector<GreyImage> pixel_images(const std::vector<RawImage>& images, std::size_t pixel) {
  std::vector<GreyImage> result;
  for (const RawImage& image : images) {
    result.push_back({1, 1, image.grey.max_level, {image.grey.level[pixel]}});
  }
  return result;
}

}  // namespace

void measure(const Simulation& s, const PreparedStructuredLight& prepared) {
  s.frame.raw_images = take_pattern_images(s, prepared);
  DecodedFringes decoded = decode(s, prepared.setup, s.frame.raw_images);
  set_returns(s, prepared, decoded);
  s.frame.projector_px = std::move(decoded.coordinate_px);
}

StructuredLightPixelTrace trace_pixel(const Simulation& s, const PreparedStructuredLight& prepared,
                                      std::size_t pixel) {
  const std::vector<RawImage>& images = s.frame.raw_images;
  StructuredLightPixelTrace trace{.exposure = s.workspace.infrared.exposure};
  for (const RawImage& image : images) trace.electrons.push_back(double{image.electrons[pixel]});
  const auto lit_by = true_pixel(s, prepared, pixel);
  const int axis = axis_index(prepared.camera.patterns);
  trace.true_projector_px = lit_by ? (*lit_by)[axis] : kNaN;
  trace.decoded = explain_fringes(pixel_images(images, pixel), prepared.setup.patterns,
                                  prepared.setup.decoding, {0, 0});
  trace.decoded.column = static_cast<std::uint32_t>(pixel % s.beams.cols);
  trace.decoded.row = static_cast<std::uint32_t>(pixel / s.beams.cols);
  return trace;
}

}  // namespace glidar
