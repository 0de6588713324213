// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/opengl/gl_object.hpp>

#include <initializer_list>
#include <string_view>

namespace glidar::opengl {

/// Text of a file of a folder shaders/, embedded in the library; throws std::out_of_range for
/// unknown names.
std::string_view shader_text(std::string_view file);

/// Texts of each stage, which are concatenated, and macros for their compilation.
struct ProgramSource {
  std::initializer_list<std::string_view> vertex;
  std::initializer_list<std::string_view> fragment;
  std::initializer_list<std::string_view> macros;
};

/// Compiles and links for GLSL 3.30. Throws Error with the driver's log on failure.
Program make_program(const ProgramSource& source);

/// The same for a compute shader and GLSL 4.30.
Program make_compute_program(std::initializer_list<std::string_view> texts,
                             std::initializer_list<std::string_view> macros);

}  // namespace glidar::opengl
