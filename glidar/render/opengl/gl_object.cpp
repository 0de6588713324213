// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/opengl/gl_object.hpp>

#include <glidar/core/error.hpp>

#include <string>

namespace glidar::opengl {

GLuint make_gl_object(GlKind kind) {
  GLuint name = 0;
  switch (kind) {
    case GlKind::buffer:
      glGenBuffers(1, &name);
      break;
    case GlKind::vertex_array:
      glGenVertexArrays(1, &name);
      break;
    case GlKind::texture:
      glGenTextures(1, &name);
      break;
    case GlKind::framebuffer:
      glGenFramebuffers(1, &name);
      break;
    case GlKind::renderbuffer:
      glGenRenderbuffers(1, &name);
      break;
    case GlKind::program:
      return glCreateProgram();
  }
  return name;
}

void delete_gl_object(GlKind kind, GLuint name) {
  switch (kind) {
    case GlKind::buffer:
      return glDeleteBuffers(1, &name);
    case GlKind::vertex_array:
      return glDeleteVertexArrays(1, &name);
    case GlKind::texture:
      return glDeleteTextures(1, &name);
    case GlKind::framebuffer:
      return glDeleteFramebuffers(1, &name);
    case GlKind::renderbuffer:
      return glDeleteRenderbuffers(1, &name);
    case GlKind::program:
      return glDeleteProgram(name);
  }
}

void check_reset(GLenum status) {
  if (status == GL_NO_ERROR) return;
  const char* cause = status == GL_GUILTY_CONTEXT_RESET     ? " because of what was drawn"
                      : status == GL_INNOCENT_CONTEXT_RESET ? " because of another program"
                                                            : "";
  throw Error({.where = "OpenGL",
               .found = std::string("the graphics device was reset") + cause +
                        ": its context is lost, with the frame under way",
               .allowed = "",
               .remedy = "make a new renderer, or start again; if it comes back, update the "
                         "driver, choose another --graphics-device, or use --renderer rays"});
}

void check_not_lost() {
  constexpr int kInCore = 45;
  if (epoxy_gl_version() >= kInCore || epoxy_has_gl_extension("GL_KHR_robustness")) {
    check_reset(glGetGraphicsResetStatus());
  } else if (epoxy_has_gl_extension("GL_ARB_robustness")) {
    check_reset(glGetGraphicsResetStatusARB());
  }
}

void check_gl(const char* doing) {
  const GLenum code = glGetError();
  if (code == GL_NO_ERROR) return;
  if (code == GL_CONTEXT_LOST) check_reset(GL_UNKNOWN_CONTEXT_RESET);
  const bool is_memory = code == GL_OUT_OF_MEMORY;
  throw Error({.where = "OpenGL",
               .found = std::string(doing) + " failed" +
                        (is_memory ? ": memory ran out" : " (code " + std::to_string(code) + ")"),
               .allowed = "",
               .remedy = is_memory ? "use a smaller model, or --renderer rays" : ""});
}

namespace {

[[noreturn]] void refuse(const std::string& what, const std::string& log) {
  throw Error({.where = "OpenGL",
               .found = "the driver does not accept " + what + ": " + log,
               .allowed = "",
               .remedy = "update the driver, or use --renderer rays"});
}

std::string joined(const char* version, std::initializer_list<std::string_view> texts,
                   std::initializer_list<std::string_view> macros) {
  std::string text = "#version " + std::string(version) + " core\n";
  for (const std::string_view macro : macros) text += "#define " + std::string(macro) + "\n";
  for (const std::string_view part : texts) text += part;
  return text;
}

/// Compiles one stage into the program; the program owns the shader.
void attach(const Program& program, GLenum stage, const std::string& text) {
  const GLuint shader = glCreateShader(stage);
  const char* start = text.c_str();
  glShaderSource(shader, 1, &start, nullptr);
  glCompileShader(shader);
  GLint good = GL_FALSE;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
  std::string log;
  if (good == GL_FALSE) {
    GLint length = 0;
    glGetShaderiv(shader, GL_INFO_LOG_LENGTH, &length);
    log.resize(static_cast<std::size_t>(length));
    glGetShaderInfoLog(shader, length, nullptr, log.data());
  }
  glAttachShader(program.name(), shader);
  glDeleteShader(shader);
  if (good == GL_FALSE) {
    refuse(stage == GL_VERTEX_SHADER     ? "a vertex shader"
           : stage == GL_FRAGMENT_SHADER ? "a fragment shader"
                                         : "a compute shader",
           log);
  }
}

void link(const Program& program) {
  glLinkProgram(program.name());
  GLint good = GL_FALSE;
  glGetProgramiv(program.name(), GL_LINK_STATUS, &good);
  if (good == GL_TRUE) return;
  GLint length = 0;
  glGetProgramiv(program.name(), GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(length), ' ');
  glGetProgramInfoLog(program.name(), length, nullptr, log.data());
  refuse("a program", log);
}

}  // namespace

Program make_program(const ProgramSource& source) {
  Program program;
  attach(program, GL_VERTEX_SHADER, joined("330", source.vertex, source.macros));
  attach(program, GL_FRAGMENT_SHADER, joined("330", source.fragment, source.macros));
  link(program);
  return program;
}

Program make_compute_program(std::initializer_list<std::string_view> texts,
                             std::initializer_list<std::string_view> macros) {
  Program program;
  attach(program, GL_COMPUTE_SHADER, joined("430", texts, macros));
  link(program);
  return program;
}

}  // namespace glidar::opengl
