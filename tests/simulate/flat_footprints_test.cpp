// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Footprints on one plane are integrated, all others sampled, and both agree.
#include <glidar/core/error.hpp>
#include <glidar/sensor/lidar/return_names.hpp>
#include <glidar/simulate/explain.hpp>
#include <simulate/panels.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace glidar {
namespace {

/// A surface as diffuse as Lambert's, without a closed form.
const Brdf kSampled = OrenNayar{.roughness_rad = 0.0};

/// A pulsed line scan at the origin with boresight z, and panels in front of it.
struct Stage : testing::PanelScene {
  Sensor sensor;
  RendererOptions renderer{.kind = "rays", .threads = 2};

  Stage() {
    sensor.optics = pinhole_from_fov(1, 1, 1e-3);
    sensor.lidar_equation = LidarEquation{
        .reference_reflectance = 0.8, .reference_range_m = 100.0, .range_exponent = 2.3};
    sensor.receiver.pulse_fwhm_s = 5e-9;
    sensor.receiver.timing = Receiver::Timing::leading_edge;  // shows the width
    sensor.footprint = Footprint{.divergence_x_rad = 4e-3,
                                 .divergence_y_rad = 3e-3,
                                 .exit_x_m = 0.01,
                                 .exit_y_m = 0.006,
                                 .rings = 1};
  }

  /// A wall through (0, 0, range_m), turned by an angle, from x0 to x1 in its plane.
  Material& add_turned(double range_m, double angle_rad, double x0, double x1) {
    const Eigen::Vector3d along(std::cos(angle_rad), 0.0, std::sin(angle_rad));
    return add_panel(Eigen::Vector3d(0.0, -20.0, range_m) + x0 * along, (x1 - x0) * along,
                     {0.0, 50.0, 0.0});
  }

  void sample_all() {
    for (Material& material : scene.materials) material.backscatter = kSampled;
  }

  [[nodiscard]] Frame shoot(const Motion& motion) const {
    const auto made = make_renderer(scene, renderer);
    Simulator simulator(scene, sensor, *made);
    Frame frame;
    simulator.simulate(motion, {.normal = true}, frame);
    return frame;
  }
  [[nodiscard]] Frame shoot() const { return shoot(static_motion(scene, Pose::Identity())); }

  [[nodiscard]] WaveformTrace trace(std::size_t entry = 0) const {
    const auto made = make_renderer(scene, renderer);
    Simulator simulator(scene, sensor, *made);
    Frame frame;
    return explain(simulator, static_motion(scene, Pose::Identity()), entry, frame)
        .waveform.value();
  }
};

/// The same scene in closed form and sampled.
struct Pair {
  Stage closed;
  Stage sampled;

  explicit Pair(const Stage& stage) : closed(stage), sampled(stage) { sampled.sample_all(); }
};

/// Ranges and signals differ by the fourth order of the beam's width: relative to its range a beam
/// spreads by 1e-3 tan(angle) here, and relative to the pulse by 0.02.
constexpr double kRangeTolerance_m = 2e-6;
constexpr double kSignalTolerance = 1e-6;

TEST(FlatFootprints, AreOnePathWithAllOfTheEnergy) {
  Stage stage;
  stage.add_turned(20.0, 0.7, -30.0, 30.0);
  stage.scene.materials[0].diffuse.setConstant(0.5F);
  const WaveformTrace trace = stage.trace();
  EXPECT_TRUE(trace.is_in_closed_form);
  ASSERT_EQ(trace.light_paths.size(), 1U);
  EXPECT_EQ(trace.light_paths[0].share, 1.0);
  EXPECT_EQ(trace.light_paths[0].path.source, 0U);
  ASSERT_EQ(trace.echoes.size(), 1U);
  const double spread_m = std::tan(0.7) * std::hypot(0.01, 4e-3 * 20.0) / 4.0;
  const double pulse_m = pulse_sigma_m(stage.sensor.receiver);
  EXPECT_NEAR(trace.echoes[0].sigma_m, std::hypot(pulse_m, spread_m), 1e-5);
  EXPECT_NEAR(trace.echoes[0].range_m, 20.0, 1e-3);
}

/// Chequered in 5 mm squares; triangles have texture coordinates in metres.
void add_texture(Stage& stage) {
  Texture texture{
      .name = "squares", .width = 2, .height = 2, .channels = 1, .texels = {40, 230, 200, 90}};
  stage.scene.textures.push_back(texture);
  for (Mesh& mesh : stage.scene.meshes) {
    for (const Eigen::Vector3f& p : mesh.positions_m) {
      mesh.uvs[0].emplace_back(100.0F * p.head<2>());
    }
  }
  for (Material& material : stage.scene.materials) material.diffuse_texture.texture = 0;
}

TEST(FlatFootprints, MeetTheSamplesWithoutAStepAtAnEdge) {
  // A beam that crosses the outer edge of a wall, and the edge where it meets another wall.
  constexpr int kSteps = 1000;
  constexpr double kWidth_rad = 0.016;
  enum class Edge { outer, corner, textured };
  for (const Edge edge : {Edge::outer, Edge::corner, Edge::textured}) {
    Stage stage;
    stage.add_turned(20.0, 0.6, -30.0, 0.0);
    if (edge == Edge::corner) stage.add_turned(20.0, -0.4, 0.0, 30.0);
    if (edge == Edge::textured) add_texture(stage);
    // On textures: the contrast times the second order of the beam's width.
    const double range_tolerance_m = edge == Edge::textured ? 1e-4 : kRangeTolerance_m;
    const double signal_tolerance = edge == Edge::textured ? 1e-4 : kSignalTolerance;
    const Pair pair(stage);
    const Sensor& sensor = stage.sensor;
    const auto renderer = make_renderer(pair.closed.scene, {.threads = 2});
    const auto sampling = make_renderer(pair.sampled.scene, {.threads = 2});
    Simulator closed(pair.closed.scene, sensor, *renderer);
    Simulator sampled(pair.sampled.scene, sensor, *sampling);
    int in_closed_form = 0;
    int in_samples = 0;
    for (int i = 0; i < kSteps; ++i) {
      Pose pose = Pose::Identity();
      const double angle = kWidth_rad * (static_cast<double>(i) / kSteps - 0.5);
      pose.linear() = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY()).toRotationMatrix();
      const Motion motion = static_motion(stage.scene, pose);
      Frame frame;
      const bool is_closed = explain(closed, motion, 0, frame).waveform->is_in_closed_form;
      Frame expected;
      sampled.simulate(motion, {}, expected);
      (is_closed ? in_closed_form : in_samples) += 1;
      ASSERT_EQ(frame.status, expected.status) << i;
      if (expected.status[0] != Status::hit) continue;
      ASSERT_NEAR(frame.range_m[0], expected.range_m[0], range_tolerance_m) << i;
      ASSERT_NEAR(frame.intensity[0], expected.intensity[0],
                  signal_tolerance * expected.intensity[0])
          << i;
    }
    EXPECT_GT(in_closed_form, 200) << static_cast<int>(edge);
    EXPECT_GT(in_samples, 150) << static_cast<int>(edge);
  }
}

TEST(FlatFootprints, HaveTheReflectanceThatSubRaysSample) {
  Stage stage;
  stage.sensor.optics = pinhole_from_fov(40, 30, 0.5);
  stage.add_turned(6.0, 0.9, -30.0, 30.0);
  add_texture(stage);
  EXPECT_TRUE(stage.trace().is_in_closed_form);
  const Pair pair(stage);
  const Frame closed = pair.closed.shoot();
  const Frame sampled = pair.sampled.shoot();
  EXPECT_EQ(closed.status, sampled.status);
  float lowest = 1e9F;
  float highest = 0.0F;
  for (std::size_t i = 0; i < closed.range_m.size(); ++i) {
    ASSERT_EQ(closed.status[i], Status::hit);
    // The contrast times the second order of the beam's width.
    ASSERT_NEAR(closed.range_m[i], sampled.range_m[i], 1e-4) << i;
    ASSERT_NEAR(closed.intensity[i], sampled.intensity[i], 1e-4 * sampled.intensity[i]) << i;
    const float at_1_m = closed.intensity[i] *
                         static_cast<float>(std::pow(closed.range_m[i], 2.3)) /
                         closed.ground_truth.normal[i].norm();
    lowest = std::min(lowest, at_1_m);
    highest = std::max(highest, at_1_m);
  }
  EXPECT_GT(highest, 1.3F * lowest);
}

TEST(FlatFootprints, AreTheSameInMovingScenes) {
  // A sensor and a wall that move while beams fire one after the other, and a wall at rest.
  Stage stage;
  LineScan scan;
  scan.point_ns = 1e6;
  for (int i = 0; i < 64; ++i) scan.azimuths_rad.push_back(0.01 * (i - 32));
  stage.sensor.optics = scan;
  stage.add_wall(30.0);
  stage.add_panel({-2.0, -1.0, 12.0}, {4.0, 0.0, 0.0}, {0.0, 4.0, 0.0});
  add_texture(stage);
  const Pair pair(stage);
  Motion motion = static_motion(stage.scene, Pose::Identity());
  Pose towards_walls = Pose::Identity();  // the scan looks along +x
  towards_walls.linear() =
      Eigen::AngleAxisd(-0.5 * std::numbers::pi, Eigen::Vector3d::UnitY()).toRotationMatrix();
  motion.world_from_sensor = ConstantTwist{.pose = towards_walls, .linear_m_s = {4.0, 0.3, 0.0}};
  motion.world_from_instance[1] = ConstantTwist{.linear_m_s = {1.0, 0.0, -5.0}};
  for (const std::size_t entry : {8U, 30U}) {  // on the wall at rest, and on the other
    const auto renderer = make_renderer(pair.closed.scene, {.threads = 2});
    Simulator simulator(pair.closed.scene, stage.sensor, *renderer);
    Frame frame;
    const PointTrace trace = explain(simulator, motion, entry, frame);
    EXPECT_EQ(frame.ground_truth.instance[entry], entry == 8U ? 0U : 1U);
    EXPECT_TRUE(trace.waveform->is_in_closed_form) << entry;
  }
  const Frame closed = pair.closed.shoot(motion);
  const Frame sampled = pair.sampled.shoot(motion);
  EXPECT_EQ(closed.status, sampled.status);
  std::size_t hits = 0;
  for (std::size_t i = 0; i < closed.range_m.size(); ++i) {
    if (closed.status[i] != Status::hit || closed.return_source[i] != ReturnSource::surface)
      continue;
    ++hits;
    ASSERT_NEAR(closed.range_m[i], sampled.range_m[i], 2e-5) << i;
    ASSERT_NEAR(closed.intensity[i], sampled.intensity[i], 1e-4 * sampled.intensity[i]) << i;
  }
  EXPECT_GT(hits, 20U);
}

/// One wall, changed so that its footprints must be sampled.
struct Exception {
  const char* name;
  void (*change)(Stage& stage);
};

const Exception kExceptions[] = {
    {"normals that vary",
     [](Stage& stage) {
       Mesh& mesh = stage.scene.meshes[0];
       mesh.normals.assign(mesh.positions_m.size(), Eigen::Vector3f(0.0F, 0.0F, -1.0F));
       mesh.normals[0] = Eigen::Vector3f(0.1F, 0.0F, -1.0F).normalized();
     }},
    {"an alpha mask", [](Stage& stage) { stage.scene.materials[0].alpha_cutoff = 0.5F; }},
    {"a glossy surface", [](Stage& stage) { stage.scene.materials[0].backscatter = PhongLike{}; }},
    {"a mirror in the scene", [](Stage& stage) { stage.add_wall(40.0).mirror = 0.5F; }},
    {"weather",
     [](Stage& stage) {
       stage.sensor.wavelength_m = 905e-9;
       stage.sensor.weather = Weather{.visibility_m = 500.0};
     }},
    {"an overlap",
     [](Stage& stage) {
       stage.sensor.lidar_equation->overlap = {{0.0, 1.0}};
     }},
    {"extinction", [](Stage& stage) { stage.sensor.lidar_equation->extinction_per_m = 1e-3; }},
    {"radial velocities", [](Stage& stage) { stage.sensor.doppler = Doppler{}; }},
    {"a short pulse", [](Stage& stage) { stage.sensor.receiver.pulse_fwhm_s = 2e-10; }},
    {"an edge", [](Stage& stage) { stage.add_wall(9.0, 0.0, 5.0); }},
};

TEST(FlatFootprints, AreSampledWhereTheyHaveNoClosedForm) {
  for (const Exception& exception : kExceptions) {
    Stage stage;
    stage.add_turned(20.0, 0.7, -30.0, 30.0);
    ASSERT_TRUE(stage.trace().is_in_closed_form);
    exception.change(stage);
    const WaveformTrace trace = stage.trace();
    EXPECT_FALSE(trace.is_in_closed_form) << exception.name;
    EXPECT_GE(trace.light_paths.size(), 7U) << exception.name;
  }
}

TEST(FlatFootprints, HaveNormalsAtCornersThatAreThoseOfThePlane) {
  Stage stage;
  stage.add_turned(20.0, 0.7, -30.0, 30.0);
  Mesh& mesh = stage.scene.meshes[0];
  const Triangle& t = mesh.triangles[0];
  const auto at = [&](std::size_t k) { return mesh.positions_m[t[k]]; };
  const Eigen::Vector3f front = (at(1) - at(0)).cross(at(2) - at(0)).normalized();
  mesh.normals.assign(mesh.positions_m.size(), front);
  EXPECT_TRUE(stage.trace().is_in_closed_form);
}

/// A wall whose diagonal crosses the beam, so that the sub-rays meet both of its triangles.
struct DiagonalStage : Stage {
  DiagonalStage() { add_panel({-6.0, -6.0, 20.0}, {12.0, 0.0, 8.0}, {0.0, 12.0, 0.0}); }
  Mesh& mesh() { return scene.meshes[0]; }
};

TEST(FlatFootprints, ExtendOverTrianglesOfOnePlane) {
  DiagonalStage stage;
  const WaveformTrace trace = stage.trace();
  EXPECT_TRUE(trace.is_in_closed_form);
  const Pair pair(stage);
  const Frame closed = pair.closed.shoot();
  const Frame sampled = pair.sampled.shoot();
  EXPECT_NEAR(closed.range_m[0], sampled.range_m[0], kRangeTolerance_m);
  EXPECT_NEAR(closed.intensity[0], sampled.intensity[0], kSignalTolerance * sampled.intensity[0]);
  EXPECT_EQ(closed.return_source, sampled.return_source);
}

TEST(FlatFootprints, EndAtFoldsAndWhereTheMaterialChanges) {
  DiagonalStage folded;
  folded.mesh().positions_m[3].z() += 0.01F;  // a corner of the second triangle
  EXPECT_FALSE(folded.trace().is_in_closed_form);
  DiagonalStage painted;
  painted.mesh().material_slots = {0, 1};
  painted.scene.instances[0].materials = {0, 0};
  EXPECT_FALSE(painted.trace().is_in_closed_form);
  DiagonalStage bent;
  bent.mesh().normals.assign(4, Eigen::Vector3f(8.0F, 0.0F, -12.0F).normalized());
  std::swap(bent.mesh().triangles[0][1], bent.mesh().triangles[0][2]);  // towards the sensor
  std::swap(bent.mesh().triangles[1][1], bent.mesh().triangles[1][2]);
  EXPECT_TRUE(bent.trace().is_in_closed_form);
  bent.mesh().normals[3].x() += 0.1F;
  EXPECT_FALSE(bent.trace().is_in_closed_form);
}

TEST(FlatFootprints, ThatMeetNothingHaveNoReturnForEveryRank) {
  Stage stage;
  stage.sensor.optics = pinhole_from_fov(12, 2, 0.6);
  stage.sensor.receiver.returns = nearest_returns(2);
  stage.add_wall(10.0, -50.0, 0.0);  // the left half
  const Frame frame = stage.shoot();
  const std::size_t firings = frame.status.size() / 2;
  std::size_t misses = 0;
  for (std::size_t i = 0; i < frame.status.size(); ++i) {
    if (frame.ground_truth.instance[i] != kInvalidId) continue;
    ++misses;
    EXPECT_EQ(frame.status[i], i < firings ? Status::miss : Status::no_return_of_rank) << i;
    EXPECT_TRUE(std::isnan(frame.range_m[i])) << i;
    EXPECT_TRUE(std::isnan(frame.ground_truth.range_m[i])) << i;
    EXPECT_EQ(frame.intensity[i], 0.0F) << i;
    EXPECT_EQ(frame.return_source[i], ReturnSource::none) << i;
  }
  EXPECT_GT(misses, 10U);
  EXPECT_LT(misses, frame.status.size());
}

class FlatFootprintsBy : public ::testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    try {
      if (GetParam() == "gpu") make_renderer(Scene(), {.kind = "gpu"});
    } catch (const Error& error) {
      GTEST_SKIP() << error.what();
    }
  }
};

TEST_P(FlatFootprintsBy, HaveTheSameBytesForAnyThreads) {
  Stage stage;
  stage.sensor.optics = pinhole_from_fov(60, 40, 0.6);
  stage.add_turned(9.0, 0.8, -3.0, 2.0);
  stage.add_wall(10.6);
  add_texture(stage);
  stage.scene.materials[1].diffuse_texture.texture = TextureUse::kNone;
  stage.renderer.threads = 1;
  const Frame expected = stage.shoot();
  for (const unsigned threads : {1U, 3U}) {
    stage.renderer = {.kind = GetParam(), .threads = threads};
    const Frame frame = stage.shoot();
    EXPECT_EQ(frame.status, expected.status);
    EXPECT_EQ(frame.range_m, expected.range_m);
    EXPECT_EQ(frame.intensity, expected.intensity);
    EXPECT_EQ(frame.return_source, expected.return_source);
    EXPECT_EQ(frame.ground_truth.range_m, expected.ground_truth.range_m);
    EXPECT_EQ(frame.ground_truth.normal, expected.ground_truth.normal);
  }
  EXPECT_GT(std::count(expected.status.begin(), expected.status.end(), Status::hit), 2000);
}

// The raster has no footprints.
INSTANTIATE_TEST_SUITE_P(All, FlatFootprintsBy, ::testing::Values("rays", "auto", "gpu"),
                         [](const auto& param) { return param.param; });

}  // namespace
}  // namespace glidar
