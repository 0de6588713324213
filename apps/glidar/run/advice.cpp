// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/advice.hpp>

#include <glidar/math/portable.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace glidar::app {
namespace {

constexpr double kLargeModel_m = 1000.0;
constexpr double kSmallModel_m = 0.001;
constexpr double kLargeRatio = 1000.0;        // between size and distance: a wrong unit
constexpr double kMinBackFaceFraction = 0.9;  // of the hits are on back faces: seen from inside

/// True if neither the user nor the file specifies the unit of a model.
bool has_assumed_unit(const Scene& scene) {
  return std::any_of(scene.instances.begin(), scene.instances.end(), [&](const Instance& instance) {
    return instance.mesh >= scene.sources.size() || !scene.sources[instance.mesh].unit_known;
  });
}

/// The scene's bounding box relative to the sensor.
struct ViewGeometry {
  double size_m = 0.0;        ///< diagonal of the scene's box
  double depth_m = 0.0;       ///< of the box's centre
  double deepest_m = 0.0;     ///< maximum of the box's corners
  double distance_m = 0.0;    ///< to the box's centre
  double off_axis_rad = 0.0;  ///< angle between the boresight and the box's centre
  double view_rad = 0.0;      ///< greatest angle between boresight and a beam
  double pixel_rad = 0.0;     ///< angle between two beams in the middle of the image
};

double angle_rad(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return portable_atan2(a.cross(b).norm(), a.dot(b));
}

double pixel_angle_rad(const Beams& beams) {
  const std::size_t middle = std::size_t{beams.rows / 2} * beams.cols + beams.cols / 2;
  const std::size_t step = beams.cols > 1 ? 1 : beams.cols;
  if (middle < step || beams.size() < 2) return 0.0;
  return angle_rad(beams.directions[middle], beams.directions[middle - step]);
}

/// The bounding box of the scene in this frame, in target coordinates.
Eigen::AlignedBox3d scene_box(const View& view, const Pose& target_from_world) {
  Eigen::AlignedBox3d all;
  for (std::size_t i = 0; i < view.scene.instances.size(); ++i) {
    const Instance& instance = view.scene.instances[i];
    const Eigen::AlignedBox3d box = bounds(view.scene.meshes[instance.mesh]);
    for (int corner = 0; corner < 8 && !box.isEmpty(); ++corner) {
      const auto type = static_cast<Eigen::AlignedBox3d::CornerType>(corner);
      all.extend(target_from_world *
                 (view.frame.world_from_instance[i] * (instance.scale * box.corner(type))));
    }
  }
  return all;
}

ViewGeometry view_geometry(const View& view) {
  const Eigen::AlignedBox3d box = scene_box(view, view.frame.world_from_sensor.inverse());
  const Eigen::Vector3d middle = box.center();
  const Eigen::Vector3d& axis = view.beams.boresight;
  ViewGeometry geometry;
  geometry.size_m = scene_box(view, Pose::Identity()).diagonal().norm();
  geometry.depth_m = middle.dot(axis);
  geometry.deepest_m = -std::numeric_limits<double>::infinity();
  for (int corner = 0; corner < 8; ++corner) {
    const auto type = static_cast<Eigen::AlignedBox3d::CornerType>(corner);
    geometry.deepest_m = std::max(geometry.deepest_m, box.corner(type).dot(axis));
  }
  geometry.distance_m = middle.norm();
  geometry.off_axis_rad = angle_rad(middle, axis);
  for (const Eigen::Vector3d& beam : view.beams.directions) {
    if (!std::isnan(beam.x()))
      geometry.view_rad = std::max(geometry.view_rad, angle_rad(beam, axis));
  }
  geometry.pixel_rad = pixel_angle_rad(view.beams);
  return geometry;
}

double degrees(double angle) {
  return angle * 180.0 / std::numbers::pi;
}

/// The nearest and farthest distance of all surfaces met, reported or not, along the limits' axis.
std::string true_distances(const View& view) {
  double nearest = std::numeric_limits<double>::infinity();
  double farthest = 0.0;
  for (std::size_t i = 0; i < view.beams.size(); ++i) {
    if (view.frame.ground_truth.instance[i] == kInvalidId) continue;
    const double range_m = view.frame.ground_truth.range_m[i];
    const double distance = view.sensor.limits.along == Limits::Along::range
                                ? range_m + view.beams.range_offset_m
                                : depth_m(view.beams, i, range_m);
    nearest = std::min(nearest, distance);
    farthest = std::max(farthest, distance);
  }
  return fmt::format("{:.6g} to {:.6g} m", nearest, farthest);
}

/// How many beams meet a surface that is not reported.
std::size_t undetected_surfaces(const View& view) {
  std::size_t lost = 0;
  for (std::size_t i = 0; i < view.frame.status.size(); ++i) {
    const Status status = view.frame.status[i];
    const bool is_there = view.frame.ground_truth.instance[i] != kInvalidId;
    if (is_there && status != Status::hit && status != Status::miss) ++lost;
  }
  return lost;
}

/// Why there are no hits, and the remedy.
std::string reason_for_no_hits(const View& view, const ViewGeometry& geometry,
                               const FrameSummary& summary) {
  constexpr const char* kFrameIt = "leave the pose options out to frame the scene";
  if (summary.beams == 0) return "the optics have no beam for any pixel; check the distortion";
  if (summary.too_near + summary.too_far > 0) {
    return fmt::format(
        "{} beams hit surfaces outside the sensor's {} limits: they are at {}, the limits are "
        "{} to {} m; change --near and --far",
        summary.too_near + summary.too_far,
        view.sensor.limits.along == Limits::Along::depth ? "depth" : "range", true_distances(view),
        view.sensor.limits.near_m, view.sensor.limits.far_m);
  }
  if (const std::size_t lost = undetected_surfaces(view)) {
    return fmt::format(
        "{} beams meet surfaces, but the received signal is too weak, too strong or dropped: see "
        "the "
        "column 'status', and `glidar explain`",
        lost);
  }
  if (geometry.deepest_m < 0.0 && geometry.view_rad < 0.5 * std::numbers::pi) {
    return fmt::format(
        "the scene is behind the sensor: its centre is {:.6g} m away at depth {:.6g} m; "
        "turn the sensor, or {}",
        geometry.distance_m, geometry.depth_m, kFrameIt);
  }
  const bool around = geometry.distance_m <= 0.5 * geometry.size_m;  // it may surround the sensor
  const double half_size_rad =
      around ? std::numbers::pi : portable_asin(0.5 * geometry.size_m / geometry.distance_m);
  if (geometry.off_axis_rad - half_size_rad > geometry.view_rad) {
    return fmt::format(
        "the scene is outside the view: its centre is {:.1f} degrees off the "
        "boresight, the view extends to {:.1f}; turn the sensor, or {}",
        degrees(geometry.off_axis_rad), degrees(geometry.view_rad), kFrameIt);
  }
  if (2.0 * half_size_rad < 2.0 * geometry.pixel_rad) {
    return fmt::format(
        "the scene is too small for a beam to hit: {:.6g} m across at {:.6g} m is "
        "{:.2g} pixels; move closer, narrow --fov, {}or {}",
        geometry.size_m, geometry.distance_m, 2.0 * half_size_rad / geometry.pixel_rad,
        has_assumed_unit(view.scene) ? "check --unit, " : "", kFrameIt);
  }
  if (view.sensor.cull_back_faces) {
    return "only back faces are visible, and beams pass them with --cull-back-faces; leave it out";
  }
  return fmt::format(
      "no beam meets a triangle, though the scene ({:.6g} m across, {:.6g} m away) "
      "is in front of the sensor; aim elsewhere, or {}",
      geometry.size_m, geometry.distance_m, kFrameIt);
}

/// The fraction of this instance's hits on back faces, from a sample.
double back_face_fraction(const View& view, std::size_t index) {
  constexpr std::size_t kSample = 4096;
  const Instance& instance = view.scene.instances[index];
  const Mesh& mesh = view.scene.meshes[instance.mesh];
  const Eigen::Matrix3d object_from_sensor =
      view.frame.world_from_instance[index].linear().transpose() *
      view.frame.world_from_sensor.linear();
  const std::size_t stride = std::max<std::size_t>(1, view.beams.size() / kSample);
  std::size_t hits = 0;
  std::size_t backs = 0;
  for (std::size_t i = 0; i < view.beams.size(); i += stride) {
    if (view.frame.ground_truth.instance[i] != index) continue;
    const Triangle& t = mesh.triangles[view.frame.ground_truth.primitive[i]];
    const Eigen::Vector3d a = mesh.positions_m[t[0]].cast<double>();
    const Eigen::Vector3d normal = (mesh.positions_m[t[1]].cast<double>() - a)
                                       .cross(mesh.positions_m[t[2]].cast<double>() - a);
    ++hits;
    if (normal.dot(object_from_sensor * view.beams.directions[i]) > 0.0) ++backs;
  }
  return hits == 0 ? 0.0 : static_cast<double>(backs) / static_cast<double>(hits);
}

std::string label(const Instance& instance) {
  return instance.name.empty() ? "the model" : "'" + instance.name + "'";
}

/// Instances whose boxes contain the sensor.
std::vector<std::size_t> boxes_with_sensor(const View& view) {
  std::vector<std::size_t> around;
  for (std::size_t i = 0; i < view.scene.instances.size(); ++i) {
    const Instance& instance = view.scene.instances[i];
    const Eigen::Vector3d position = view.frame.world_from_instance[i].inverse() *
                                     view.frame.world_from_sensor.translation() / instance.scale;
    const Eigen::AlignedBox3d box = bounds(view.scene.meshes[instance.mesh]);
    if (!box.isEmpty() && box.contains(position)) around.push_back(i);
  }
  return around;
}

/// Not for 360 degree sensors, which are meant to be inside scenes, nor for sensors that see front
/// faces.
void add_inside_advice(const View& view, const ViewGeometry& geometry,
                       const std::vector<std::size_t>& around, std::vector<std::string>& advice) {
  if (geometry.view_rad > 0.5 * std::numbers::pi) return;
  for (const std::size_t i : around) {
    if (back_face_fraction(view, i) <= kMinBackFaceFraction) continue;
    advice.push_back(
        fmt::format("the sensor is inside {} and sees the backs of its surfaces; unless it is a "
                    "room, move it out, or leave the pose options out to frame the scene",
                    label(view.scene.instances[i])));
  }
}

/// Suggests a unit only if it is assumed.
void add_ratio_advice(const ViewGeometry& geometry, bool is_unit_assumed,
                      std::vector<std::string>& advice) {
  if (geometry.size_m > kLargeRatio * geometry.distance_m) {
    advice.push_back(fmt::format(
        "the scene is {:.6g} m across but its centre is only {:.6g} m from the sensor; {}",
        geometry.size_m, geometry.distance_m,
        is_unit_assumed ? "if the file is in millimetres, give --unit mm"
                        : "if this is not intended, check the pose and --scale"));
  } else if (geometry.distance_m > kLargeRatio * geometry.size_m) {
    advice.push_back(
        fmt::format("the scene is {:.6g} m across but {:.6g} m from the sensor; if this "
                    "is not intended, check {}--scale and the pose",
                    geometry.size_m, geometry.distance_m, is_unit_assumed ? "--unit, " : ""));
  }
}

/// True if a box from `min` to `max` is on zero or above it.
bool is_on_zero(double min, double max) {
  constexpr double kSunk = 0.02;  // part of its height that may be below
  return max > min && min >= -kSunk * (max - min);
}

/// True if zero is well inside.
bool straddles_zero(double min, double max) {
  constexpr double kMinPart = 0.1;
  const double part = kMinPart * (max - min);
  return min < -part && max > part;
}

/// Wide and low, of many triangles, nearly all of which face up: without an underside.
bool looks_like_terrain(const Scene& scene, const Eigen::Vector3d& size_m) {
  constexpr double kLow = 0.25;
  constexpr std::size_t kFewTriangles = 500;
  constexpr double kUp = 0.9;
  std::size_t triangles = 0;
  std::size_t up = 0;
  for (const Mesh& mesh : scene.meshes) {
    const auto corner = [&](std::uint32_t vertex) { return mesh.positions_m[vertex]; };
    triangles += mesh.triangles.size();
    up += static_cast<std::size_t>(std::ranges::count_if(mesh.triangles, [&](const Triangle& t) {
      return (corner(t[1]) - corner(t[0])).cross(corner(t[2]) - corner(t[0])).z() > 0.0F;
    }));
  }
  return triangles > kFewTriangles &&
         static_cast<double>(up) > kUp * static_cast<double>(triangles) &&
         size_m.z() < kLow * std::min(size_m.x(), size_m.y());
}

}  // namespace

FrameSummary summarise(const Frame& frame) {
  FrameSummary summary{.nearest_m = std::numeric_limits<double>::infinity(), .farthest_m = 0.0};
  for (std::size_t i = 0; i < frame.status.size(); ++i) {
    const Status status = frame.status[i];
    if (status != Status::invalid_pixel) ++summary.beams;
    if (status == Status::too_near) ++summary.too_near;
    if (status == Status::too_far) ++summary.too_far;
    if (status != Status::hit) continue;
    ++summary.hits;
    summary.nearest_m = std::min(summary.nearest_m, frame.range_m[i]);
    summary.farthest_m = std::max(summary.farthest_m, frame.range_m[i]);
  }
  if (summary.hits == 0) summary.nearest_m = summary.farthest_m = std::nan("");
  return summary;
}

std::vector<std::string> size_advice(const Scene& scene, bool sized, double far_m) {
  const Eigen::AlignedBox3d box = bounds(scene);
  if (sized || box.isEmpty() || !has_assumed_unit(scene)) return {};
  const double size_m = box.diagonal().norm();
  constexpr double kSitesPerRange = 10.0;  // a site may be surveyed in so many steps
  const bool fits_range = std::isfinite(far_m) && size_m < kSitesPerRange * far_m;
  if (size_m > kLargeModel_m && !fits_range && !looks_like_terrain(scene, box.sizes())) {
    return {
        fmt::format("the model is {:.6g} m across; if its file is in millimetres, give --unit mm "
                    "({:.6g} m), otherwise --unit m confirms the size",
                    size_m, size_m / 1000.0)};
  }
  if (size_m < kSmallModel_m) {
    return {
        fmt::format("the model is {:.6g} m across; if its file is in kilometres, give --scale "
                    "1000, otherwise --unit m confirms the size",
                    size_m)};
  }
  return {};
}

std::string up_advice(const std::string& format, const Eigen::AlignedBox3d& box) {
  const bool says_nothing_of_up = format.find("PLY") != std::string::npos ||
                                  format.find("STL") != std::string::npos ||
                                  format.starts_with("Wavefront") || format == "OFF";
  if (!says_nothing_of_up || box.isEmpty()) return "";
  const Eigen::Vector3d& least = box.min();
  const Eigen::Vector3d& most = box.max();
  if (is_on_zero(least.y(), most.y()) && straddles_zero(least.x(), most.x()) &&
      straddles_zero(least.z(), most.z())) {
    return "a guess: y is up in this file, because the model is on or above y = 0 and around x = "
           "z = 0; if so, --up y converts it to +z";
  }
  return "";
}

std::string placement_advice(const Scene& scene, const Pose& world_from_sensor) {
  const Eigen::Vector3d at = world_from_sensor.translation();
  return fmt::format(
      "the sensor is upright beside the scene, {:.4g} m from its centre, at "
      "{:.4g},{:.4g},{:.4g};"
      " --eye x,y,z places it elsewhere, for example in a room",
      (at - bounds(scene).center()).norm(), at.x(), at.y(), at.z());
}

std::vector<std::string> velocity_advice(const Sensor& sensor) {
  if (!sensor.doppler) return {};
  return {fmt::format(
      "'{}' measures radial velocities, but the poses of a simulator or of ROS 2 have none: they "
      "are those of a sensor at rest; clients in lock-step can state velocities",
      sensor.name)};
}

std::vector<std::string> view_advice(const View& view) {
  std::vector<std::string> advice;
  const FrameSummary summary = summarise(view.frame);
  const ViewGeometry geometry = view_geometry(view);
  const std::vector<std::size_t> around = boxes_with_sensor(view);
  add_inside_advice(view, geometry, around, advice);
  if (summary.hits == 0) {
    advice.push_back("nothing was measured: " + reason_for_no_hits(view, geometry, summary));
  } else if (around.empty()) {
    add_ratio_advice(geometry, has_assumed_unit(view.scene), advice);
  }
  return advice;
}

}  // namespace glidar::app
