// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// How much of bare OpenGL's speed a cast keeps. The yardstick draws the same triangles into the
// same targets (a 32-bit number and a float depth per pixel) and reads the numbers back, no more.
// Meshes must stand at their zero in single precision, as the Stanford models do.
#include "ratio_reporter.hpp"

#include <glidar/io/model.hpp>
#include <glidar/render/opengl/egl_context.hpp>
#include <glidar/render/opengl/gl_object.hpp>
#include <glidar/simulate.hpp>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>

namespace glidar::bench {
namespace {

constexpr double kFov = 0.35;
constexpr unsigned kThreads = 2;

struct Model {
  std::string name;
  Scene scene;
  Pose world_from_sensor;

  Model(std::string model_name, const std::string& path) : name(std::move(model_name)) {
    add_model(scene, load_model(path, {}, {}));
    const Eigen::AlignedBox3d box = bounds(scene);
    const double distance = 0.55 * box.sizes().maxCoeff() / std::tan(kFov / 2.0);
    world_from_sensor = look_at(box.center() + distance * Eigen::Vector3d::UnitZ(), box.center(),
                                Eigen::Vector3d::UnitY());
  }
};

/// What a baseline draws, and how a pixel of it is stored.
struct Raw {
  const char* vertex;
  const char* fragment;
  GLenum stored;
  GLenum format;
  GLenum type;
};

constexpr Raw kNumbers = {R"(#version 330 core
layout(location = 0) in vec3 position;
uniform mat4 clip_from_object;
void main() { gl_Position = clip_from_object * vec4(position, 1.0); }
)",
                          R"(#version 330 core
layout(location = 0) out uint number;
void main() { number = uint(gl_PrimitiveID); }
)",
                          GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT};

/// The paper's shaders with nothing but what an untextured model needs.
constexpr Raw kPaper = {R"(#version 330 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
uniform mat4 clip_from_object;
uniform vec3 eye;
out vec3 n;
out vec3 l;
out float w;
void main() {
  gl_Position = clip_from_object * vec4(position, 1.0);
  n = normal;
  l = eye - position;
  w = gl_Position.w;
}
)",
                        R"(#version 330 core
in vec3 n;
in vec3 l;
in float w;
uniform vec2 planes;
layout(location = 0) out vec4 pixel;
void main() {
  float d = length(l);
  float a = 1.0 / (1.0 + 1e-4 * d + 1e-8 * d * d);
  float c = 0.16 + 0.8 * max(dot(normalize(n), l / d), 0.0);
  float steps = clamp(65536.0 * (w - planes.x) / (planes.y - planes.x), 0.0, 65535.0);
  float high = floor(steps / 256.0);
  pixel = vec4(a * c, high / 255.0, floor(steps - 256.0 * high) / 255.0, 1.0);
}
)",
                        GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE};

/// The baseline: OpenGL and nothing else.
class RawOpengl {
 public:
  RawOpengl(const Model& model, const Raw& raw, GLsizei side)
      : context_({}),
        use_(context_),
        raw_(raw),
        side_(side),
        pixels_(static_cast<std::size_t>(side) * static_cast<std::size_t>(side)) {
    const Mesh& mesh = model.scene.meshes[0];
    count_ = static_cast<GLsizei>(3 * mesh.triangles.size());
    objects_ = std::make_unique<Objects>();
    glBindVertexArray(objects_->arrays.name());
    give(0, objects_->positions, mesh.positions_m);
    give(1, objects_->normals, mesh.normals);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, objects_->triangles.name());
    glBufferData(GL_ELEMENT_ARRAY_BUFFER,
                 static_cast<GLsizeiptr>(mesh.triangles.size() * sizeof(Triangle)),
                 mesh.triangles.data(), GL_STATIC_DRAW);
    make_targets();
    make_program(model);
    glEnable(GL_DEPTH_TEST);
    glViewport(0, 0, side, side);
    opengl::check_gl("preparing the baseline");
  }

  void draw_and_read() {
    constexpr std::array<GLuint, 4> kNothing = {0xffffffffU, 0, 0, 0};
    constexpr std::array<GLfloat, 4> kBlack = {};
    constexpr GLfloat kFarthest = 1.0F;
    if (raw_.stored == GL_R32UI) {
      glClearBufferuiv(GL_COLOR, 0, kNothing.data());
    } else {
      glClearBufferfv(GL_COLOR, 0, kBlack.data());
    }
    glClearBufferfv(GL_DEPTH, 0, &kFarthest);
    glDrawElements(GL_TRIANGLES, count_, GL_UNSIGNED_INT, nullptr);
    glReadPixels(0, 0, side_, side_, raw_.format, raw_.type, pixels_.data());
  }

 private:
  struct Objects {
    opengl::VertexArray arrays;
    opengl::Buffer positions;
    opengl::Buffer normals;
    opengl::Buffer triangles;
    opengl::Framebuffer frame;
    opengl::Renderbuffer colours;
    opengl::Renderbuffer depths;
    opengl::Program program;
  };

  static void give(GLuint attribute, const opengl::Buffer& buffer,
                   const std::vector<Eigen::Vector3f>& values) {
    glBindBuffer(GL_ARRAY_BUFFER, buffer.name());
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(values.size() * sizeof(Eigen::Vector3f)),
                 values.data(), GL_STATIC_DRAW);
    glVertexAttribPointer(attribute, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
    glEnableVertexAttribArray(attribute);
  }

  void make_targets() {
    glBindFramebuffer(GL_FRAMEBUFFER, objects_->frame.name());
    glBindRenderbuffer(GL_RENDERBUFFER, objects_->colours.name());
    glRenderbufferStorage(GL_RENDERBUFFER, raw_.stored, side_, side_);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER,
                              objects_->colours.name());
    glBindRenderbuffer(GL_RENDERBUFFER, objects_->depths.name());
    glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT32F, side_, side_);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER,
                              objects_->depths.name());
  }

  void make_program(const Model& model) {
    for (const auto& [stage, text] :
         {std::pair{GL_VERTEX_SHADER, raw_.vertex}, std::pair{GL_FRAGMENT_SHADER, raw_.fragment}}) {
      const GLuint shader = glCreateShader(static_cast<GLenum>(stage));
      glShaderSource(shader, 1, &text, nullptr);
      glCompileShader(shader);
      glAttachShader(objects_->program.name(), shader);
      glDeleteShader(shader);
    }
    glLinkProgram(objects_->program.name());
    glUseProgram(objects_->program.name());
    const Eigen::Matrix4f matrix = clip_matrix(model).cast<float>();
    glUniformMatrix4fv(glGetUniformLocation(objects_->program.name(), "clip_from_object"), 1,
                       GL_FALSE, matrix.data());
    const Eigen::Vector3f eye = model.world_from_sensor.translation().cast<float>();
    glUniform3fv(glGetUniformLocation(objects_->program.name(), "eye"), 1, eye.data());
    const auto [near, far] = planes(model);
    glUniform2f(glGetUniformLocation(objects_->program.name(), "planes"), static_cast<float>(near),
                static_cast<float>(far));
  }

  static std::pair<double, double> planes(const Model& model) {
    const Eigen::AlignedBox3d box = bounds(model.scene);
    const double middle = (box.center() - model.world_from_sensor.translation()).norm();
    const double radius = 0.5 * box.diagonal().norm();
    return {middle - radius, middle + radius};
  }

  /// The usual perspective of OpenGL with planes around the model, rows downwards.
  static Eigen::Matrix4d clip_matrix(const Model& model) {
    const auto [near, far] = planes(model);
    const double focal = 1.0 / std::tan(kFov / 2.0);
    Eigen::Matrix4d clip = Eigen::Matrix4d::Zero();
    clip(0, 0) = focal;
    clip(1, 1) = focal;
    clip(2, 2) = (far + near) / (far - near);
    clip(2, 3) = -2.0 * far * near / (far - near);
    clip(3, 2) = 1.0;
    return clip * model.world_from_sensor.inverse().matrix();
  }

  opengl::EglContext context_;
  opengl::Use use_;
  const Raw& raw_;
  GLsizei side_;
  GLsizei count_ = 0;
  std::vector<std::uint32_t> pixels_;
  std::unique_ptr<Objects> objects_;
};

void register_raw(const std::string& name, const Model& model, const Raw& raw, std::uint32_t side) {
  benchmark::RegisterBenchmark(name.c_str(),
                               [&model, &raw, side](benchmark::State& state) {
                                 RawOpengl baseline(model, raw, static_cast<GLsizei>(side));
                                 for (auto _ : state) baseline.draw_and_read();
                               })
      ->MeasureProcessCPUTime()
      ->UseRealTime();
}

void register_cast(const std::string& name, const Model& model, const char* kind,
                   std::uint32_t side) {
  benchmark::RegisterBenchmark(name.c_str(),
                               [&model, side, kind](benchmark::State& state) {
                                 const auto renderer = make_renderer(
                                     model.scene, {.kind = kind, .threads = kThreads});
                                 const Beams beams = make_beams(pinhole_from_fov(side, side, kFov));
                                 Hits hits;
                                 for (auto _ : state) {
                                   renderer->cast({.beams = beams,
                                                   .world_from_sensor = model.world_from_sensor,
                                                   .fields = {.normal = true}},
                                                  hits);
                                 }
                               })
      ->MeasureProcessCPUTime()
      ->UseRealTime();
}

/// Draws the picture and decodes it.
void register_paper(const std::string& name, const Model& model, std::uint32_t side) {
  benchmark::RegisterBenchmark(
      name.c_str(),
      [&model, side](benchmark::State& state) {
        const auto camera = make_paper_camera(model.scene, {.threads = kThreads});
        const Beams beams = make_beams(pinhole_from_fov(side, side, kFov));
        Workers workers(kThreads);
        PaperPicture picture;
        std::vector<double> range_m(beams.size());
        std::vector<float> intensity(beams.size());
        const auto read = [&](std::size_t begin, std::size_t end) {
          decode(picture, beams, {begin, end}, range_m, intensity);
        };
        for (auto _ : state) {
          camera->draw({.beams = beams, .world_from_sensor = model.world_from_sensor}, {}, {},
                       picture);
          workers.for_ranges(beams.size(), 4096, read);
        }
      })
      ->MeasureProcessCPUTime()
      ->UseRealTime();
}

void register_model(const Model& model, std::uint32_t side, std::vector<Ratio>& ratios) {
  constexpr double kGoal = 0.85;
  const std::string at = model.name + " " + std::to_string(side) + " ";
  register_raw(at + "raw numbers", model, kNumbers, side);
  register_cast(at + "opengl", model, "opengl", side);
  register_cast(at + "embree", model, "embree", side);
  register_raw(at + "raw paper", model, kPaper, side);
  register_paper(at + "paper", model, side);
  ratios.push_back({at + "cast / raw OpenGL", at + "raw numbers", at + "opengl", kGoal});
  ratios.push_back({at + "paper target / raw OpenGL", at + "raw paper", at + "paper", kGoal});
  ratios.push_back({at + "opengl / embree", at + "embree", at + "opengl", 0.0});
}

}  // namespace
}  // namespace glidar::bench

int main(int argc, char** argv) {
  using glidar::bench::Model;
  const char* data = std::getenv("GLIDAR_DATA");
  std::vector<std::unique_ptr<Model>> models;
  if (data != nullptr) {
    const std::string stanford = std::string(data) + "/models/stanford/";
    models.push_back(std::make_unique<Model>("bunny", stanford + "bun_zipper.ply"));
    models.push_back(std::make_unique<Model>("dragon", stanford + "dragon/dragon_vrip_binary.ply"));
  } else {
    std::puts("GLIDAR_DATA is not set: the built-in asteroid stands in for the Stanford models");
    models.push_back(std::make_unique<Model>("asteroid", "builtin:asteroid"));
  }
  std::vector<glidar::bench::Ratio> ratios;
  for (const auto& model : models) {
    for (const std::uint32_t side : {256U, 512U, 1024U}) register_model(*model, side, ratios);
  }
  return glidar::bench::run(argc, argv, ratios);
}
