// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/opengl/gl_object.hpp>

#include <glidar/core/error.hpp>

#include <string>

namespace glidar::opengl {

void check_gl(const char* doing) {
  const GLenum code = glGetError();
  if (code == GL_NO_ERROR) return;
  const bool is_memory = code == GL_OUT_OF_MEMORY;
  throw Error({.where = "OpenGL",
               .found = std::string(doing) + " failed" +
                        (is_memory ? ": memory ran out" : " (code " + std::to_string(code) + ")"),
               .allowed = "",
               .remedy = is_memory ? "use a smaller model, or --renderer embree" : ""});
}

}  // namespace glidar::opengl
