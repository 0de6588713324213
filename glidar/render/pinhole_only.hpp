// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/error.hpp>

#include <string>

namespace glidar {

/// Why a rasterizer does not support these beams; nullptr: it does.
inline const char* rasterizer_limitation(const Beams& beams) {
  if (!beams.pinhole) return "beams that are not a pinhole's straight grid";
  if (!beams.origins_m.empty()) return "beams with origins of their own";
  if (beams.pinhole->width != beams.cols || beams.pinhole->height != beams.rows) {
    return "a pinhole of another size than its beams";
  }
  return nullptr;
}

/// Throws Error, naming the renderer, for beams that a rasterizer does not support.
inline void check_pinhole(const Beams& beams, const char* renderer) {
  const char* found = rasterizer_limitation(beams);
  if (found == nullptr) return;
  throw Error({.where = std::string(renderer) + " renderer",
               .found = found,
               .allowed = "a pinhole camera at rest, without distortion and with beams from one "
                          "point",
               .remedy = "use --renderer rays"});
}

}  // namespace glidar
