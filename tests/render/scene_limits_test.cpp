// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// At the limits of scale every renderer equals rays; beyond them, scenes are rejected.
#include <glidar/core/error.hpp>
#include <glidar/core/scene.hpp>
#include <render/renderer_suite.hpp>
#include <support/error_text.hpp>

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace glidar {
namespace {

using testing::builtin_scene;
using testing::camera_beams;
using ::testing::HasSubstr;
using testing::RendererSuite;

class SceneLimits : public RendererSuite {
 protected:
  /// Compares rays and the renderer from `distance` times the size of the box: the same bits.
  static void expect_ranges_of_rays(double scale, double distance) {
    Scene scene = builtin_scene("box");
    scene.instances[0].scale = scale;
    const double size_m = scale * bounds(scene.meshes[0]).max().maxCoeff();
    const Eigen::Vector3d eye(0.1 * size_m, -distance * size_m, 0.2 * size_m);
    const Pose pose = look_at(eye, Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ());
    const Beams beams = camera_beams(32, 24, 24.0);
    const Hits hits = cast(scene, beams, pose);
    Hits expected;
    make_renderer(scene, {.kind = "rays"})
        ->cast({.beams = beams,
                .world_from_sensor = pose,
                .world_from_instance = {},
                .hit_columns = kAllHitColumns},
               expected);
    ASSERT_TRUE(std::any_of(hits.range_m.begin(), hits.range_m.end(),
                            [](double range_m) { return std::isfinite(range_m); }));
    for (std::size_t i = 0; i < beams.size(); ++i) {
      EXPECT_EQ(hits.primitive[i], expected.primitive[i]) << "beam " << i;
      if (std::isnan(expected.range_m[i]) && std::isnan(hits.range_m[i])) continue;
      EXPECT_EQ(hits.range_m[i], expected.range_m[i]) << "beam " << i;
    }
  }
  static std::string error_of_cast(const Scene& scene, const Pose& world_from_instance) {
    const Beams beams = camera_beams(4, 3, 4.0);
    Hits hits;
    return error_text([&] {
      renderer(scene)->cast({.beams = beams,
                             .world_from_instance = std::vector<Pose>{world_from_instance},
                             .hit_columns = kAllHitColumns},
                            hits);
    });
  }
};

TEST_P(SceneLimits, ScalesUpToTheLimitsEqualRays) {
  for (const double scale : {kMinScale, 1e-6, 1.0, 1e6, 0.1 * kMaxScale}) {
    SCOPED_TRACE(scale);
    expect_ranges_of_rays(scale, 3.0);  // from outside
    expect_ranges_of_rays(scale, 0.1);  // from inside
  }
}

TEST_P(SceneLimits, TheSmallestMeshesEqualRays) {
  Scene scene = builtin_scene("box");
  for (Eigen::Vector3f& position : scene.meshes[0].positions_m) position *= 1e-15F;
  scene.instances[0].scale = kMinScale;
  const Hits hits =
      cast(scene, camera_beams(8, 8, 8.0),
           look_at({0.0, 0.0, 3e-30}, Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitX()));
  EXPECT_TRUE(std::any_of(hits.range_m.begin(), hits.range_m.end(),
                          [](double range_m) { return std::isfinite(range_m); }));
}

TEST_P(SceneLimits, ScalesAndVerticesBeyondTheLimitsAreErrors) {
  for (const double scale : {1e-300, 0.9 * kMinScale, 1.1 * kMaxScale, 1e300}) {
    Scene scene = builtin_scene("box");
    scene.instances[0].scale = scale;
    EXPECT_THROW(renderer(scene), Error) << scale;
  }
  for (const float vertex : {1e-40F, 1e16F, 0x1p97F, std::numeric_limits<float>::max()}) {
    Scene scene = builtin_scene("box");
    for (Eigen::Vector3f& position : scene.meshes[0].positions_m) position *= vertex;
    EXPECT_THROW(renderer(scene), Error) << vertex;
  }
}

TEST_P(SceneLimits, ACastWithAnInstanceOutOfReachNamesIt) {
  const Scene scene = builtin_scene("box");
  for (const double far_m : {1.1e15, 1e300, std::nan("")}) {
    Pose pose = Pose::Identity();
    pose.translation().y() = far_m;
    EXPECT_THAT(error_of_cast(scene, pose), HasSubstr("instance 'box' is out of reach"));
  }
  EXPECT_EQ(error_of_cast(scene, Pose::Identity()), "no error");
}

/// The raster alone: OpenGL clips in single precision.
TEST(RasterLimits, AVeryCloseSurfaceEqualsRays) {
  Scene scene = builtin_scene("plane");
  const Beams beams = camera_beams(32, 24, 24.0);
  const auto raster = make_renderer(scene, {.kind = "raster"});
  const auto rays = make_renderer(scene, {.kind = "rays"});
  for (const double distance_m : {1e-3, 1e-6, 1e-9, 0.0}) {
    for (const double slope : {0.0, 0.3}) {
      const Pose pose = testing::turned(slope, {0.0, 1.0, 0.0}, {0.0, 0.0, -distance_m});
      const CastRequest request{.beams = beams,
                                .world_from_sensor = pose,
                                .world_from_instance = {},
                                .hit_columns = kAllHitColumns};
      Hits hits;
      Hits expected;
      raster->cast(request, hits);
      rays->cast(request, expected);
      EXPECT_EQ(hits.primitive, expected.primitive) << distance_m << " " << slope;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, SceneLimits, ::testing::ValuesIn(renderer_kinds()),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace glidar
