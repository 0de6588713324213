// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/gpu/device_check.hpp>

#include <glidar/core/error.hpp>
#include <glidar/math/random.hpp>
#include <glidar/render/gpu/device_scene.hpp>
#include <glidar/render/opengl/program.hpp>

#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <vector>

namespace glidar::gpu {
namespace {

using Four = std::array<double, 4>;

/// Inputs of a range; the fourth component of `sensor` is the scale, that of `plane` the offset.
struct Case {
  std::array<Four, 3> rows;
  Four sensor;
  Four beam;
  Four offset;
  Four plane;
};

constexpr std::uint32_t kGroup = 64;  // as in the shader
constexpr std::uint32_t kCases = 64 * kGroup;

Four random_four(std::uint32_t block) {
  Four numbers;
  for (std::uint32_t k = 0; k < 4; ++k) {
    const RandomWords words = random_words({.seed = 2, .block = 4 * block + k});
    numbers[k] = (uniform(words[0]) - 0.5) + 0x1p-32 * (uniform(words[1]) - 0.5);
  }
  return numbers;
}

std::vector<Case> random_cases() {
  std::vector<Case> cases(kCases);
  std::uint32_t block = 0;
  for (Case& c : cases) {
    for (Four* four : {c.rows.data(), c.rows.data() + 1, c.rows.data() + 2, &c.sensor, &c.beam,
                       &c.offset, &c.plane}) {
      *four = random_four(block++);
    }
  }
  return cases;
}

double ordered_dot(const Four& a, const Four& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Four turned(const Case& c, const Four& v) {
  return {ordered_dot(c.rows[0], v), ordered_dot(c.rows[1], v), ordered_dot(c.rows[2], v), 0.0};
}

double range_of(const Case& c) {
  Four origin = turned(c, c.offset);
  for (std::size_t k = 0; k < 3; ++k) origin[k] = c.sensor[k] + origin[k] / c.sensor[3];
  const double above = c.plane[3] - ordered_dot(c.plane, origin);
  return above / ordered_dot(c.plane, turned(c, c.beam)) * c.sensor[3];
}

std::vector<double> ranges_on_device(const std::vector<Case>& cases) {
  const opengl::Program program = opengl::make_compute_program(
      {opengl::shader_text("arithmetic.glsl"), opengl::shader_text("arithmetic_check.comp.glsl")},
      {});
  const std::array<opengl::Buffer, 2> buffers;
  std::vector<double> ranges(cases.size());
  fill<Case>(buffers[0], cases, GL_STATIC_DRAW);
  fill<double>(buffers[1], ranges, GL_STATIC_READ);
  for (GLuint i = 0; i < buffers.size(); ++i) {
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, i, buffers[i].name());
  }
  glUseProgram(program.name());
  glDispatchCompute(kCases / kGroup, 1, 1);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffers[1].name());
  glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0,
                     static_cast<GLsizeiptr>(ranges.size() * sizeof(double)), ranges.data());
  glUseProgram(0);
  opengl::check_gl("comparing the device's arithmetic");
  return ranges;
}

[[noreturn]] void refuse(const std::string& found) {
  const char* name = std::bit_cast<const char*>(glGetString(GL_RENDERER));
  throw Error({.where = "gpu renderer",
               .found = std::string(name) + " has " + found,
               .allowed = "OpenGL 4.3 with compute shaders, GL_ARB_buffer_storage and exact 64-bit "
                          "numbers",
               .remedy = "choose another --graphics-device, or use --renderer rays"});
}

}  // namespace

void check_device() {
  constexpr int kMinVersion = 43;
  const int version = epoxy_gl_version();
  if (version < kMinVersion) {
    refuse("OpenGL " + std::to_string(version / 10) + "." + std::to_string(version % 10));
  }
  if (version == kMinVersion && !epoxy_has_gl_extension("GL_ARB_buffer_storage")) {
    refuse("no GL_ARB_buffer_storage");
  }
  const std::vector<Case> cases = random_cases();
  const std::vector<double> ranges = ranges_on_device(cases);
  std::size_t others = 0;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const bool is_same =
        std::bit_cast<std::uint64_t>(ranges[i]) == std::bit_cast<std::uint64_t>(range_of(cases[i]));
    others += is_same ? 0 : 1;
  }
  if (others == 0) return;
  refuse("another arithmetic than the processor (" + std::to_string(others) + " of " +
         std::to_string(cases.size()) + " numbers differ)");
}

}  // namespace glidar::gpu
