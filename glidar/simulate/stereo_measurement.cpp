// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/simulate/stereo_measurement.hpp>

#include <glidar/math/constants.hpp>
#include <glidar/simulate/image_reading.hpp>
#include <glidar/simulate/infrared_image.hpp>
#include <glidar/simulate/mirrors.hpp>
#include <glidar/simulate/projector_occlusion.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace glidar {
namespace {

constexpr std::size_t kReadingsPerTask = 1024;
constexpr float kTransparentOpacity = 0.5F;  ///< surfaces below it are a cause of holes

/// What the left or right image is taken with.
ImageExposure exposure_of(const Simulation& s, const ActiveStereo& camera, Purpose purpose) {
  return {.imager = camera.imager,
          .exposure = s.workspace.infrared.exposure,
          .speckle_contrast = camera.projector.speckle_contrast,
          .purpose = purpose};
}

/// Renders what an imager at this place sees.
void render_view(const Simulation& s, const PreparedActiveStereo& prepared,
                 const Eigen::Vector3d& eye_m, ElectronRates& rates) {
  const auto intensity = [&](const Eigen::Vector3d& path) {
    const bool is_in_front = path.z() > 0.0;
    return is_in_front ? intensity_at(prepared.pattern, path.x() / path.z(), path.y() / path.z())
                       : 0.0;
  };
  render_infrared(s,
                  {.imager = prepared.imager,
                   .projector = ProjectorIntensity(intensity),
                   .projector_m = prepared.camera.projector.origin_m,
                   .eye_m = eye_m},
                  rates);
}

/// The stored picture of the pattern, its brightest pixel at the greatest level.
RawImage pattern_image(const PreparedActiveStereo& prepared) {
  const std::vector<float>& view = prepared.pattern_view;
  const float brightest = *std::max_element(view.begin(), view.end());
  RawImage image{.name = "ir_reference"};
  image.grey = {.width = prepared.imager.size.width,
                .height = prepared.imager.size.height,
                .max_level = (1U << prepared.camera.imager.bits) - 1U};
  image.grey.level.reserve(view.size());
  for (const float intensity : view) {
    const double share = brightest > 0.0F ? double{intensity} / double{brightest} : 0.0;
    image.grey.level.push_back(
        static_cast<std::uint16_t>(std::floor(share * image.grey.max_level + 0.5)));
  }
  return image;
}

/// The left image and what it is matched with.
void take_images(const Simulation& s, const PreparedActiveStereo& prepared) {
  InfraredWorkspace& memory = s.workspace.infrared;
  const ActiveStereo& camera = prepared.camera;
  render_view(s, prepared, Eigen::Vector3d::Zero(), memory.left);
  memory.exposure = find_exposure(camera.imager, memory.left);
  std::vector<RawImage>& images = s.frame.raw_images;
  images.push_back(read_image(s, memory.left, exposure_of(s, camera, Purpose::left_image)));
  images.back().name = "ir_left";
  if (camera.reference == ActiveStereo::Reference::pattern) {
    images.push_back(pattern_image(prepared));
    return;
  }
  render_view(s, prepared, second_origin_m(camera), memory.right);
  images.push_back(read_image(s, memory.right, exposure_of(s, camera, Purpose::right_image)));
  images.back().name = "ir_right";
}

StereoMatch match_images(const Simulation& s, const ActiveStereo& camera) {
  std::optional<StereoMatcher>& matcher = s.workspace.infrared.matcher;
  if (!matcher) matcher.emplace(camera.matcher);
  StereoRun run;
  run.pool = &s.renderer.thread_pool();
  return matcher->match(s.frame.raw_images[0].grey, s.frame.raw_images[1].grey, run);
}

/// Depth of a disparity, in whole units.
double depth_of(const PreparedActiveStereo& prepared, float disparity_px) {
  const double unit_m = prepared.camera.depth_unit_m;
  const double z = prepared.focal_length_px * prepared.camera.baseline_m / double{disparity_px};
  return unit_m > 0.0 ? std::floor(z / unit_m + 0.5) * unit_m : z;
}

/// The status of a matched depth, and its range.
void set_depth(const Simulation& s, const PreparedActiveStereo& prepared, std::size_t i) {
  Frame& frame = s.frame;
  const float disparity_px = frame.disparity_px[i];
  if (!(disparity_px > 0.0F)) return invalidate_return(frame, i, Status::outside_search);
  const double range_m = depth_of(prepared, disparity_px) / s.beams.directions[i].z();
  const Status status = check_limits(s.prepared.sensor.limits, s.beams, i, range_m);
  if (status != Status::hit) return invalidate_return(frame, i, status);
  const GreyImage& image = frame.raw_images[0].grey;
  frame.status[i] = Status::hit;
  frame.range_m[i] = range_m;
  frame.intensity[i] = static_cast<float>(image.level[i]) / static_cast<float>(image.max_level);
}

Status status_of(StereoStatus status) {
  switch (status) {
    case StereoStatus::valid:
      return Status::hit;
    case StereoStatus::border:
      return Status::image_border;
    case StereoStatus::no_texture:
      return Status::no_texture;
    case StereoStatus::saturated:
      return Status::saturated;
    case StereoStatus::out_of_range:
      return Status::outside_search;
    case StereoStatus::ambiguous:
      return Status::ambiguous_match;
    case StereoStatus::left_right:
      return Status::left_right_mismatch;
  }
  return Status::no_texture;
}

/// Why a pixel that the matcher gave this status has no depth, by the ground truth.
Status find_cause(const Simulation& s, StereoStatus matched, std::size_t i) {
  const InfraredWorkspace& memory = s.workspace.infrared;
  const Hits& truth = s.frame.ground_truth;
  if (matched == StereoStatus::border || matched == StereoStatus::saturated) {
    return status_of(matched);
  }
  if (truth.instance[i] == kInvalidId) return Status::miss;
  if (memory.unseen[i] != 0) return Status::occluded;
  if (memory.unlit[i] != 0) return Status::projector_shadow;
  const bool is_transparent = material_hit(s.scene, truth, i).opacity < kTransparentOpacity;
  return is_transparent ? Status::transparent : status_of(matched);
}

/// Ranges and statuses from the match.
void set_returns(const Simulation& s, const PreparedActiveStereo& prepared,
                 const std::vector<StereoStatus>& matched) {
  InfraredWorkspace& memory = s.workspace.infrared;
  const auto is_hole = [&](std::size_t i) { return matched[i] != StereoStatus::valid; };
  find_hidden(s, second_origin_m(prepared.camera), EntryFilter(is_hole), memory.unseen);
  find_hidden(s, prepared.camera.projector.origin_m, EntryFilter(is_hole), memory.unlit);
  const auto set_pixel = [&](std::size_t i) {
    if (is_hole(i)) return invalidate_return(s.frame, i, find_cause(s, matched[i], i));
    set_depth(s, prepared, i);
  };
  const auto set = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) set_pixel(i);
  };
  s.renderer.thread_pool().parallel_for(matched.size(), kReadingsPerTask, set);
}

/// The light of the pixel that shows in the right image what pixel i shows in the left one.
PixelLight right_light(const Simulation& s, double disparity_px, std::size_t i) {
  const ElectronRates& rates = s.workspace.infrared.right;
  const std::size_t column = i % s.frame.cols;
  const double matched = std::round(static_cast<double>(column) - disparity_px);
  if (rates.projector.empty() || !(matched >= 0.0)) return {};  // not for NaN either
  return light_of(rates, s.workspace.infrared.exposure,
                  i - column + static_cast<std::size_t>(matched));
}

}  // namespace

void measure(const Simulation& s, const PreparedActiveStereo& prepared) {
  take_images(s, prepared);
  StereoMatch match = match_images(s, prepared.camera);
  s.frame.disparity_px = std::move(match.disparity_px);
  set_returns(s, prepared, match.status);
}

StereoPixelTrace trace_pixel(const Simulation& s, const PreparedActiveStereo& prepared,
                             std::size_t i) {
  const Frame& frame = s.frame;
  const InfraredWorkspace& memory = s.workspace.infrared;
  const ActiveStereo& camera = prepared.camera;
  StereoPixelTrace trace;
  trace.exposure = memory.exposure;
  trace.light = light_of(memory.left, memory.exposure, i);
  trace.reading = read_pixel(s, memory.left, exposure_of(s, camera, Purpose::left_image), i);
  const double depth = depth_m(s.beams, i, frame.ground_truth.range_m[i]);
  trace.true_disparity_px = prepared.focal_length_px * camera.baseline_m / depth;
  trace.right_light = right_light(s, trace.true_disparity_px, i);
  StereoRun run;
  run.pool = &s.renderer.thread_pool();
  trace.match = explain_stereo(
      frame.raw_images[0].grey, frame.raw_images[1].grey, camera.matcher,
      {static_cast<std::uint32_t>(i % frame.cols), static_cast<std::uint32_t>(i / frame.cols)},
      run);
  return trace;
}

}  // namespace glidar
