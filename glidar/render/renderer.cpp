// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/renderer.hpp>

#include <glidar/core/error.hpp>
#include <glidar/render/embree/embree_renderer.hpp>

#include <array>

namespace glidar {
namespace {

using Factory = std::unique_ptr<Renderer> (*)(const Scene&, const RendererOptions&);

struct Kind {
  std::string name;
  Factory make;
};

const std::array<Kind, 1>& kinds() {
  static const std::array<Kind, 1> all = {{{"embree", make_embree_renderer}}};
  return all;
}

}  // namespace

std::unique_ptr<Renderer> make_renderer(const Scene& scene, const RendererOptions& options) {
  std::string names;
  for (const Kind& kind : kinds()) {
    if (kind.name == options.kind) return kind.make(scene, options);
    names += (names.empty() ? "" : ", ") + kind.name;
  }
  throw Error({.where = "renderer",
               .found = "'" + options.kind + "' is not known",
               .allowed = names,
               .remedy = ""});
}

}  // namespace glidar
