// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <epoxy/gl.h>

#include <initializer_list>
#include <string_view>
#include <utility>

namespace glidar::opengl {

enum class GlKind : unsigned char {
  buffer,
  vertex_array,
  texture,
  framebuffer,
  renderbuffer,
  program
};

GLuint make_gl_object(GlKind kind);
void delete_gl_object(GlKind kind, GLuint name);

/// Owns one OpenGL object; the context it was made in must be current when it is deleted.
template <GlKind kKind>
class GlObject {
 public:
  GlObject() : name_(make_gl_object(kKind)) {}
  ~GlObject() {
    if (name_ != 0) delete_gl_object(kKind, name_);
  }
  GlObject(GlObject&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  GlObject& operator=(GlObject&& other) noexcept {
    std::swap(name_, other.name_);
    return *this;
  }
  GlObject(const GlObject&) = delete;
  GlObject& operator=(const GlObject&) = delete;

  [[nodiscard]] GLuint name() const { return name_; }

 private:
  GLuint name_;
};

using Buffer = GlObject<GlKind::buffer>;
using VertexArray = GlObject<GlKind::vertex_array>;
using GlTexture = GlObject<GlKind::texture>;
using Framebuffer = GlObject<GlKind::framebuffer>;
using Renderbuffer = GlObject<GlKind::renderbuffer>;
using Program = GlObject<GlKind::program>;

/// Throws Error with a remedy for a glGetGraphicsResetStatus() other than GL_NO_ERROR.
void check_reset(GLenum status);

/// Throws Error when the current context is lost, if the driver reports it: the graphics device was
/// reset, and everything read since is invalid.
void check_not_lost();

/// Throws Error when OpenGL reports an error since the last call. `doing` names the operation.
void check_gl(const char* doing);

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
