// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "raw_opengl.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace glidar::bench {

Model::Model(std::string model_name, const std::string& path) : name(std::move(model_name)) {
  add_model(scene, load_model(path, {}, {}));
  const Eigen::AlignedBox3d box = bounds(scene);
  const double distance = 0.55 * box.sizes().maxCoeff() / std::tan(kFov_rad / 2.0);
  world_from_sensor = look_at(box.center() + distance * Eigen::Vector3d::UnitZ(), box.center(),
                              Eigen::Vector3d::UnitY());
}

std::vector<std::unique_ptr<Model>> models() {
  std::vector<std::unique_ptr<Model>> all;
  if (const char* data = std::getenv("GLIDAR_DATA"); data != nullptr) {
    const std::string stanford = std::string(data) + "/models/stanford/";
    all.push_back(std::make_unique<Model>("bunny", stanford + "bun_zipper.ply"));
    all.push_back(std::make_unique<Model>("dragon", stanford + "dragon/dragon_vrip_binary.ply"));
  } else {
    std::puts("GLIDAR_DATA is not set: the built-in asteroid replaces the Stanford models");
    all.push_back(std::make_unique<Model>("asteroid", "builtin:asteroid"));
  }
  return all;
}

std::optional<std::uint32_t> chosen_device() {
  const char* index = std::getenv("GLIDAR_GRAPHICS_DEVICE");
  if (index == nullptr) return {};
  return static_cast<std::uint32_t>(std::stoul(index));
}

std::pair<double, double> planes_around(const Model& model) {
  const Eigen::AlignedBox3d box = bounds(model.scene);
  const double middle = (box.center() - model.world_from_sensor.translation()).norm();
  const double radius = 0.5 * box.diagonal().norm();
  return {middle - radius, middle + radius};
}

Eigen::Matrix4f clip_matrix(const Model& model, double near_m, double far_m) {
  const double focal = 1.0 / std::tan(kFov_rad / 2.0);
  Eigen::Matrix4d clip = Eigen::Matrix4d::Zero();
  clip(0, 0) = focal;
  clip(1, 1) = focal;
  clip(2, 2) = (far_m + near_m) / (far_m - near_m);
  clip(2, 3) = -2.0 * far_m * near_m / (far_m - near_m);
  clip(3, 2) = 1.0;
  return (clip * model.world_from_sensor.inverse().matrix()).cast<float>();
}

const Raw kRawNumbers = {R"(#version 330 core
layout(location = 0) in vec3 position;
uniform mat4 clip_from_object;
void main() { gl_Position = clip_from_object * vec4(position, 1.0); }
)",
                         R"(#version 330 core
layout(location = 0) out uint number;
void main() { number = uint(gl_PrimitiveID); }
)",
                         GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT};

const Raw kRawFramebuffer = {R"(#version 330 core
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

void compile(const opengl::Program& program,
             std::initializer_list<std::pair<GLenum, const char*>> stages) {
  for (const auto& [stage, text] : stages) {
    const GLuint shader = glCreateShader(stage);
    glShaderSource(shader, 1, &text, nullptr);
    glCompileShader(shader);
    glAttachShader(program.name(), shader);
    glDeleteShader(shader);
  }
  glLinkProgram(program.name());
  opengl::check_gl("compiling a baseline");
}

namespace {

void give(GLuint attribute, const opengl::Buffer& buffer,
          const std::vector<Eigen::Vector3f>& values) {
  glBindBuffer(GL_ARRAY_BUFFER, buffer.name());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(values.size() * sizeof(Eigen::Vector3f)),
               values.data(), GL_STATIC_DRAW);
  glVertexAttribPointer(attribute, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
  glEnableVertexAttribArray(attribute);
}

}  // namespace

RawOpengl::RawOpengl(const Model& model, const Raw& raw, std::uint32_t side)
    : model_(model),
      context_(chosen_device()),
      use_(context_),
      raw_(raw),
      side_(static_cast<GLsizei>(side)),
      count_(static_cast<GLsizei>(3 * model.scene.meshes[0].triangles.size())),
      pixels_(std::size_t{side} * side),
      objects_(std::make_unique<Objects>()) {
  const Mesh& mesh = model.scene.meshes[0];
  glBindVertexArray(objects_->arrays.name());
  give(0, objects_->positions, mesh.positions_m);
  give(1, objects_->normals, mesh.normals);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, objects_->triangles.name());
  glBufferData(GL_ELEMENT_ARRAY_BUFFER,
               static_cast<GLsizeiptr>(mesh.triangles.size() * sizeof(Triangle)),
               mesh.triangles.data(), GL_STATIC_DRAW);
  make_targets();
  compile(objects_->program, {{GL_VERTEX_SHADER, raw.vertex}, {GL_FRAGMENT_SHADER, raw.fragment}});
  glUseProgram(objects_->program.name());
  const auto [near_m, far_m] = planes_around(model);
  set_planes(near_m, far_m);
  glEnable(GL_DEPTH_TEST);
  glViewport(0, 0, side_, side_);
  opengl::check_gl("preparing the baseline");
}

void RawOpengl::draw() {
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
}

void RawOpengl::draw_and_read() {
  draw();
  glReadPixels(0, 0, side_, side_, raw_.format, raw_.type, pixels_.data());
}

void RawOpengl::make_targets() {
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

void RawOpengl::set_planes(double near_m, double far_m) {
  const auto at = [&](const char* name) {
    return glGetUniformLocation(objects_->program.name(), name);
  };
  const Eigen::Matrix4f matrix = clip_matrix(model_, near_m, far_m);
  const Eigen::Vector3f eye = model_.world_from_sensor.translation().cast<float>();
  glUniformMatrix4fv(at("clip_from_object"), 1, GL_FALSE, matrix.data());
  glUniform3fv(at("eye"), 1, eye.data());
  glUniform2f(at("planes"), static_cast<float>(near_m), static_cast<float>(far_m));
}

}  // namespace glidar::bench
