// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/depth_camera/structured_light.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/field_visitor.hpp>
#include <glidar/core/pose_keys.hpp>
#include <glidar/core/sequence_time.hpp>
#include <glidar/depth_camera/fringes.hpp>
#include <glidar/depth_camera/imager.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/math/elementary.hpp>
#include <glidar/sensor/optics/pinhole.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace glidar {
namespace {

constexpr const char* kProjectorKey = "projector";
constexpr const char* kPoseKey = "projector_from_camera";

const ErrorParts& baseline_fault() {
  static const ErrorParts kFault = {kPoseKey, "the projector is at the position of the camera",
                                    "a distance between them, from which depths are triangulated",
                                    "write a position other than [0, 0, 0]"};
  return kFault;
}

bool has_baseline(const Pose& projector_from_camera) {
  return !projector_from_camera.translation().isZero(0.0);
}

}  // namespace

void visit_projector(FieldVisitor& visitor, const char* text, Pinhole& projector,
                     Pose& projector_from_camera, FringePatterns& patterns) {
  visit_object(visitor, {kProjectorKey, text, kNoUnit, kRequired}, projector);
  visit_pose(visitor,
             {kPoseKey, "the camera in the optical frame of the projector", kNoUnit, kRequired},
             true, projector_from_camera);
  if (!visitor.is_reading()) return;
  patterns.width = projector.intrinsics.width;
  patterns.height = projector.intrinsics.height;
  if (std::max(patterns.width, patterns.height) > kPatternSideRule.max) {
    visitor.reject(
        kProjectorKey,
        std::to_string(patterns.width) + "x" + std::to_string(patterns.height) + " pixels",
        "a width and a height of at most " + std::to_string(kPatternSideRule.max),
        "use the size of the projector's image");
  }
  const ErrorParts& fault = baseline_fault();
  if (has_baseline(projector_from_camera)) return;
  visitor.reject(kPoseKey, fault.found, fault.allowed, fault.remedy);
}

void validate_baseline(const std::string& where, const Pose& projector_from_camera) {
  if (has_baseline(projector_from_camera)) return;
  ErrorParts fault = baseline_fault();
  fault.where = where + ", " + fault.where;
  throw Error(fault);
}

namespace {

/// Solid angle of the rectangle from the axis to (x, y) on the plane z = 1, with their signs.
double solid_angle_sr(double x, double y) {
  const double turns = atan2_turns(x * y, std::sqrt(1.0 + x * x + y * y));
  return kTwoPi * (turns > 0.5 ? turns - 1.0 : turns);
}

/// A line with its ends repeated, weighted.
std::vector<float> blurred(const std::vector<double>& line, double blur_px) {
  const std::vector<double> weights = point_spread_weights(1, blur_px);
  const auto radius = static_cast<std::ptrdiff_t>(weights.size() / 2);
  const std::ptrdiff_t last = static_cast<std::ptrdiff_t>(line.size()) - 1;
  std::vector<float> result;
  result.reserve(line.size());
  for (std::ptrdiff_t i = 0; i <= last; ++i) {
    double sum = 0.0;
    for (std::ptrdiff_t k = -radius; k <= radius; ++k) {
      const std::ptrdiff_t from = std::clamp<std::ptrdiff_t>(i + k, 0, last);
      sum += weights[static_cast<std::size_t>(k + radius)] * line[static_cast<std::size_t>(from)];
    }
    result.push_back(static_cast<float>(sum));
  }
  return result;
}

}  // namespace

void describe(ProjectorLight& light, FieldVisitor& visitor) {
  visitor.number({"power_w", "optical power of an image of the greatest level, W"}, kLightPowerRule,
                 light.power_w);
  visitor.number({"gamma",
                  "light of a level: level^gamma, both as shares of the greatest; `patterns.gamma` "
                  "compensates it"},
                 {0.1, 10.0, false, "a number from 0.1 to 10"}, light.gamma);
  visitor.number(
      {"blur_px", "standard deviation of its point spread, in pixels of the projector", kUnitPixel},
      {0.0, 20.0, false, "pixels from 0 to 20"}, light.blur_px);
  visitor.number({"speckle_contrast",
                  "standard deviation over mean of the light that speckle changes in every image"},
                 kZeroToOne, light.speckle_contrast);
}

double white_intensity_w_per_sr(const Pinhole& projector, double power_w) {
  const PinholeIntrinsics& k = projector.intrinsics;
  const double edge = k.pixel_centre - 0.5;  // of the first pixel
  const double left = (edge - k.cx) / k.fx;
  const double right = (k.width + edge - k.cx) / k.fx;
  const double top = (edge - k.cy) / k.fy;
  const double bottom = (k.height + edge - k.cy) / k.fy;
  return power_w / (solid_angle_sr(right, bottom) - solid_angle_sr(left, bottom) -
                    solid_angle_sr(right, top) + solid_angle_sr(left, top));
}

std::vector<float> projected_line(const FringePatterns& patterns, const ProjectorLight& light,
                                  std::size_t image) {
  std::vector<double> line;
  for (const std::uint16_t level : pattern_line(patterns, image)) {
    const double share = level / kMaxPatternLevel;
    line.push_back(light.gamma == 1.0 ? share : portable_pow(share, light.gamma));
  }
  return blurred(line, light.blur_px);
}

namespace {

constexpr std::size_t kPixelsPerTask = 4096;
constexpr int kMaxSecantSteps = 50;
/// In pixels of the projector; a hundredth of what float stores of a coordinate of 1000.
constexpr double kConvergedPlace_px = 1e-7;

/// Along one ray of the camera.
struct Ray {
  const PinholeProjection& projection;
  Eigen::Vector3d origin;     ///< of the camera in the projector's frame
  Eigen::Vector3d direction;  ///< per metre of depth, in the projector's frame
  int axis;                   ///< 0: columns, 1: rows
};

/// Depth at which the ray crosses the plane of this coordinate, without lens distortion.
double plane_depth_m(const Ray& ray, double plane) {
  return (plane * ray.origin.z() - ray.origin[ray.axis]) /
         (ray.direction[ray.axis] - plane * ray.direction.z());
}

double place_error(const Ray& ray, double depth_m, double coordinate_px) {
  const auto pixel = ray.projection.pixel_of(ray.origin + depth_m * ray.direction);
  return pixel ? (*pixel)[ray.axis] - coordinate_px : kNaN;
}

/// With the projector's distortion, by the secant method from the depth without it.
double distorted_depth_m(const Ray& ray, double start_m, double coordinate_px) {
  double last_m = start_m;
  double last_error = place_error(ray, last_m, coordinate_px);
  double depth_m = start_m * 1.001;
  for (int step = 0; step < kMaxSecantSteps; ++step) {
    const double error = place_error(ray, depth_m, coordinate_px);
    if (std::abs(error) <= kConvergedPlace_px) return depth_m;
    const double next_m = depth_m - error * (depth_m - last_m) / (error - last_error);
    last_m = depth_m;
    last_error = error;
    depth_m = next_m;
    if (!(depth_m > 0.0) || !std::isfinite(depth_m)) break;
  }
  return kNaN;
}

double plane_of(const PinholeIntrinsics& k, int axis, double coordinate_px) {
  return axis == 0 ? (coordinate_px + k.pixel_centre - k.cx) / k.fx
                   : (coordinate_px + k.pixel_centre - k.cy) / k.fy;
}

double ray_depth_m(const Ray& ray, const Pinhole& projector, double coordinate_px) {
  const double start_m =
      plane_depth_m(ray, plane_of(projector.intrinsics, ray.axis, coordinate_px));
  if (!(start_m > 0.0) || std::isinf(start_m)) return kNaN;
  if (!is_perspective(projector)) {
    return distorted_depth_m(ray, start_m, coordinate_px);
  }
  const bool is_in_front = ray.origin.z() + start_m * ray.direction.z() > 0.0;
  return is_in_front ? start_m : kNaN;
}

void require_size(const DecodedFringes& decoded, const PinholeIntrinsics& camera) {
  if (decoded.width == camera.width && decoded.height == camera.height) return;
  throw Error(
      {"structured light",
       "the images have " + std::to_string(decoded.width) + "x" + std::to_string(decoded.height) +
           " pixels",
       std::to_string(camera.width) + "x" + std::to_string(camera.height) + ", as the camera", ""});
}

}  // namespace

void describe(StructuredLight& setup, FieldVisitor& visitor) {
  visit_object(visitor, {"camera", "as `optics` of a sensor", kNoUnit, kRequired}, setup.camera);
  visit_projector(
      visitor,
      "as `optics` of a sensor: a camera reversed; its width and height, at most 16384, "
      "are those of the patterns",
      setup.projector, setup.projector_from_camera, setup.patterns);
  visit_object(visitor, {"patterns", "the projected images"}, setup.patterns);
  visit_object(visitor, {"decoding", "thresholds of the decoder"}, setup.decoding);
}

std::vector<float> triangulate(const DecodedFringes& decoded, const StructuredLight& setup) {
  return triangulate(decoded, setup, make_beams(setup.camera), nullptr);
}

std::vector<float> triangulate(const DecodedFringes& decoded, const StructuredLight& setup,
                               const Beams& camera_rays, ThreadPool* pool) {
  require_size(decoded, setup.camera.intrinsics);
  const PinholeProjection projection(setup.projector);
  const int axis = axis_index(setup.patterns);
  const Eigen::Matrix3d rotation = setup.projector_from_camera.linear();
  std::vector<float> depth_m(decoded.coordinate_px.size(), kNaNf);
  const auto find_depth = [&](std::size_t i) {
    const Eigen::Vector3d& direction = camera_rays.directions[i];
    if (std::isnan(decoded.coordinate_px[i]) || !(direction.z() > 0.0)) return;
    const Ray ray = {projection, setup.projector_from_camera.translation(),
                     rotation * (direction / direction.z()), axis};
    depth_m[i] =
        static_cast<float>(ray_depth_m(ray, setup.projector, double{decoded.coordinate_px[i]}));
  };
  const auto find_depths = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) find_depth(i);
  };
  if (pool == nullptr) {
    find_depths(0, depth_m.size());
  } else {
    pool->parallel_for(depth_m.size(), kPixelsPerTask, find_depths);
  }
  return depth_m;
}

namespace {

constexpr std::uint64_t kMaxSequencePixels = std::uint64_t{1} << 28U;  // 1.6 GB

double sequence_s(const StructuredLightCamera& camera) {
  return static_cast<double>(image_count(camera.patterns)) * camera.image_interval_s;
}

constexpr const char* kSequenceAllowed = "seconds from 0 to 4";

bool is_sequence_allowed(const StructuredLightCamera& camera) {
  const double time_s = sequence_s(camera);
  return time_s >= 0.0 && time_s <= kMaxSequence_s;
}

}  // namespace

void describe(StructuredLightCamera& camera, FieldVisitor& visitor) {
  visit_projector(visitor,
                  "as pinhole optics: a camera reversed; its width and height, at most "
                  "16384, are those of the patterns",
                  camera.projector, camera.projector_from_camera, camera.patterns);
  visit_object(visitor, {"light", "of the projector"}, camera.light);
  visit_object(visitor, {"patterns", "the projected images"}, camera.patterns);
  visit_object(visitor, {"decoding", "thresholds of the decoder"}, camera.decoding);
  visit_object(visitor, {"illumination", "other light"}, camera.illumination);
  visit_object(visitor, {"imager", "of the camera"}, camera.imager);
  visitor.whole_number({"sub_rays", "each pixel is the mean of `sub_rays` x `sub_rays` rays"},
                       {1, 16}, camera.sub_rays);
  visitor.number({"image_interval_s",
                  "from the start of an image to the next, while the scene moves", kUnitSecond},
                 kFromZero, camera.image_interval_s);
  if (visitor.is_reading() && !is_sequence_allowed(camera)) {
    visitor.reject("image_interval_s",
                   "{}, so that " + std::to_string(image_count(camera.patterns)) + " images take " +
                       number_text(sequence_s(camera)) + " s",
                   std::string(kSequenceAllowed) + " for all images",
                   "use a shorter interval, or fewer images");
  }
}

StructuredLight setup_of(const StructuredLightCamera& camera, const Pinhole& optics) {
  return {.camera = optics,
          .projector = camera.projector,
          .projector_from_camera = camera.projector_from_camera,
          .patterns = camera.patterns,
          .decoding = camera.decoding};
}

void validate(const StructuredLightCamera& camera) {
  validate(camera.patterns);
  const PinholeIntrinsics& projector = camera.projector.intrinsics;
  if (projector.width != camera.patterns.width || projector.height != camera.patterns.height) {
    throw Error({.where = "structured_light, patterns",
                 .found = "have " + std::to_string(camera.patterns.width) + "x" +
                          std::to_string(camera.patterns.height) + " pixels",
                 .allowed = std::to_string(projector.width) + "x" +
                            std::to_string(projector.height) + ", as the projector",
                 .remedy = ""});
  }
  require_number(is_sequence_allowed(camera),
                 "structured_light, image_interval_s times the number of images",
                 sequence_s(camera), kSequenceAllowed);
  validate_baseline("structured_light", camera.projector_from_camera);
}

void check_image(const StructuredLightCamera& camera, const PinholeIntrinsics& image) {
  const std::size_t images = image_count(camera.patterns);
  const std::uint64_t pixels = std::uint64_t{image.width} * image.height * images;
  if (pixels <= kMaxSequencePixels) return;
  throw Error({.where = "depth_camera, patterns",
               .found = std::to_string(images) + " images of " + std::to_string(image.width) + "x" +
                        std::to_string(image.height) + " pixels",
               .allowed = "at most " + std::to_string(kMaxSequencePixels) + " pixels together",
               .remedy = "use a smaller image, fewer steps, or a longer period"});
}

MeasuredFringes measure_fringes(std::span<const GreyImage> images, const StructuredLight& setup,
                                ThreadPool* pool) {
  MeasuredFringes measured;
  DecodedFringes& decoded = measured.decoded;
  decoded = decode_fringes(images, setup.patterns, setup.decoding, pool);
  measured.depth_m = triangulate(decoded, setup, make_beams(setup.camera), pool);
  for (std::size_t i = 0; i < measured.depth_m.size(); ++i) {
    if (decoded.status[i] != FringeStatus::valid || !std::isnan(measured.depth_m[i])) continue;
    decoded.status[i] = FringeStatus::inconsistent;
    decoded.coordinate_px[i] = kNaNf;
  }
  return measured;
}

FringeTrace explain_fringes(std::span<const GreyImage> images, const StructuredLight& setup,
                            std::array<std::uint32_t, 2> column_row) {
  FringeTrace trace = explain_fringes(images, setup.patterns, setup.decoding, column_row);
  if (trace.status != FringeStatus::valid) return trace;
  DecodedFringes decoded = {images.front().width, images.front().height};
  decoded.coordinate_px.assign(images.front().level.size(), kNaNf);
  const std::size_t pixel = std::size_t{trace.row} * decoded.width + trace.column;
  decoded.coordinate_px[pixel] = static_cast<float>(trace.coordinate_px);
  if (!std::isnan(triangulate(decoded, setup)[pixel])) return trace;
  trace.status = FringeStatus::inconsistent;
  trace.tests.push_back({FringeStatus::inconsistent, false,
                         "the coordinate leads to no depth in front of camera and projector"});
  return trace;
}

}  // namespace glidar
