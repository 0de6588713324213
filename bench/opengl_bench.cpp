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

constexpr const char* kVertex = R"(#version 330 core
layout(location = 0) in vec3 position;
uniform mat4 clip_from_object;
void main() { gl_Position = clip_from_object * vec4(position, 1.0); }
)";
constexpr const char* kFragment = R"(#version 330 core
layout(location = 0) out uint number;
void main() { number = uint(gl_PrimitiveID); }
)";

/// The baseline: OpenGL and nothing else.
class RawOpengl {
 public:
  RawOpengl(const Model& model, GLsizei side)
      : context_({}), use_(context_), side_(side), numbers_(static_cast<std::size_t>(side) * side) {
    const Mesh& mesh = model.scene.meshes[0];
    count_ = static_cast<GLsizei>(3 * mesh.triangles.size());
    objects_ = std::make_unique<Objects>();
    glBindVertexArray(objects_->arrays.name());
    glBindBuffer(GL_ARRAY_BUFFER, objects_->positions.name());
    glBufferData(GL_ARRAY_BUFFER,
                 static_cast<GLsizeiptr>(mesh.positions_m.size() * sizeof(Eigen::Vector3f)),
                 mesh.positions_m.data(), GL_STATIC_DRAW);
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
    glEnableVertexAttribArray(0);
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
    constexpr GLuint kNothing = 0xffffffffU;
    constexpr GLfloat kFarthest = 1.0F;
    glClearBufferuiv(GL_COLOR, 0, &kNothing);
    glClearBufferfv(GL_DEPTH, 0, &kFarthest);
    glDrawElements(GL_TRIANGLES, count_, GL_UNSIGNED_INT, nullptr);
    glReadPixels(0, 0, side_, side_, GL_RED_INTEGER, GL_UNSIGNED_INT, numbers_.data());
  }

 private:
  struct Objects {
    opengl::VertexArray arrays;
    opengl::Buffer positions;
    opengl::Buffer triangles;
    opengl::Framebuffer frame;
    opengl::Renderbuffer numbers;
    opengl::Renderbuffer depths;
    opengl::Program program;
  };

  void make_targets() {
    glBindFramebuffer(GL_FRAMEBUFFER, objects_->frame.name());
    glBindRenderbuffer(GL_RENDERBUFFER, objects_->numbers.name());
    glRenderbufferStorage(GL_RENDERBUFFER, GL_R32UI, side_, side_);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER,
                              objects_->numbers.name());
    glBindRenderbuffer(GL_RENDERBUFFER, objects_->depths.name());
    glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT32F, side_, side_);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER,
                              objects_->depths.name());
  }

  void make_program(const Model& model) {
    for (const auto& [stage, text] :
         {std::pair{GL_VERTEX_SHADER, kVertex}, std::pair{GL_FRAGMENT_SHADER, kFragment}}) {
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
  }

  /// The usual perspective of OpenGL with planes around the model, rows downwards.
  static Eigen::Matrix4d clip_matrix(const Model& model) {
    const Eigen::AlignedBox3d box = bounds(model.scene);
    const double middle = (box.center() - model.world_from_sensor.translation()).norm();
    const double radius = 0.5 * box.diagonal().norm();
    const double near = middle - radius;
    const double far = middle + radius;
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
  opengl::EglContext::Use use_;
  GLsizei side_;
  GLsizei count_ = 0;
  std::vector<std::uint32_t> numbers_;
  std::unique_ptr<Objects> objects_;
};

void register_model(const Model& model, std::uint32_t side, std::vector<Ratio>& ratios) {
  const std::string at = model.name + " " + std::to_string(side) + " ";
  benchmark::RegisterBenchmark((at + "raw").c_str(), [&model, side](benchmark::State& state) {
    RawOpengl raw(model, static_cast<GLsizei>(side));
    for (auto _ : state) raw.draw_and_read();
  })->UseRealTime();
  for (const char* kind : {"opengl", "embree"}) {
    benchmark::RegisterBenchmark((at + kind).c_str(), [&model, side,
                                                       kind](benchmark::State& state) {
      const auto renderer = make_renderer(model.scene, {.kind = kind, .threads = kThreads});
      const Beams beams = make_beams(pinhole_from_fov(side, side, kFov));
      Hits hits;
      for (auto _ : state) {
        renderer->cast({.beams = beams,
                        .world_from_sensor = model.world_from_sensor,
                        .fields = {.normal = true}},
                       hits);
      }
    })->UseRealTime();
  }
  ratios.push_back({at + "cast / raw OpenGL", at + "raw", at + "opengl", 0.85});
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
