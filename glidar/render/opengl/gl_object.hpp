// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <epoxy/gl.h>

#include <initializer_list>
#include <string_view>
#include <utility>

namespace glidar::opengl {

/// Owns one OpenGL object; the context it was made in must be current when it is deleted.
template <class Kind>
class GlObject {
 public:
  GlObject() : name_(Kind::make()) {}
  ~GlObject() {
    if (name_ != 0) Kind::drop(name_);
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

struct BufferKind {
  static GLuint make() {
    GLuint name = 0;
    glGenBuffers(1, &name);
    return name;
  }
  static void drop(GLuint name) { glDeleteBuffers(1, &name); }
};

struct VertexArrayKind {
  static GLuint make() {
    GLuint name = 0;
    glGenVertexArrays(1, &name);
    return name;
  }
  static void drop(GLuint name) { glDeleteVertexArrays(1, &name); }
};

struct TextureKind {
  static GLuint make() {
    GLuint name = 0;
    glGenTextures(1, &name);
    return name;
  }
  static void drop(GLuint name) { glDeleteTextures(1, &name); }
};

struct FramebufferKind {
  static GLuint make() {
    GLuint name = 0;
    glGenFramebuffers(1, &name);
    return name;
  }
  static void drop(GLuint name) { glDeleteFramebuffers(1, &name); }
};

struct RenderbufferKind {
  static GLuint make() {
    GLuint name = 0;
    glGenRenderbuffers(1, &name);
    return name;
  }
  static void drop(GLuint name) { glDeleteRenderbuffers(1, &name); }
};

struct ProgramKind {
  static GLuint make() { return glCreateProgram(); }
  static void drop(GLuint name) { glDeleteProgram(name); }
};

using Buffer = GlObject<BufferKind>;
using VertexArray = GlObject<VertexArrayKind>;
using GlTexture = GlObject<TextureKind>;
using Framebuffer = GlObject<FramebufferKind>;
using Renderbuffer = GlObject<RenderbufferKind>;
using Program = GlObject<ProgramKind>;

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
