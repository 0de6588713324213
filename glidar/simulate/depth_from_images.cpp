// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/simulate/depth_from_images.hpp>

#include <glidar/depth_camera/time_of_flight.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/simulate/depth_trace.hpp>
#include <glidar/simulate/infrared_image.hpp>
#include <glidar/simulate/mirrors.hpp>
#include <glidar/simulate/projector_occlusion.hpp>
#include <glidar/simulate/simulation.hpp>
#include <glidar/simulate/tof_light.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace glidar {
namespace {

/// Calls body(i) for all i below `count`, on all threads.
template <class Body>
void for_each_in(const Simulation& s, std::size_t count, std::size_t per_task, const Body& body) {
  s.renderer.thread_pool().parallel_for(count, per_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) body(i);
  });
}

template <class Body>
void for_pixels(const Simulation& s, const Body& body) {
  constexpr std::size_t kPixelsPerTask = 1024;
  for_each_in(s, s.beams.size(), kPixelsPerTask, body);
}

/// Raw values of a pixel.
void expose_pixel(const Simulation& s, const PreparedTof& prepared, std::size_t pixel,
                  TofImages& images) {
  const std::size_t steps = step_count(prepared);
  RngKey key = rng_key(s.frame, Purpose::tof_exposure, pixel);
  for (std::size_t step = 0; step < steps; ++step) {
    key.block = static_cast<std::uint32_t>(step);
    images.level[step * s.beams.size() + pixel] = expose(
        prepared.camera, step / images.taps, s.workspace.tof.light[pixel * steps + step], key);
  }
}

/// Raw values of all pixels and phase steps.
void expose_images(const Simulation& s, const PreparedTof& prepared, TofImages& images) {
  const std::size_t pixels = s.beams.size();
  const std::size_t steps = step_count(prepared);
  images.width = s.beams.cols;
  images.height = s.beams.rows;
  images.frequencies = static_cast<std::uint32_t>(prepared.steps.frequencies);
  images.taps = static_cast<std::uint32_t>(prepared.steps.taps);
  images.level.resize(pixels * steps);
  for_pixels(s, [&](std::size_t i) { expose_pixel(s, prepared, i, images); });
}

Status status_of(TofStatus status, bool is_miss) {
  switch (status) {
    case TofStatus::valid:
      return Status::hit;
    case TofStatus::not_illuminated:
      return Status::invalid_pixel;
    case TofStatus::saturated:
      return Status::saturated;
    case TofStatus::low_signal:
      return is_miss ? Status::miss : Status::below_threshold;
    case TofStatus::ambiguous:
      return is_miss ? Status::miss : Status::phase_ambiguous;
    case TofStatus::too_near:
      return Status::too_near;
    case TofStatus::too_far:
      return Status::too_far;
    case TofStatus::edge:
      return Status::filtered_edge;
  }
  return Status::phase_ambiguous;
}

/// Share of the light of the illuminator that came over bounces.
float bounced_share(const Simulation& s, std::size_t steps, std::size_t pixel) {
  const double signal = s.workspace.tof.light[pixel * steps].signal;
  const double bounced = s.workspace.tof.bounced[pixel];
  return signal > 0.0 ? static_cast<float>(bounced / signal) : 0.0F;
}

/// The mean of the amplitudes of all frequencies.
float mean_amplitude(const TofMeasurement& measured, std::size_t pixels, std::size_t pixel) {
  double sum = 0.0;
  for (std::size_t f = 0; f < measured.frequencies; ++f)
    sum += double{measured.amplitude[f * pixels + pixel]};
  return static_cast<float>(sum / measured.frequencies);
}

/// The return of a pixel.
void set_return(const Simulation& s, const PreparedTof& prepared, const TofMeasurement& measured,
                std::size_t i) {
  Frame& frame = s.frame;
  frame.tof_amplitude[i] = mean_amplitude(measured, s.beams.size(), i);
  frame.bounced_share[i] = bounced_share(s, step_count(prepared), i);
  const bool is_miss = frame.ground_truth.instance[i] == kInvalidId;
  const Status status = status_of(measured.status[i], is_miss);
  if (status != Status::hit) return invalidate_return(frame, i, status);
  frame.status[i] = Status::hit;
  frame.return_source[i] = is_miss ? ReturnSource::false_alarm : ReturnSource::surface;
  frame.range_m[i] = measured.range_m[i];
  frame.intensity[i] = frame.tof_amplitude[i];
}

void set_returns(const Simulation& s, const PreparedTof& prepared, const TofMeasurement& measured) {
  Frame& frame = s.frame;
  const std::size_t pixels = s.beams.size();
  frame.tof_amplitude.resize(pixels);
  frame.bounced_share.resize(pixels);
  frame.return_source.assign(pixels, ReturnSource::none);
  for_pixels(s, [&](std::size_t i) { set_return(s, prepared, measured, i); });
}

TofCalibration calibration_of(const PreparedTof& prepared) {
  return {.depth_per_range = prepared.depth_per_range, .is_illuminated = prepared.is_illuminated};
}

/// Exposes the raw images of a time-of-flight camera and decodes them. See measure_depth().
void measure(const Simulation& s, const PreparedTof& prepared) {
  find_tof_light(s, prepared);
  expose_images(s, prepared, s.frame.tof_images);
  set_returns(s, prepared,
              decode_tof(s.frame.tof_images, prepared.decoder, calibration_of(prepared),
                         {.pool = &s.renderer.thread_pool()}));
}

/// The trace of a pixel that measure() measured last in this workspace.
TofPixelTrace trace_pixel(const Simulation& s, const PreparedTof& prepared, std::size_t pixel) {
  const std::size_t steps = step_count(prepared);
  const auto first = s.workspace.tof.light.begin() + static_cast<std::ptrdiff_t>(pixel * steps);
  const auto row = static_cast<std::uint32_t>(pixel / s.beams.cols);
  const auto column = static_cast<std::uint32_t>(pixel % s.beams.cols);
  return {.light = {first, first + static_cast<std::ptrdiff_t>(steps)},
          .bounced_share = double{s.frame.bounced_share[pixel]},
          .decoded = explain_tof(s.frame.tof_images, prepared.decoder, {column, row},
                                 calibration_of(prepared), {.pool = &s.renderer.thread_pool()})};
}

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
  for_pixels(s, [&](std::size_t i) {
    if (is_hole(i)) return invalidate_return(s.frame, i, find_cause(s, matched[i], i));
    set_depth(s, prepared, i);
  });
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

/// Renders the infrared images of an active stereo camera and matches them. See measure_depth().
void measure(const Simulation& s, const PreparedActiveStereo& prepared) {
  take_images(s, prepared);
  StereoMatch match = match_images(s, prepared.camera);
  s.frame.disparity_px = std::move(match.disparity_px);
  set_returns(s, prepared, match.status);
}

/// Traces a pixel of the frame that measure() measured last in this workspace.
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

template <class Body>
void for_rays(const Simulation& s, const Body& body) {
  constexpr std::size_t kRaysPerTask = 4096;
  for_each_in(s, s.workspace.infrared.projector.size(), kRaysPerTask, body);
}

/// Rates of all pixels in the projector's greatest light, and the coordinate that lights each ray.
void light_scene(const Simulation& s, const PreparedStructuredLight& prepared,
                 std::uint32_t time_ns) {
  const auto white = [&](const Eigen::Vector3d& path) {
    return projector_pixel(prepared, path) ? prepared.white_w_per_sr : 0.0;
  };
  InfraredWorkspace& memory = s.workspace.infrared;
  render_infrared(s,
                  {.imager = prepared.imager,
                   .projector = ProjectorIntensity(white),
                   .projector_m = prepared.projector_m,
                   .time_ns = time_ns},
                  memory.left);
  memory.projector_px.resize(memory.projector.size());
  const int axis = axis_index(prepared.camera.patterns);
  for_rays(s, [&](std::size_t ray) {
    memory.projector_px[ray] = kNaNf;
    if (!(memory.projector[ray] > 0.0F)) return;
    const Eigen::Vector3d point = memory.hits.range_m[ray] * prepared.imager.rays.directions[ray];
    const auto pixel = projector_pixel(prepared, point - prepared.projector_m);
    if (pixel) memory.projector_px[ray] = static_cast<float>((*pixel)[axis]);
  });
}

/// The pixels that the projector lights; all of them where there are none.
ElectronRates lit_pixels(const ElectronRates& rates) {
  ElectronRates lit;
  lit.height = 1;
  for (std::size_t i = 0; i < rates.projector.size(); ++i) {
    if (!(rates.projector[i] > 0.0F)) continue;
    lit.projector.push_back(rates.projector[i]);
    lit.ambient.push_back(rates.ambient[i]);
  }
  lit.width = static_cast<std::uint32_t>(lit.projector.size());
  return lit.width > 0 ? lit : rates;
}

/// Replaces the rates of the projector's light by those of a pattern.
void find_pattern_rates(const Simulation& s, const PreparedStructuredLight& prepared,
                        std::size_t number) {
  InfraredWorkspace& memory = s.workspace.infrared;
  const std::vector<float>& line = prepared.lines[number];
  memory.pattern_radiance.resize(memory.projector.size());
  for_rays(s, [&](std::size_t ray) {
    const float place_px = memory.projector_px[ray];
    const float share = std::isnan(place_px) ? 0.0F : light_at(line, place_px);
    memory.pattern_radiance[ray] = share * memory.projector[ray];
  });
  find_electron_rates(s, prepared.imager, memory.pattern_radiance, memory.left.projector);
}

/// "pattern_07".
std::string image_name(std::size_t number) {
  return std::string("pattern_") + (number < 10 ? "0" : "") + std::to_string(number);
}

/// The raw images of all patterns, "pattern_00", "pattern_01" ...: the surfaces and shadows are
/// cast once, and again for each image only where something moves between the images. The exposure
/// is that of the pixels that the projector lights, in its greatest light and at the time of the
/// first pattern.
std::vector<RawImage> take_pattern_images(const Simulation& s,
                                          const PreparedStructuredLight& prepared) {
  const StructuredLightCamera& camera = prepared.camera;
  InfraredWorkspace& memory = s.workspace.infrared;
  Simulation timed = s;
  timed.is_moving = camera.image_interval_s > 0.0 && moves(s.motion);
  std::vector<RawImage> images;
  for (std::size_t i = 0; i < prepared.lines.size(); ++i) {
    if (i == 0 || timed.is_moving) {
      light_scene(timed, prepared, exposure_time_ns(i, camera.image_interval_s));
    }
    if (i == 0) memory.exposure = find_exposure(camera.imager, lit_pixels(memory.left));
    find_pattern_rates(timed, prepared, i);
    images.push_back(read_image(timed, memory.left,
                                {.imager = camera.imager,
                                 .exposure = memory.exposure,
                                 .speckle_contrast = camera.light.speckle_contrast,
                                 .purpose = Purpose::pattern_image,
                                 .number = i}));
    images.back().name = image_name(i);
  }
  return images;
}

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
  s.frame.return_source.assign(s.beams.size(), ReturnSource::none);
  const std::vector<float> depth_m =
      triangulate(decoded, prepared.setup, s.beams, &s.renderer.thread_pool());
  const auto is_hole = [&](std::size_t i) { return decoded.status[i] != FringeStatus::valid; };
  find_hidden(s, prepared.projector_m, EntryFilter(is_hole), s.workspace.infrared.unlit);
  for_pixels(s, [&](std::size_t i) {
    if (!is_hole(i)) return set_depth(s, double{depth_m[i]}, decoded.mean_level[i], i);
    invalidate_return(s.frame, i, find_cause(s, prepared, decoded.status[i], i));
  });
}

/// A pixel of all images.
std::vector<GreyImage> pixel_images(const std::vector<RawImage>& images, std::size_t pixel) {
  std::vector<GreyImage> result;
  for (const RawImage& image : images) {
    result.push_back({1, 1, image.grey.max_level, {image.grey.level[pixel]}});
  }
  return result;
}

/// Takes the images of all patterns and decodes them. See measure_depth().
void measure(const Simulation& s, const PreparedStructuredLight& prepared) {
  s.frame.raw_images = take_pattern_images(s, prepared);
  DecodedFringes decoded = decode(s, prepared.setup, s.frame.raw_images);
  set_returns(s, prepared, decoded);
  s.frame.projector_px = std::move(decoded.coordinate_px);
}

/// The trace of a pixel that measure() measured last in this workspace.
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

}  // namespace

void measure_depth(const Simulation& s) {
  std::visit([&](const auto& camera) { measure(s, camera); }, *s.prepared.depth_camera);
}

DepthTrace trace_depth(const Simulation& s, std::size_t pixel) {
  return std::visit([&](const auto& camera) -> DepthTrace { return trace_pixel(s, camera, pixel); },
                    *s.prepared.depth_camera);
}

}  // namespace glidar
