// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// The gpu renderer only: selection of devices, and many renderers at a time.
#include <glidar/core/error.hpp>
#include <glidar/render/opengl/egl_context.hpp>
#include <render/renderer_suite.hpp>
#include <support/error_text.hpp>

namespace glidar {
namespace {

using testing::builtin_scene;
using testing::camera_beams;

class GpuRenderer : public ::testing::Test {
 protected:
  void SetUp() override { GLIDAR_NEEDS_GPU(); }
};

TEST_F(GpuRenderer, AnUnknownDeviceIsAnErrorThatListsTheDevices) {
  const std::vector<std::string> devices = opengl::graphics_devices();
  if (devices.empty()) GTEST_SKIP() << "this EGL does not list devices; install libegl-mesa0";
  const Scene scene;
  const std::string text = error_text(
      [&] { make_renderer(scene, {.kind = "gpu", .threads = 1, .graphics_device = 1000}); });
  EXPECT_EQ(text.rfind("graphics device: 1000; allowed: 0: " + devices[0], 0), 0U) << text;
}

TEST_F(GpuRenderer, ManyRenderersCanCastInTurns) {
  const Scene scene = builtin_scene("box");
  const Beams beams = camera_beams(8, 8, 8.0);
  const auto first = make_renderer(scene, {.kind = "gpu", .threads = 1});
  Hits hits;
  for (int i = 0; i < 20; ++i) {
    const auto other = make_renderer(scene, {.kind = "gpu", .threads = 1});
    other->cast({.beams = beams, .hit_columns = {}}, hits);
    const Hits theirs = hits;
    first->cast({.beams = beams, .hit_columns = {}}, hits);
    EXPECT_EQ(hits.primitive, theirs.primitive);
  }
}

TEST_F(GpuRenderer, CastsMoreViewsThanGroupsAlongADimension) {
  const Scene scene = builtin_scene("box");
  const Beams beams = camera_beams(1, 1, 8.0);
  constexpr std::size_t kViews = 65537;
  std::vector<Hits> hits(kViews);
  std::vector<Hits*> to;
  for (Hits& one : hits) to.push_back(&one);
  const std::vector<CastRequest> requests(kViews, {.beams = beams, .hit_columns = {}});
  make_renderer(scene, {.kind = "gpu", .threads = 1})->cast_batch(requests, to);
  for (const Hits& one : hits) ASSERT_EQ(one.primitive, hits.front().primitive);
  Hits rays;
  make_renderer(scene, {.kind = "rays", .threads = 1})->cast(requests.front(), rays);
  EXPECT_EQ(hits.front().primitive, rays.primitive);
}

TEST(GpuDevice, OneSentenceSaysWhatItLacks) {
  GLIDAR_NEEDS_OPENGL();
  const std::string& missing = testing::missing_gpu();
  if (missing.empty()) GTEST_SKIP() << "this device has all that gpu needs; nothing to do";
  EXPECT_EQ(missing.rfind("gpu renderer: ", 0), 0U) << missing;
  EXPECT_NE(missing.find(" has OpenGL 3.3; allowed: OpenGL 4.3 with compute shaders"),
            std::string::npos)
      << missing;
  EXPECT_NE(missing.find("--renderer rays"), std::string::npos) << missing;
}

}  // namespace
}  // namespace glidar
