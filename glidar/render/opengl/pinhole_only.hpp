// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/error.hpp>

namespace glidar::opengl {

/// Throws Error, naming the renderer that takes them, for beams that a rasterizer cannot draw.
inline void check_pinhole(const Beams& beams) {
  const auto require = [](bool holds, const char* found) {
    if (holds) return;
    throw Error({.where = "opengl renderer",
                 .found = found,
                 .allowed = "a pinhole camera at rest, without distortion and with beams from one "
                            "point",
                 .remedy = "use --renderer embree"});
  };
  require(beams.pinhole.has_value(), "beams that are not a pinhole's straight grid");
  require(beams.origins_m.empty(), "beams with origins of their own");
  require(beams.pinhole->width == beams.cols && beams.pinhole->height == beams.rows,
          "a pinhole of another size than its beams");
}

}  // namespace glidar::opengl
