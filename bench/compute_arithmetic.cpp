// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "compute_caster.hpp"
#include "compute_shaders.hpp"
#include "raw_opengl.hpp"

#include <glidar/math/random.hpp>

#include <bit>

namespace glidar::bench {
namespace {

using Four = std::array<double, 4>;

/// Inputs of a range; the fourth component of `sensor` is the scale, that of `plane` the offset.
struct Case {
  Four row_x;
  Four row_y;
  Four row_z;
  Four sensor;
  Four beam;
  Four plane;
};

constexpr std::uint32_t kGroup = 64;
constexpr std::uint32_t kCases = 1024 * kGroup;

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
    for (Four* four : {&c.row_x, &c.row_y, &c.row_z, &c.sensor, &c.beam, &c.plane}) {
      *four = random_four(block++);
    }
  }
  return cases;
}

double ordered_dot(const Four& a, const Four& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

double range_of(const Case& c) {
  const Four direction = {ordered_dot(c.row_x, c.beam), ordered_dot(c.row_y, c.beam),
                          ordered_dot(c.row_z, c.beam), 0.0};
  const double above = c.plane[3] - ordered_dot(c.plane, c.sensor);
  return above / ordered_dot(c.plane, direction) * c.sensor[3];
}

std::vector<double> ranges_on_device(const std::vector<Case>& cases) {
  opengl::Program program;
  compile(program, {{GL_COMPUTE_SHADER, arithmetic_shader().c_str()}});
  glUseProgram(program.name());
  std::array<opengl::Buffer, 2> buffers;
  std::vector<double> ranges(cases.size());
  const auto bytes = static_cast<GLsizeiptr>(ranges.size() * sizeof(double));
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, buffers[0].name());
  glBufferData(GL_SHADER_STORAGE_BUFFER, static_cast<GLsizeiptr>(cases.size() * sizeof(Case)),
               cases.data(), GL_STATIC_DRAW);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, buffers[1].name());
  glBufferData(GL_SHADER_STORAGE_BUFFER, bytes, nullptr, GL_STATIC_READ);
  glDispatchCompute(kCases / kGroup, 1, 1);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, bytes, ranges.data());
  opengl::check_gl("comparing the device's arithmetic");
  return ranges;
}

}  // namespace

std::string ComputeCaster::missing() {
  constexpr int kMin = 44;
  opengl::EglContext context(chosen_device());
  const opengl::ScopedContext use(context);
  if (epoxy_gl_version() < kMin) return "no OpenGL 4.4";
  const std::vector<Case> cases = random_cases();
  const std::vector<double> ranges = ranges_on_device(cases);
  std::size_t others = 0;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    others +=
        std::bit_cast<std::uint64_t>(ranges[i]) != std::bit_cast<std::uint64_t>(range_of(cases[i]))
            ? 1
            : 0;
  }
  if (others == 0) return "";
  return std::to_string(others) + " of " + std::to_string(cases.size()) +
         " ranges differ from the processor's";
}

}  // namespace glidar::bench
