// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Needs a display: run under xvfb-run.
#include <apps/viewer/screen.hpp>
#include <glidar/core/error.hpp>
#include <glidar/io/model/model.hpp>
#include <glidar/render/gpu/gpu_renderer.hpp>
#include <glidar/simulate/simulator.hpp>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <gtest/gtest.h>
#include <imgui.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

namespace glidar::app {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr double kUnfreed_mb = 1e9;  // freed memory is not returned
constexpr std::uint32_t kPictures = 1'000;
#else
constexpr double kUnfreed_mb = 0.0;
constexpr std::uint32_t kPictures = 10'000;
#endif

constexpr double kMegabyte = 1048576.0;

/// Used memory and open files of this process.
struct Held {
  double megabytes = 0.0;
  std::ptrdiff_t files = 0;
};

Held held() {
  std::ifstream statm("/proc/self/statm");
  double pages = 0.0;
  double resident = 0.0;
  statm >> pages >> resident;
  const std::filesystem::directory_iterator files("/proc/self/fd");
  return {.megabytes = resident * 4096.0 / kMegabyte,
          .files = std::distance(begin(files), end(files))};
}

/// The context of a GLFW window, as from another program.
class GlfwContext final : public opengl::Context {
 public:
  GlfwContext() {
    glfwDefaultWindowHints();
    glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_CONTEXT_CREATION_API, GLFW_EGL_CONTEXT_API);
    window_ = glfwCreateWindow(64, 64, "hidden", nullptr, nullptr);
  }
  ~GlfwContext() override { glfwDestroyWindow(window_); }
  GlfwContext(const GlfwContext&) = delete;
  GlfwContext& operator=(const GlfwContext&) = delete;

  void make_current() override {
    before_ = glfwGetCurrentContext();
    glfwMakeContextCurrent(window_);
  }
  void release() override { glfwMakeContextCurrent(before_); }

 private:
  GLFWwindow* window_ = nullptr;
  GLFWwindow* before_ = nullptr;
};

WindowEvents no_events() {
  return {.on_letter = [](unsigned) {},
          .on_escape = [] {},
          .on_drop = [](const std::vector<std::string>&) {},
          .on_redraw = [] {}};
}

void draw_text(Window& window, const std::string& text) {
  window.begin();
  ImGui::Begin("panel");
  ImGui::TextUnformatted(text.c_str());
  ImGui::End();
  window.end();
  window.show();
}

class WindowTest : public ::testing::Test {
 protected:
  WindowSystem windows_;
};

TEST_F(WindowTest, CloudsAreTheSameWithTheContextOfAWindowAndWithout) {
  Scene scene;
  add_model(scene, load_model("builtin:asteroid", {}, {}));
  Sensor sensor;
  sensor.optics = pinhole_from_fov(96, 64, 0.5);
  const Motion motion =
      static_motion(scene, look_at({6.0, -4.0, 3.0}, {0.0, 0.0, 0.0}, Eigen::Vector3d::UnitZ()));
  const auto measured = [&](std::unique_ptr<Renderer> renderer) {
    Frame frame;
    Simulator(scene, sensor, *renderer).simulate(motion, kAllHitColumns, frame);
    return frame;
  };
  const Frame with = measured(make_gpu_renderer(scene, {}, std::make_unique<GlfwContext>()));
  const Frame without = measured(make_gpu_renderer(scene, {}));
  EXPECT_EQ(with.status, without.status);
  EXPECT_EQ(with.ground_truth.primitive, without.ground_truth.primitive);
  EXPECT_EQ(0, std::memcmp(with.range_m.data(), without.range_m.data(),
                           with.range_m.size() * sizeof(double)));
  EXPECT_EQ(with.intensity, without.intensity);
}

TEST_F(WindowTest, ImageHasTheDrawnPixels) {
  Window window("a window", {.width = 400, .height = 300}, no_events());
  for (int i = 0; i < 3; ++i) draw_text(window, "words");
  window.begin();
  ImGui::GetForegroundDrawList()->AddRectFilled(ImVec2(100, 50), ImVec2(200, 150),
                                                IM_COL32(10, 200, 30, 255));
  window.end();
  const Picture picture = window.picture();
  ASSERT_EQ(picture.width, 400U);
  ASSERT_EQ(picture.height, 300U);
  const auto at = [&](std::size_t x, std::size_t y) { return picture.pixels[y * 400 + x]; };
  EXPECT_EQ(at(150, 60).g, 200) << "rows count from the top";
  EXPECT_EQ(at(150, 160).g, at(399, 299).g);
}

TEST_F(WindowTest, FiftyWindowsLeakNothing) {
  const auto open_and_close = [] {
    Window window("one of many", {.width = 320, .height = 240}, no_events());
    Screen screen;
    draw_text(window, "words");
  };
  for (int i = 0; i < 10; ++i) open_and_close();  // memory that drivers keep
  const Held before = held();
  for (int i = 0; i < 50; ++i) open_and_close();
  const Held after = held();
  EXPECT_EQ(after.files, before.files);
  constexpr double kNoise_mb =
      8.0 + kUnfreed_mb;  // of a driver; the pixels of a leaked window need 0.3 MB
  EXPECT_LT(after.megabytes - before.megabytes, kNoise_mb);
}

TEST_F(WindowTest, TenThousandFramesLeakNothing) {
  Window window("a long run", {.width = 64, .height = 48}, no_events());  // pixels take time
  Console console(true);
  MeasurementThread measurements(console, WindowSystem::wake);
  RenderFlags flags;
  flags.input = "builtin:asteroid";
  flags.sensor.width = flags.sensor.height = 16;
  flags.motion.object_rate_rad_s = Eigen::Vector3d::UnitZ();
  Viewer viewer(flags, measurements);
  Screen screen;
  const auto draw = [&](std::uint32_t k) {
    viewer.show_frame(k);
    viewer.take_results();
    window.begin();
    screen.show(viewer, window.size(), {});
    window.end();
    window.show();
    WindowSystem::poll();
  };
  while (viewer.snapshot() == nullptr) viewer.take_results();
  for (std::uint32_t k = 0; k < 500; ++k) draw(k);
  const Held before = held();
  for (std::uint32_t k = 500; k < 500 + kPictures; ++k) draw(k);
  const Held after = held();
  EXPECT_EQ(after.files, before.files);
  constexpr double kNoise_mb = 8.0 + kUnfreed_mb;  // less than a kilobyte per frame
  EXPECT_LT(after.megabytes - before.megabytes, kNoise_mb);
  EXPECT_GT(viewer.snapshot()->request.number, 500U) << "measured all the while";
}

TEST(WindowSystem, ErrorNamesTheMissingDisplay) {
  ASSERT_EQ(setenv("DISPLAY", ":9999", 1), 0);
  try {
    const WindowSystem windows;
    FAIL() << "a display was found";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("xvfb-run"), std::string::npos);
  }
}

}  // namespace
}  // namespace glidar::app
