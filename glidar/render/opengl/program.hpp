// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/opengl/gl_object.hpp>

#include <initializer_list>
#include <string_view>

namespace glidar::opengl {

/// The text of a file of shaders/, built into the program; throws std::out_of_range for another.
std::string_view shader_text(std::string_view file);

/// The texts of each stage, which follow each other, and the macros they are compiled with.
struct ProgramSource {
  std::initializer_list<std::string_view> vertex;
  std::initializer_list<std::string_view> fragment;
  std::initializer_list<std::string_view> macros;
};

/// Compiles and links for GLSL 3.30. Throws Error with the driver's words when it refuses.
Program make_program(const ProgramSource& source);

}  // namespace glidar::opengl
