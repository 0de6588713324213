// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// What the graphics device itself finds. All other tests of the gpu renderer would pass if the
// processor cast every beam.
#include <glidar/render/cpu_base.hpp>
#include <glidar/render/gpu/device_batch.hpp>
#include <glidar/render/opengl/egl_context.hpp>
#include <render/renderer_suite.hpp>

#include <bit>
#include <cstdint>
#include <optional>

namespace glidar {
namespace {

using testing::builtin_scene;
using testing::camera_beams;
using testing::turned;

class GpuBatch : public ::testing::Test {
 protected:
  void SetUp() override {
    GLIDAR_NEEDS_GPU();
    context_.emplace(std::nullopt);
    context_->make_current();
    beams_ = std::make_unique<gpu::DeviceBeams>();
    batch_ = std::make_unique<gpu::DeviceBatch>();
  }
  void TearDown() override {
    if (!context_) return;
    batch_.reset();
    beams_.reset();
    context_->release();
  }

  /// Casts on the device and by rays; expects equal bits of decided beams, of which at least half
  /// hit or miss as expected. Returns the share of undecided beams.
  double undecided_share(const Scene& scene, const CastRequest& request) {
    CpuBase base(scene, 2);
    const gpu::DeviceScene device(base.resolver, base.thread_pool);
    const opengl::Program program = gpu::make_cast_program(scene);
    glUseProgram(program.name());
    device.bind();
    base.resolver.set_poses(request.world_from_sensor, request.world_from_instance);
    base.search.prepare(request);
    EXPECT_TRUE(gpu::DeviceBatch::can_cast(request, base.search.trees()));
    batch_->clear();
    batch_->add(request, device, base.resolver, base.search.trees());
    batch_->start(request, true, *beams_);
    batch_->wait();
    glUseProgram(0);
    Hits rays;
    make_renderer(scene, {.kind = "rays", .threads = 2})->cast(request, rays);
    return compare(batch_->found(0), rays);
  }

  static double compare(const gpu::FoundHits& found, const Hits& rays) {
    std::size_t undecided = 0;
    std::size_t hits = 0;
    for (std::size_t i = 0; i < rays.primitive.size(); ++i) {
      const std::uint32_t primitive = found.ids[found.has_instances ? 2 * i : i];
      if (primitive == gpu::kUndecided) {
        ++undecided;
        continue;
      }
      EXPECT_EQ(primitive, rays.primitive[i]) << i;
      if (primitive == gpu::kNone) continue;
      ++hits;
      EXPECT_EQ(found.has_instances ? found.ids[2 * i + 1] : found.instance, rays.instance[i]) << i;
      EXPECT_EQ(std::bit_cast<std::uint64_t>(found.range_m[i]),
                std::bit_cast<std::uint64_t>(rays.range_m[i]))
          << i;
    }
    EXPECT_GT(hits, rays.primitive.size() / 20);
    return static_cast<double>(undecided) / static_cast<double>(rays.primitive.size());
  }

  /// Three objects of different sizes, one behind the other.
  static Scene several() {
    Scene scene = builtin_scene("torus");
    add_model(scene, make_builtin_model("box"));
    add_model(scene, make_builtin_model("sphere"));
    scene.instances[0].world_from_object = turned(0.7, {1.0, 2.0, 3.0}, {0.4, -0.2, 3.0});
    scene.instances[1].world_from_object = turned(1.9, {-1.0, 0.3, 0.1}, {-1.0, 0.5, 5.0});
    scene.instances[1].scale = 0.75;
    scene.instances[2].world_from_object.translation() = Eigen::Vector3d(1.5, 1.0, 6.0);
    scene.instances[2].scale = 1.7;
    return scene;
  }

  std::optional<opengl::EglContext> context_;
  std::unique_ptr<gpu::DeviceBeams> beams_;
  std::unique_ptr<gpu::DeviceBatch> batch_;
};

constexpr double kFew = 2e-3;

TEST_F(GpuBatch, TheDeviceDecidesNearlyAllBeamsOfACamera) {
  const Scene scene = builtin_scene("asteroid");
  const Pose pose = look_at({3.0, 1.0, 1.0}, {0.0, 0.0, 0.0}, Eigen::Vector3d::UnitZ());
  const Beams beams = camera_beams(160, 120, 150.0);
  EXPECT_LT(undecided_share(scene, {.beams = beams, .world_from_sensor = pose}), kFew);
  EXPECT_LT(
      undecided_share(scene, {.beams = beams, .world_from_sensor = pose, .cull_back_faces = true}),
      kFew);
}

TEST_F(GpuBatch, TheDeviceDecidesNearlyAllBeamsAmongInstances) {
  const Scene scene = several();
  const Beams camera = camera_beams(96, 96, 100.0);
  EXPECT_LT(undecided_share(scene, {.beams = camera}), kFew);
  Beams scanner = camera;
  scanner.pinhole.reset();
  scanner.rows = 1;
  scanner.cols = static_cast<std::uint32_t>(camera.size());
  for (std::size_t i = 0; i < camera.size(); ++i) {
    scanner.origins_m.emplace_back(1e-5 * static_cast<double>(i), 0.01, 0.0);
  }
  EXPECT_LT(undecided_share(scene, {.beams = scanner}), kFew);
  const std::vector<InstanceRange> targets(scanner.size(), {1, 3});
  EXPECT_LT(undecided_share(scene, {.beams = scanner, .targets = targets}), kFew);
}

TEST_F(GpuBatch, TheDeviceDecidesBeamsOnDoubledSurfaces) {
  Scene scene = builtin_scene("sphere");
  Mesh& mesh = scene.meshes[0];
  const std::vector<Triangle> once = mesh.triangles;
  for (const Triangle& t : once) mesh.triangles.push_back({t[1], t[0], t[2]});
  const Pose pose = look_at({2.0, 1.0, 1.5}, {0.0, 0.0, 0.0}, Eigen::Vector3d::UnitZ());
  const Beams beams = camera_beams(60, 60, 60.0);
  EXPECT_LT(undecided_share(scene, {.beams = beams, .world_from_sensor = pose}), kFew);
}

TEST_F(GpuBatch, LeavesBeamsOnAlphaMasksToTheProcessor) {
  Scene scene = builtin_scene("plane");
  scene.materials[scene.instances[0].materials[0]].alpha_cutoff = 0.5F;
  add_model(scene, make_builtin_model("box"));
  scene.instances[1].world_from_object.translation() = Eigen::Vector3d(0.0, 0.0, 2.0);
  scene.instances[1].scale = 0.2;
  const Pose pose = look_at({0.1, 0.0, 4.0}, {0.0, 0.0, 0.0}, Eigen::Vector3d::UnitY());
  const double share =
      undecided_share(scene, {.beams = camera_beams(60, 60, 120.0), .world_from_sensor = pose});
  EXPECT_GT(share, 0.1);  // the plane
  EXPECT_LT(share, 0.9);  // the box in front of it, and what is beside it
}

}  // namespace
}  // namespace glidar
