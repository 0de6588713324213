// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// OpenGL only: selection of devices, and many renderers at a time.
#include <glidar/core/error.hpp>
#include <glidar/render/opengl/egl_context.hpp>
#include <render/renderer_suite.hpp>
#include <support/error_text.hpp>

namespace glidar {
namespace {

using testing::builtin_scene;
using testing::camera_beams;

class OpenglRenderer : public ::testing::Test {
 protected:
  void SetUp() override { GLIDAR_NEEDS_OPENGL(); }
};

TEST_F(OpenglRenderer, AnUnknownDeviceIsAnErrorThatListsTheDevices) {
  const std::vector<std::string> devices = opengl::graphics_devices();
  if (devices.empty()) GTEST_SKIP() << "this EGL does not list devices; install libegl-mesa0";
  const Scene scene;
  const std::string text = error_text(
      [&] { make_renderer(scene, {.kind = "opengl", .threads = 1, .graphics_device = 1000}); });
  EXPECT_EQ(text.rfind("graphics device: 1000; allowed: 0: " + devices[0], 0), 0U) << text;
}

TEST_F(OpenglRenderer, ManyRenderersCanDrawInTurns) {
  const Scene scene = builtin_scene("box");
  const Beams beams = camera_beams(8, 8, 8.0);
  const auto first = make_renderer(scene, {.kind = "opengl", .threads = 1});
  Hits hits;
  for (int i = 0; i < 20; ++i) {
    const auto other = make_renderer(scene, {.kind = "opengl", .threads = 1});
    other->cast({.beams = beams, .hit_columns = {}}, hits);
    const Hits theirs = hits;
    first->cast({.beams = beams, .hit_columns = {}}, hits);
    EXPECT_EQ(hits.primitive, theirs.primitive);
  }
}

}  // namespace
}  // namespace glidar
