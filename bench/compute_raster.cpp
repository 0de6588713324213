// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "compute_raster.hpp"

#include <string>

namespace glidar::bench {
namespace {

constexpr GLuint kGroup = 128;
constexpr const char* kHead = R"(#version 430 core
layout(local_size_x = 128) in;
layout(std430, binding = 0) readonly buffer Positions { float positions[]; };
layout(std430, binding = 1) readonly buffer Corners { uint corners[]; };
layout(std430, binding = 2) buffer Placed { vec4 placed[]; };
layout(std430, binding = 3) buffer Depths { uint depths[]; };
layout(std430, binding = 4) buffer Numbers { uint numbers[]; };
layout(location = 0) uniform mat4 clip_from_object;
layout(location = 1) uniform uint side;
layout(location = 2) uniform uint count;
)";

constexpr const char* kPlace = R"(
void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= count) return;
  vec4 clip = clip_from_object *
              vec4(positions[3 * i], positions[3 * i + 1], positions[3 * i + 2], 1.0);
  placed[i] = vec4((clip.xy / clip.w * 0.5 + 0.5) * float(side), clip.z / clip.w * 0.5 + 0.5, clip.w);
}
)";

// A pixel is inside when no edge has it on the other side than the third corner. Depths are
// positive, so that their bits are in order.
constexpr const char* kCover = R"(
float cross_of(precise vec2 a, precise vec2 b) { return a.x * b.y - a.y * b.x; }

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= count) return;
  vec4 a = placed[corners[3 * i]];
  vec4 b = placed[corners[3 * i + 1]];
  vec4 c = placed[corners[3 * i + 2]];
  if (min(a.w, min(b.w, c.w)) <= 0.0) return;
  float area = cross_of(b.xy - a.xy, c.xy - a.xy);
  if (area == 0.0) return;
  ivec2 first = max(ivec2(ceil(min(a.xy, min(b.xy, c.xy)) - 0.5)), ivec2(0));
  ivec2 last = min(ivec2(floor(max(a.xy, max(b.xy, c.xy)) - 0.5)), ivec2(int(side) - 1));
  for (int y = first.y; y <= last.y; ++y) {
    for (int x = first.x; x <= last.x; ++x) {
      vec2 p = vec2(x, y) + 0.5;
      precise float at_b = cross_of(p - a.xy, c.xy - a.xy) / area;
      precise float at_c = cross_of(b.xy - a.xy, p - a.xy) / area;
      if (min(at_b, at_c) < 0.0 || at_b + at_c > 1.0) continue;
      precise float z = a.z + at_b * (b.z - a.z) + at_c * (c.z - a.z);
      uint depth = floatBitsToUint(max(z, 0.0));
      uint pixel = uint(y) * side + uint(x);
      MARK
    }
  }
}
)";

std::string cover(const char* mark) {
  std::string text = kCover;
  return std::string(kHead) + text.replace(text.find("MARK"), 4, mark);
}

template <class Value>
void fill(const opengl::Buffer& buffer, const std::vector<Value>& values) {
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffer.name());
  glBufferData(GL_SHADER_STORAGE_BUFFER, static_cast<GLsizeiptr>(values.size() * sizeof(Value)),
               values.data(), GL_STATIC_DRAW);
}

}  // namespace

bool ComputeRaster::is_possible() {
  constexpr int kLeast = 43;
  return epoxy_gl_version() >= kLeast;
}

ComputeRaster::ComputeRaster(const Model& model, std::uint32_t side)
    : context_(chosen_device()),
      use_(context_),
      side_(side),
      vertices_(model.scene.meshes[0].positions_m.size()),
      triangles_(model.scene.meshes[0].triangles.size()),
      pixels_(std::size_t{side} * side),
      objects_(std::make_unique<Objects>()) {
  fill(objects_->buffers[0], model.scene.meshes[0].positions_m);
  fill(objects_->buffers[1], model.scene.meshes[0].triangles);
  fill(objects_->buffers[2], std::vector<Eigen::Vector4f>(vertices_));
  fill(objects_->buffers[3], pixels_);
  fill(objects_->buffers[4], pixels_);
  const std::string place = std::string(kHead) + kPlace;
  const std::string depth = cover("atomicMin(depths[pixel], depth);");
  const std::string number = cover("if (depths[pixel] == depth) atomicMin(numbers[pixel], i);");
  const auto [near_m, far_m] = planes_around(model);
  const Eigen::Matrix4f matrix = clip_matrix(model, near_m, far_m);
  const std::array<const char*, 3> texts = {place.c_str(), depth.c_str(), number.c_str()};
  for (std::size_t i = 0; i < texts.size(); ++i) {
    compile(objects_->steps[i], {{GL_COMPUTE_SHADER, texts[i]}});
    glUseProgram(objects_->steps[i].name());
    glUniformMatrix4fv(0, 1, GL_FALSE, matrix.data());
    glUniform1ui(1, side);
    glUniform1ui(2, static_cast<GLuint>(i == 0 ? vertices_ : triangles_));
  }
  while (glGetError() != GL_NO_ERROR) {  // uniforms that a step does not use have no place
  }
  for (GLuint i = 0; i < objects_->buffers.size(); ++i) {
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, i, objects_->buffers[i].name());
  }
}

void ComputeRaster::run(std::size_t step, std::size_t count) const {
  glUseProgram(objects_->steps[step].name());
  glDispatchCompute(static_cast<GLuint>((count + kGroup - 1) / kGroup), 1, 1);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

void ComputeRaster::draw_and_read() {
  constexpr GLuint kNothing = 0xffffffffU;
  for (const std::size_t buffer : {3, 4}) {
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, objects_->buffers[buffer].name());
    glClearBufferData(GL_SHADER_STORAGE_BUFFER, GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT,
                      &kNothing);
  }
  run(0, vertices_);
  run(1, triangles_);
  run(2, triangles_);
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, objects_->buffers[4].name());
  glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0,
                     static_cast<GLsizeiptr>(pixels_.size() * sizeof(std::uint32_t)),
                     pixels_.data());
}

}  // namespace glidar::bench
