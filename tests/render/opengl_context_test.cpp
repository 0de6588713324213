// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Drawing in a context that the application created, uses and changes.
#include <glidar/render/gpu/gpu_renderer.hpp>
#include <glidar/render/opengl/egl_context.hpp>
#include <glidar/render/opengl/gl_object.hpp>
#include <glidar/render/woods2016_camera.hpp>
#include <render/renderer_suite.hpp>
#include <support/error_text.hpp>

#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <array>

namespace glidar {
namespace {

using testing::builtin_scene;
using testing::camera_beams;

/// A context that several clients share, such as that of a window.
class SharedContext final : public opengl::Context {
 public:
  SharedContext(opengl::EglContext& shared, int& uses) : shared_(shared), uses_(uses) {}
  void make_current() override {
    ++uses_;
    shared_.make_current();
  }
  void release() override { shared_.release(); }

 private:
  opengl::EglContext& shared_;
  int& uses_;
};

class NoContext final : public opengl::Context {
 public:
  void make_current() override { throw Error({.where = "window", .found = "it is closed"}); }
  void release() override {}
};

class OpenglContext : public ::testing::Test {
 protected:
  void SetUp() override {
    GLIDAR_NEEDS_GPU();
    scene_ = builtin_scene("torus");
    pose_ = look_at({4.0, 3.0, 2.0}, {0.0, 0.0, 0.0}, Eigen::Vector3d::UnitZ());
    window_ = std::make_unique<opengl::EglContext>(std::nullopt);
  }

  [[nodiscard]] CastRequest request() const {
    return {.beams = beams_, .world_from_sensor = pose_, .hit_columns = {}};
  }
  std::unique_ptr<opengl::Context> shared() {
    return std::make_unique<SharedContext>(*window_, uses_);
  }
  std::unique_ptr<Renderer> renderer() {
    return make_gpu_renderer(scene_, {.threads = 1}, shared());
  }
  [[nodiscard]] std::vector<std::uint32_t> expected() const {
    Hits hits;
    make_gpu_renderer(scene_, {.threads = 1})->cast(request(), hits);
    return hits.primitive;
  }

  Scene scene_;
  Pose pose_;
  Beams beams_ = camera_beams(61, 43, 60.0);
  std::unique_ptr<opengl::EglContext> window_;
  int uses_ = 0;
};

TEST_F(OpenglContext, ASharedContextDrawsTheSameHitsAndFramebuffer) {
  const std::unique_ptr<Renderer> theirs = renderer();
  const auto camera = make_woods2016_camera(scene_, {.threads = 1}, shared());
  Hits hits;
  Woods2016Framebuffer framebuffer;
  for (int frame = 0; frame < 3; ++frame) {  // in turns
    theirs->cast(request(), hits);
    camera->draw(request(), {}, {}, framebuffer);
  }
  EXPECT_GT(uses_, 6);
  EXPECT_EQ(hits.primitive, expected());
  Woods2016Framebuffer own;
  make_woods2016_camera(scene_, {.threads = 1})->draw(request(), {}, {}, own);
  EXPECT_EQ(framebuffer.rgba, own.rgba);
}

TEST_F(OpenglContext, ThePreviousContextAndSurfaceAreRestored) {
  opengl::EglContext other({});
  const opengl::ScopedContext use(other);
  const EGLDisplay display = eglGetCurrentDisplay();
  const EGLContext context = eglGetCurrentContext();
  constexpr std::array<EGLint, 5> kPbuffer = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT,
                                              EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
  constexpr std::array<EGLint, 5> kSize = {EGL_WIDTH, 8, EGL_HEIGHT, 8, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  EGLSurface surface = EGL_NO_SURFACE;  // of a window; not every device has any
  if (eglChooseConfig(display, kPbuffer.data(), &config, 1, &count) == EGL_TRUE && count == 1) {
    surface = eglCreatePbufferSurface(display, config, kSize.data());
    ASSERT_EQ(eglMakeCurrent(display, surface, surface, context), EGL_TRUE);
  }
  Hits hits;
  {
    const std::unique_ptr<Renderer> own = make_gpu_renderer(scene_, {.threads = 1});
    own->cast(request(), hits);
    renderer()->cast(request(), hits);
    EXPECT_EQ(eglGetCurrentContext(), context);
  }
  EXPECT_EQ(eglGetCurrentContext(), context);
  EXPECT_EQ(eglGetCurrentSurface(EGL_DRAW), surface);
  EXPECT_EQ(eglGetCurrentSurface(EGL_READ), surface);
}

TEST_F(OpenglContext, NoContextIsCurrentAfterwardsIfNoneWasBefore) {
  Hits hits;
  renderer()->cast(request(), hits);
  EXPECT_EQ(eglGetCurrentContext(), EGL_NO_CONTEXT);
}

TEST_F(OpenglContext, ResultsDoNotDependOnThePreviousState) {
  const std::unique_ptr<Renderer> theirs = renderer();
  const auto camera = make_woods2016_camera(scene_, {.threads = 1}, shared());
  Woods2016Framebuffer before;
  camera->draw(request(), {}, {}, before);
  GLuint sampler = 0;
  {
    const opengl::ScopedContext use(*window_);
    for (const GLenum feature : {GL_SCISSOR_TEST, GL_BLEND, GL_CULL_FACE, GL_STENCIL_TEST,
                                 GL_RASTERIZER_DISCARD, GL_COLOR_LOGIC_OP, GL_PRIMITIVE_RESTART}) {
      glEnable(feature);
    }
    glScissor(0, 0, 1, 1);
    glColorMask(GL_FALSE, GL_TRUE, GL_FALSE, GL_TRUE);
    glDepthMask(GL_FALSE);
    glDepthRange(0.5, 0.5);
    glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
    glPixelStorei(GL_PACK_ROW_LENGTH, 1000);
    glPixelStorei(GL_PACK_SKIP_ROWS, 3);
    glGenSamplers(1, &sampler);
    glBindSampler(0, sampler);
  }
  Hits hits;
  theirs->cast(request(), hits);
  EXPECT_EQ(hits.primitive, expected());
  Woods2016Framebuffer framebuffer;
  camera->draw(request(), {}, {}, framebuffer);
  EXPECT_EQ(framebuffer.rgba, before.rgba);
}

TEST_F(OpenglContext, DrawingResetsTheStateThatItChanges) {
  const std::unique_ptr<Renderer> theirs = renderer();
  Hits hits;
  theirs->cast(request(), hits);
  const opengl::ScopedContext use(*window_);
  const auto value = [](GLenum name) {
    GLint found = 0;
    glGetIntegerv(name, &found);
    return found;
  };
  EXPECT_EQ(glIsEnabled(GL_DEPTH_TEST), GL_FALSE);
  EXPECT_EQ(glIsEnabled(GL_CULL_FACE), GL_FALSE);
  EXPECT_EQ(value(GL_DEPTH_FUNC), GL_LESS);
  EXPECT_EQ(value(GL_FRONT_FACE), GL_CCW);
  for (const GLenum binding :
       {GL_DRAW_FRAMEBUFFER_BINDING, GL_READ_FRAMEBUFFER_BINDING, GL_CURRENT_PROGRAM,
        GL_VERTEX_ARRAY_BINDING, GL_PIXEL_PACK_BUFFER_BINDING}) {
    EXPECT_EQ(value(binding), 0);
  }
  EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
}

TEST_F(OpenglContext, AContextThatCannotBeCurrentIsAnError) {
  EXPECT_EQ(
      error_text([&] { make_gpu_renderer(scene_, {.threads = 1}, std::make_unique<NoContext>()); }),
      "window: it is closed");
}

TEST_F(OpenglContext, ReportsDeviceResetsIfTheDriverDoes) {
  const opengl::ScopedContext use(*window_);
  opengl::check_not_lost();
  if (epoxy_gl_version() < 45)
    GTEST_SKIP() << "this driver need not report resets; use one of OpenGL 4.5";
  GLint strategy = 0;
  glGetIntegerv(GL_RESET_NOTIFICATION_STRATEGY, &strategy);
  EXPECT_EQ(strategy, GL_LOSE_CONTEXT_ON_RESET);
}

TEST(OpenglReset, ReportsTheCauseAndARemedy) {
  const auto text = [](GLenum status) { return error_text([&] { opengl::check_reset(status); }); };
  EXPECT_EQ(text(GL_NO_ERROR), "no error");
  EXPECT_EQ(text(GL_UNKNOWN_CONTEXT_RESET),
            "OpenGL: the graphics device was reset: its context is lost, with the frame under way; "
            "make a new renderer, or start again; if it comes back, update the driver, choose "
            "another --graphics-device, or use --renderer rays");
  EXPECT_NE(text(GL_GUILTY_CONTEXT_RESET).find("because of what was drawn"), std::string::npos);
  EXPECT_NE(text(GL_INNOCENT_CONTEXT_RESET).find("because of another program"), std::string::npos);
}

}  // namespace
}  // namespace glidar
