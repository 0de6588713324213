// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/opengl/projection.hpp>
#include <glidar/render/opengl/scene_buffers.hpp>
#include <glidar/render/opengl/triangle_id_target.hpp>
#include <glidar/render/renderer.hpp>
#include <glidar/render/resolver.hpp>
#include <glidar/render/triangle_ids.hpp>

#include <cstdint>

namespace glidar::opengl {

/// Draws the ids of a scene's visible triangles.
class TriangleIdDrawing {
 public:
  /// Requires a current context, as all functions here. Throws Error when the scene has more
  /// triangles than ids.
  explicit TriangleIdDrawing(const Scene& scene);

  /// Draws a tile of a pinhole's image into the current target.
  void draw(const CastRequest& request, const Resolver& resolver, const PixelRect& rect,
            const DepthRange& depths) const;

  [[nodiscard]] const TriangleIds& triangle_ids() const { return triangle_ids_; }

 private:
  /// A program and where its uniforms are.
  struct Drawer {
    Program program;
    GLint clip_from_object;
    GLint first_id;
  };
  struct MaskDrawer {
    Drawer base;
    GLint uv_scale_rotate;
    GLint uv_offset;
    GLint wrap;
    GLint is_linear;
    GLint opacity;
    GLint cutoff;
  };

  static Drawer make_drawer(const char* mask_macro, const char* depth_macro);
  static MaskDrawer make_mask_drawer(const char* depth_macro);
  void draw_instance(std::uint32_t instance, const Eigen::Matrix4f& clip_from_object) const;
  void use_mask(std::uint32_t material, const MeshBuffers& mesh) const;

  const Scene& scene_;
  bool has_clip_control_;
  SceneBuffers buffers_;
  Drawer solid_;
  MaskDrawer masked_;
  TriangleIds triangle_ids_;  ///< in the order of MeshBuffers::drawn
};

}  // namespace glidar::opengl
