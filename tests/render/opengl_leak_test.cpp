// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Memory and open files stay constant, however many frames are drawn or renderers are created.
#include <glidar/render/woods2016_camera.hpp>
#include <render/renderer_suite.hpp>

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>

namespace glidar {
namespace {

using testing::builtin_scene;
using testing::camera_beams;

/// Memory and open files of the process.
struct Held {
  double memory_MiB;
  std::ptrdiff_t files;
};

Held held() {
  std::ifstream file("/proc/self/statm");
  double all_pages = 0.0;
  double pages = 0.0;
  file >> all_pages >> pages;
  const std::filesystem::directory_iterator files("/proc/self/fd");
  return {pages * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1048576.0,
          std::distance(begin(files), end(files))};
}

class OpenglLeak : public ::testing::Test {
 protected:
  void SetUp() override { GLIDAR_NEEDS_OPENGL(); }

  /// Runs a function some times to warm up, then many times more, and expects no growth.
  static void expect_flat(int warm_up, int times, double allowance_MiB, const auto& action) {
    for (int i = 0; i < warm_up; ++i) action(i);
    const Held before = held();
    for (int i = 0; i < times; ++i) action(i);
    const Held after = held();
    EXPECT_EQ(after.files, before.files);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // they keep what was freed
    EXPECT_LT(after.memory_MiB - before.memory_MiB, allowance_MiB);
#endif
  }

  Scene scene_ = builtin_scene("box");
  Beams beams_ = camera_beams(16, 16, 12.0);
  Pose pose_ = look_at({4.0, 3.0, 2.0}, {0.0, 0.0, 0.0}, Eigen::Vector3d::UnitZ());
};

TEST_F(OpenglLeak, MemoryStaysConstantOverTenThousandFrames) {
  const auto renderer = make_renderer(scene_, {.kind = "gpu", .threads = 1});
  Hits hits;
  expect_flat(1000, 10'000, 1.0, [&](int /*frame*/) {
    renderer->cast({.beams = beams_, .world_from_sensor = pose_, .hit_columns = kAllHitColumns},
                   hits);
  });
}

TEST_F(OpenglLeak, MemoryStaysConstantOverBatchesAndResizes) {
  const auto renderer = make_renderer(scene_, {.kind = "gpu", .threads = 1});
  const Beams wide = camera_beams(40, 10, 12.0);
  std::vector<Hits> all(6);
  std::vector<Hits*> hits;
  for (Hits& h : all) hits.push_back(&h);
  expect_flat(100, 500, 1.0, [&](int frame) {
    const Beams& first = frame % 2 == 0 ? beams_ : wide;
    const CastRequest one{.beams = first, .world_from_sensor = pose_, .hit_columns = {}};
    const CastRequest other{.beams = wide, .world_from_sensor = pose_, .hit_columns = {}};
    renderer->cast_batch(std::vector<CastRequest>{one, one, other, one, other, other}, hits);
  });
}

TEST_F(OpenglLeak, MemoryStaysConstantOverTenThousandFramebuffers) {
  const auto camera = make_woods2016_camera(scene_, {.threads = 1});
  Woods2016Framebuffer framebuffer;
  expect_flat(1000, 10'000, 1.0, [&](int /*frame*/) {
    camera->draw({.beams = beams_, .world_from_sensor = pose_}, {}, {}, framebuffer);
  });
}

// Drivers keep some memory per context; a scene takes much more.
constexpr double kPerContext_MiB = 0.03;

TEST_F(OpenglLeak, MemoryStaysConstantOverAHundredRenderers) {
  Hits hits;
  expect_flat(10, 100, 100 * kPerContext_MiB, [&](int /*frame*/) {
    make_renderer(scene_, {.kind = "gpu", .threads = 1})
        ->cast({.beams = beams_, .world_from_sensor = pose_, .hit_columns = {}}, hits);
  });
}

TEST_F(OpenglLeak, MemoryStaysConstantOverAHundredFramebufferCameras) {
  Woods2016Framebuffer framebuffer;
  expect_flat(10, 100, 100 * kPerContext_MiB, [&](int /*frame*/) {
    make_woods2016_camera(scene_, {.threads = 1})
        ->draw({.beams = beams_, .world_from_sensor = pose_}, {}, {}, framebuffer);
  });
}

}  // namespace
}  // namespace glidar
