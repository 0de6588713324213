// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/opengl/gl_object.hpp>

#include <glidar/core/error.hpp>

#include <string>

namespace glidar::opengl {

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

}  // namespace glidar::opengl
