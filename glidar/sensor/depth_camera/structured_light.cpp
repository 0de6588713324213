// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/depth_camera/structured_light.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/field_visitor.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/sensor/depth_camera/projector_keys.hpp>
#include <glidar/sensor/optics/projection.hpp>

#include <cmath>
#include <string>

namespace glidar {
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

}  // namespace glidar
