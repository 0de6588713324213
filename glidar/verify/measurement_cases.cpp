// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/verify/measurement_cases.hpp>

#include <glidar/verify/comparison.hpp>
#include <glidar/verify/moving_case.hpp>
#include <glidar/verify/probes.hpp>

#include <array>
#include <cmath>
#include <numbers>

namespace glidar {
namespace {

double value_of(Real real) {
  return static_cast<double>(real);
}

using RealPoint = Eigen::Matrix<Real, 2, 1>;

/// Where OpenCV's rational model (calib3d) images a point of the plane z = 1.
RealPoint imaged(const RadialTangential& k, const RealPoint& p) {
  const Real r2 = p.squaredNorm();
  const auto power = [&](double a, double b, double c) {
    return 1.0L + static_cast<Real>(a) * r2 + static_cast<Real>(b) * r2 * r2 +
           static_cast<Real>(c) * r2 * r2 * r2;
  };
  const Real radial = power(k.k1, k.k2, k.k3) / power(k.k4, k.k5, k.k6);
  const auto p1 = static_cast<Real>(k.p1);
  const auto p2 = static_cast<Real>(k.p2);
  return {p.x() * radial + 2.0L * p1 * p.x() * p.y() + p2 * (r2 + 2.0L * p.x() * p.x()),
          p.y() * radial + p1 * (r2 + 2.0L * p.y() * p.y()) + 2.0L * p2 * p.x() * p.y()};
}

/// The distance from the axis at which OpenCV's fisheye model images an angle.
Real imaged_radius(const Fisheye& k, Real theta) {
  const Real t2 = theta * theta;
  return theta *
         (1.0L + static_cast<Real>(k.k1) * t2 + static_cast<Real>(k.k2) * t2 * t2 +
          static_cast<Real>(k.k3) * t2 * t2 * t2 + static_cast<Real>(k.k4) * t2 * t2 * t2 * t2);
}

RealPoint image_of(const RadialTangential& k, const RealVector& ray) {
  return imaged(k, {ray.x() / ray.z(), ray.y() / ray.z()});
}

RealPoint image_of(const Fisheye& k, const RealVector& ray) {
  const RealPoint side(ray.x(), ray.y());
  const Real length = side.norm();
  if (length == 0.0L) return {0.0L, 0.0L};
  return side / length * imaged_radius(k, std::atan2(length, ray.z()));
}

/// The radius of the image within which pixels have rays.
Real image_radius(const RadialTangential& k) {
  return imaged(k, {static_cast<Real>(k.max_radius), 0.0L}).x();
}
Real image_radius(const Fisheye& k) {
  return imaged_radius(k, std::numbers::pi_v<Real>);
}

/// Projects the ray of every pixel back into the image.
template <class Lens>
VerifyResult project_rays(const VerifySubject& subject, const Lens& lens, double focal_px) {
  constexpr double kBound_px = 1e-9;
  constexpr Real kBorder = 0.006L;  // more than tangential distortion moves it
  Pinhole camera{.intrinsics = {.width = 160, .height = 120}, .distortion = lens};
  camera.intrinsics.fx = focal_px;
  camera.intrinsics.fy = 1.02 * focal_px;
  camera.intrinsics.cx = 81.3;
  camera.intrinsics.cy = 58.9;
  const PinholeIntrinsics& k = camera.intrinsics;
  const Beams beams = subject.beams_of_camera(camera);
  VerifyResult result;
  for (std::uint32_t i = 0; i < beams.size(); ++i) {
    ++result.rays;
    const std::uint32_t row = i / k.width;
    const RealPoint pixel((i % k.width + k.pixel_centre - k.cx) / k.fx,
                          (row + k.pixel_centre - k.cy) / k.fy);
    const Real inside = image_radius(lens) - pixel.norm();
    const RealVector ray = beams.directions[i].cast<Real>();
    if (std::abs(inside) < kBorder) {
      ++result.near_edges;
    } else if (inside < 0.0L) {
      ++result.compared_misses;
      if (!std::isnan(beams.directions[i].x())) ++result.wrong_hits;
    } else {
      ++result.compared_hits;
      result.check(value_of((image_of(lens, ray) - pixel).norm()) * k.fx, kBound_px);
      result.check(value_of(ray.norm()) - 1.0, 1e-14);
    }
  }
  return result;
}

/// Flat bodies and others of different reflectance, nearer and farther than they are detected.
struct LitScene {
  Scene scene;
  ExactScene exact;
};

constexpr std::array<float, 5> kReflectances = {0.05F, 0.1F, 0.3F, 0.6F, 0.9F};

LitScene lit_bodies(const std::vector<Shape>& shapes) {
  constexpr std::uint32_t kNumber = 90600;
  LitScene lit;
  for (const float reflectance : kReflectances) {
    Material material;
    material.diffuse.setConstant(reflectance);
    material.ambient.setConstant(0.5F * reflectance);
    material.specular.setConstant(0.25F);
    material.shininess = 8.0F;
    material.noise_scale = 1.0F + reflectance;
    lit.scene.materials.push_back(material);
  }
  for (std::uint32_t i = 0; i < 30; ++i) {
    const std::array<double, 4> u = probe_uniforms(kNumber, 2 * i);
    const double distance_m = 5.0 + 10.0 * i;
    const Shape& shape = shapes[i % shapes.size()];
    const Pose pose = make_pose(distance_m * random_direction(u[0], u[1], 0.45),
                                random_rotation(probe_uniforms(kNumber, 2 * i + 1)));
    add_shape(lit.scene, shape.mesh, 0.15 * distance_m, pose);
    lit.scene.instances.back().materials = {
        static_cast<std::uint32_t>((i / shapes.size()) % kReflectances.size())};
    lit.exact.shapes.push_back(
        place_shape(shape, 0.15 * distance_m, relative_pose(pose, Eigen::Vector3d::Zero())));
  }
  lit.exact.edge_tolerance_m = 1e-9;
  return lit;
}

Sensor table_sensor(const Beams& beams) {
  RayTable table;
  table.rows = 1;
  table.cols = beams.cols;
  table.directions = beams.directions;
  Sensor sensor;
  sensor.optics = table;
  sensor.rate_hz = 10.0;
  sensor.limits.along = Limits::Along::range;
  return sensor;
}

/// The colours and coefficients of the material of a hit.
void compare_surface(const Material& material, const Hits& hits, std::size_t i,
                     VerifyResult& result) {
  const auto grey = static_cast<double>(material.diffuse.x());
  const auto check = [&](double found, double exact) { result.check(found - exact, kColumnBound); };
  for (int channel = 0; channel < 3; ++channel)
    check(static_cast<double>(hits.colour[i][channel]), grey);
  check(static_cast<double>(hits.diffuse[i]), grey);
  check(static_cast<double>(hits.reflectance[i].diffuse), grey);
  check(static_cast<double>(hits.reflectance[i].ambient),
        static_cast<double>(material.ambient.x()));
  check(static_cast<double>(hits.reflectance[i].specular),
        static_cast<double>(material.specular.x()));
  check(static_cast<double>(hits.reflectance[i].shininess),
        static_cast<double>(material.shininess));
  check(static_cast<double>(hits.noise_scale[i]), static_cast<double>(material.noise_scale));
}

/// The lidar equation with extinction, S = rho cos / rho_ref (R_ref / R)^2 exp(-2 alpha (R -
/// R_ref)), and its threshold 1.
VerifyResult lidar_equation(const VerifySubject& subject, const std::vector<Shape>& shapes) {
  constexpr double kAlpha_per_m = 1e-3;
  constexpr double kBound = 1e-6;  // signals are float32
  const LitScene lit = lit_bodies(shapes);
  const std::unique_ptr<Renderer> renderer = subject.make(lit.scene);
  Beams beams = random_probes(90700, 0.5, 0.0);
  Sensor sensor = table_sensor(beams);
  sensor.lidar_equation = LidarEquation{
      .reference_reflectance = 0.8, .reference_range_m = 150.0, .extinction_per_m = kAlpha_per_m};
  Simulator simulator(lit.scene, sensor, *renderer);
  Frame frame;
  subject.measure(simulator, make_motion(lit.scene, ConstantPose{}, {}), frame);
  VerifyResult result = compare_cast(lit.exact, Pose::Identity(), *simulator.beams(),
                                     frame.ground_truth, renderer->thread_pool());
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const std::uint32_t instance = frame.ground_truth.instance[i];
    if (instance == kInvalidId) {
      if (frame.status[i] != Status::miss) ++result.wrong_hits;
      continue;
    }
    const Material& material = lit.scene.materials[lit.scene.instances[instance].materials[0]];
    compare_surface(material, frame.ground_truth, i, result);
    const auto range_m = static_cast<Real>(frame.ground_truth.range_m[i]);
    const RealVector normal = frame.ground_truth.normal[i].cast<Real>();
    const Real cosine = std::abs(normal.dot(beams.directions[i].cast<Real>()));
    const Real signal = static_cast<Real>(material.diffuse.x()) * cosine / 0.8L *
                        (150.0L / range_m) * (150.0L / range_m) *
                        std::exp(-2.0L * static_cast<Real>(kAlpha_per_m) * (range_m - 150.0L));
    if (std::abs(signal - 1.0L) < 1e-5L) continue;
    const Status expected = signal > 1.0L ? Status::hit : Status::below_threshold;
    if (frame.status[i] != expected) ++(signal > 1.0L ? result.wrong_misses : result.wrong_hits);
    if (expected != Status::hit || frame.status[i] != Status::hit) continue;
    result.check(static_cast<double>(frame.intensity[i]) / value_of(signal) - 1.0, kBound);
    result.check(frame.range_m[i] - frame.ground_truth.range_m[i], 1e-12);
  }
  return result;
}

/// A wall of which the beam covers a part, before another wall: two echoes. The share of the near
/// one is that of a Gaussian left of the border, up to the number of sub-rays.
VerifyResult footprint_on_a_step(const VerifySubject& subject, const Shape& plane) {
  constexpr double kNear_m = 40.0;
  constexpr double kFar_m = 60.0;
  constexpr double kDivergence_rad = 2e-3;  // full width at 1/e^2, 4 sigma
  constexpr double kShareBound = 0.02;
  constexpr double kRangeBound_m = 1e-3;
  const Eigen::Quaterniond facing(
      Eigen::AngleAxisd(0.5 * std::numbers::pi, Eigen::Vector3d::UnitY()));
  Scene scene;
  // the near wall begins at the boresight x and goes to the left, the far one is everywhere
  add_shape(scene, plane.mesh, 32.0, make_pose({kNear_m, 32.0 * 0.625, 0.0}, facing));
  add_shape(scene, plane.mesh, 64.0, make_pose({kFar_m, 0.0, 0.0}, facing));
  std::vector<Eigen::Vector3d> directions;
  for (int i = -200; i <= 200; ++i)
    directions.push_back(Eigen::Vector3d(1.0, 0.004 * i * kDivergence_rad, 0.0003).normalized());
  Beams beams = unstructured_probes(directions);
  Sensor sensor = table_sensor(beams);
  sensor.lidar_equation = LidarEquation{.reference_reflectance = 1.0, .reference_range_m = 1e4};
  sensor.footprint = Footprint{
      .divergence_x_rad = kDivergence_rad, .divergence_y_rad = kDivergence_rad, .rings = 8};
  sensor.receiver.returns = {{Return::Order::nearest, 0}, {Return::Order::farthest, 0}};
  const std::unique_ptr<Renderer> renderer = subject.make(scene);
  Simulator simulator(scene, sensor, *renderer);
  Frame frame;
  subject.measure(simulator, make_motion(scene, ConstantPose{}, {}), frame);
  VerifyResult result;
  result.may_miss = false;
  const auto signal = [](double range_m) { return 0.8 * (1e4 / range_m) * (1e4 / range_m); };
  for (std::size_t i = 0; i < directions.size(); ++i) {
    ++result.rays;
    const double y = directions[i].y() / directions[i].x();
    const double left = 0.5 * std::erfc(-y / (0.25 * kDivergence_rad) / std::numbers::sqrt2);
    if (left < 0.03 || left > 0.97) {
      ++result.compared_misses;
      continue;
    }
    ++result.compared_hits;
    const std::size_t far = i + directions.size();
    if (frame.status[i] != Status::hit || frame.status[far] != Status::hit) {
      ++result.wrong_misses;
      continue;
    }
    const double near_share = static_cast<double>(frame.intensity[i]) / signal(kNear_m);
    const double far_share = static_cast<double>(frame.intensity[far]) / signal(kFar_m);
    result.check(near_share - left, kShareBound);
    result.check(near_share + far_share - 1.0, 1e-5);
    result.check(frame.range_m[i] - kNear_m / directions[i].x(), kRangeBound_m);
    result.check(frame.range_m[far] - kFar_m / directions[i].x(), kRangeBound_m);
  }
  return result;
}

}  // namespace

void add_measurement_cases(const std::vector<Shape>& shapes, std::vector<SpecialCase>& cases) {
  const auto none = BeamKind::pinhole;
  cases.push_back({"lens", "radial, tangential", 0.0, none, [](const auto& s) {
                     return project_rays(s,
                                         RadialTangential{.k1 = 0.12,
                                                          .k2 = -0.01,
                                                          .p1 = 5e-4,
                                                          .p2 = -4e-4,
                                                          .k3 = 2e-3,
                                                          .k4 = 0.05,
                                                          .k5 = 0.01,
                                                          .k6 = 1e-3,
                                                          .max_radius = 1.2},
                                         60.0);
                   }});
  cases.push_back({"lens", "fisheye", 0.0, none, [](const auto& s) {
                     return project_rays(
                         s, Fisheye{.k1 = -0.01, .k2 = 2e-3, .k3 = -1e-4, .k4 = 1e-5}, 25.0);
                   }});
  cases.push_back({"lidar equation", "all", 150.0, BeamKind::any,
                   [&](const auto& s) { return lidar_equation(s, shapes); }});
  cases.push_back({"footprint", shapes[1].name, 40.0, BeamKind::any,
                   [&](const auto& s) { return footprint_on_a_step(s, shapes[1]); }});
  cases.push_back({"measured motion", shapes.front().name, 10.0, BeamKind::any,
                   [&](const auto& s) { return measured_motion(s, shapes); }});
}

}  // namespace glidar
