// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/verify/cases.hpp>

#include <glidar/core/random.hpp>
#include <glidar/sensor/pinhole.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

namespace glidar {
namespace {

constexpr std::uint32_t kImageSide = 64;
constexpr std::uint32_t kRandomRays = 4096;
constexpr double kViewOverShape = 1.15;  // of the angle that the sphere around the shape fills

/// Random numbers of one case: block after block of the draw for `beam`.
std::array<double, 4> draw(std::uint32_t number, std::uint32_t beam) {
  const RandomWords words =
      random_words({.seed = 1, .frame = number, .beam = beam, .purpose = Purpose::probe});
  return {uniform(words[0]), uniform(words[1]), uniform(words[2]), uniform(words[3])};
}

/// A uniformly distributed rotation (Shoemake, "Uniform random rotations", Graphics Gems III).
Eigen::Quaterniond random_rotation(const std::array<double, 4>& u) {
  const double a = std::sqrt(1.0 - u[0]);
  const double b = std::sqrt(u[0]);
  const double s = 2.0 * std::numbers::pi * u[1];
  const double t = 2.0 * std::numbers::pi * u[2];
  return Eigen::Quaterniond(b * std::cos(t), a * std::sin(s), a * std::cos(s), b * std::sin(t))
      .normalized();
}

/// Half the angle the sphere around the shape fills, and some more.
double half_view_rad(const VerifyCase& c) {
  return kViewOverShape * std::asin(c.radius_m / (c.distance_m + c.radius_m));
}

/// Rays in all directions about the boresight, from origins beside the sensor's.
Beams random_beams(const VerifyCase& c) {
  Beams beams;
  beams.rows = 1;
  beams.cols = kRandomRays;
  beams.frame_id = "verify";
  const double lowest_cosine = std::cos(half_view_rad(c));
  const double spread_m = 0.05 * std::min(c.radius_m, c.distance_m);
  for (std::uint32_t i = 0; i < kRandomRays; ++i) {
    const std::array<double, 4> u = draw(c.number, 1 + i);
    const double z = 1.0 - u[0] * (1.0 - lowest_cosine);
    const double r = std::sqrt(1.0 - z * z);
    const double angle = 2.0 * std::numbers::pi * u[1];
    beams.directions.push_back(
        Eigen::Vector3d(r * std::cos(angle), r * std::sin(angle), z).normalized());
    beams.origins_m.emplace_back(spread_m * (u[2] - 0.5), spread_m * (u[3] - 0.5), 0.0);
  }
  return beams;
}

/// A scene of one shape and where it is seen from.
struct Stage {
  Scene scene;
  Pose world_from_sensor = Pose::Identity();
};

Stage make_stage(const VerifyCase& c, const Shape& shape) {
  const Eigen::Vector3d place = c.offset_m * Eigen::Vector3d(0.6, -0.64, 0.48);
  const Eigen::Quaterniond attitude = random_rotation(draw(c.number, 0));
  const Eigen::Quaterniond view = random_rotation(draw(c.number, kRandomRays + 1));
  Stage stage;
  Mesh mesh = shape.mesh;
  Instance instance;
  instance.name = shape.name;
  instance.scale = c.radius_m;
  instance.materials = {0};
  instance.world_from_object = make_pose(place, attitude);
  if (c.offset_in_mesh) {
    mesh.origin_m = place / c.radius_m;
    instance.world_from_object.translation() =
        place - instance.world_from_object.linear() * (c.radius_m * mesh.origin_m);
  }
  stage.scene.meshes.push_back(std::move(mesh));
  stage.scene.sources.emplace_back();
  stage.scene.materials.emplace_back();
  stage.scene.instances.push_back(std::move(instance));
  const Eigen::Vector3d back = view * Eigen::Vector3d(0.0, 0.0, -(c.distance_m + c.radius_m));
  stage.world_from_sensor = make_pose(place + back, view);
  return stage;
}

double float_step(double value) {
  const auto single = static_cast<float>(value);
  return static_cast<double>(std::nextafter(single, std::numeric_limits<float>::infinity())) -
         static_cast<double>(single);
}

void judge_hit(const TrueHit& truth, double range_m, const RealVector& normal,
               VerifyResult& result) {
  const auto error_m = static_cast<double>(std::abs(static_cast<Real>(range_m) - truth.range_m));
  result.range_error_m = std::max(result.range_error_m, error_m);
  result.range_error_ulp =
      std::max(result.range_error_ulp, error_m / float_step(static_cast<double>(truth.range_m)));
  const auto angle_rad =
      static_cast<double>(std::atan2(truth.normal.cross(normal).norm(), truth.normal.dot(normal)));
  result.normal_error_rad = std::max(result.normal_error_rad, angle_rad);
}

VerifyResult judge(const VerifyCase& c, const ClosedForm& form, const Pose& world_from_sensor,
                   const Beams& beams, const Hits& hits) {
  const Eigen::Matrix<Real, 3, 3> world_from_axes = world_from_sensor.linear().cast<Real>();
  VerifyResult result;
  result.rays = beams.size();
  for (std::size_t i = 0; i < beams.size(); ++i) {
    RealVector origin = RealVector::Zero();
    if (!beams.origins_m.empty()) origin = world_from_axes * beams.origins_m[i].cast<Real>();
    const RealVector direction = world_from_axes * beams.directions[i].cast<Real>();
    const TrueHit truth = intersect(form, origin, direction, kEdgeTolerance * c.radius_m);
    if (!truth.clear) {
      ++result.near_edges;
      continue;
    }
    const bool hit = hits.instance[i] != kNoHit;
    ++(truth.hit ? result.judged_hits : result.judged_misses);
    if (hit && !truth.hit) ++result.wrong_hits;
    if (!hit && truth.hit) ++result.wrong_misses;
    if (hit && truth.hit) {
      judge_hit(truth, hits.range_m[i], world_from_axes * hits.normal[i].cast<Real>(), result);
    }
  }
  return result;
}

}  // namespace

void VerifyResult::add(const VerifyResult& other) {
  rays += other.rays;
  judged_hits += other.judged_hits;
  judged_misses += other.judged_misses;
  near_edges += other.near_edges;
  wrong_hits += other.wrong_hits;
  wrong_misses += other.wrong_misses;
  range_error_m = std::max(range_error_m, other.range_error_m);
  range_error_ulp = std::max(range_error_ulp, other.range_error_ulp);
  normal_error_rad = std::max(normal_error_rad, other.normal_error_rad);
}

bool VerifyResult::passed() const {
  constexpr std::size_t kMostUnjudged = 50;  // one in so many rays
  return judged_hits > 0 && judged_misses > 0 && near_edges * kMostUnjudged < rays &&
         wrong_hits == 0 && wrong_misses == 0 && range_error_ulp <= kRangeBound_ulp &&
         normal_error_rad <= kNormalBound_rad;
}

const std::vector<double>& verify_distances() {
  static const std::vector<double> kDistances = {0.1, 1.0, 10.0, 100.0, 1000.0, 10000.0};
  return kDistances;
}

std::vector<VerifyCase> make_cases(std::size_t shape, double distance_m) {
  constexpr double kScaledRadius = 0.2;  // of the distance: seen 20 degrees wide
  constexpr double kFixedRadius_m = 0.5;
  struct Offset {
    double offset_m;
    bool in_mesh;
  };
  constexpr std::array<Offset, 4> kOffsets = {
      {{0.0, false}, {1e3, false}, {1e6, false}, {1e6, true}}};
  constexpr std::uint32_t kNumberStep = 1000;  // so that no two cases share random numbers
  std::vector<VerifyCase> cases;
  auto number = static_cast<std::uint32_t>(shape) * kNumberStep +
                static_cast<std::uint32_t>(10.0 * (5.0 + std::log10(distance_m)));
  for (const double radius_m : {kScaledRadius * distance_m, kFixedRadius_m}) {
    for (const Offset& offset : kOffsets) {
      cases.push_back({.shape = shape,
                       .distance_m = distance_m,
                       .radius_m = radius_m,
                       .offset_m = offset.offset_m,
                       .offset_in_mesh = offset.in_mesh,
                       .number = number++});
    }
  }
  return cases;
}

VerifyResult run_case(const VerifyCase& verify_case, const Shape& shape,
                      const RendererOptions& options) {
  const Stage stage = make_stage(verify_case, shape);
  const std::unique_ptr<Renderer> renderer = make_renderer(stage.scene, options);
  const Instance& instance = stage.scene.instances[0];
  const Shape placed{.name = shape.name,
                     .mesh = stage.scene.meshes[0],
                     .faces = shape.faces,
                     .solid = shape.solid};
  const ClosedForm form = make_closed_form(placed, instance.scale, instance.world_from_object,
                                           stage.world_from_sensor.translation());
  const Beams image =
      make_beams(pinhole_from_fov(kImageSide, kImageSide, 2.0 * half_view_rad(verify_case)));
  VerifyResult result;
  Hits hits;
  for (const Beams& beams : {image, random_beams(verify_case)}) {
    renderer->cast({.beams = beams,
                    .world_from_sensor = stage.world_from_sensor,
                    .world_from_instance = {},
                    .fields = {.normal = true},
                    .cull_back_faces = false},
                   hits);
    result.add(judge(verify_case, form, stage.world_from_sensor, beams, hits));
  }
  return result;
}

}  // namespace glidar
