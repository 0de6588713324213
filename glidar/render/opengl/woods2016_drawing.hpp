// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/phong_headlight.hpp>
#include <glidar/core/scene.hpp>
#include <glidar/render/depth_range.hpp>
#include <glidar/render/draw_order.hpp>
#include <glidar/render/opengl/gl_object.hpp>
#include <glidar/render/resolver.hpp>
#include <glidar/render/triangle_ids.hpp>
#include <glidar/render/woods2016_camera.hpp>

#include <Eigen/Core>

#include <cstdint>
#include <string>
#include <vector>

namespace glidar::opengl {

/// From a mesh's vertices (relative to its origin) to clip coordinates of a pinhole's pixels: row 0
/// is at the bottom of the window, and beams pass through pixel centres. Window depth is reversed:
/// near (far - z) / (z (far - near)), 1 at the near plane and 0 at the far plane. Floats are
/// densest near 0, so single precision resolves depths evenly. Computed in double relative to the
/// sensor, so that scenes far from the world's origin lose no precision.
Eigen::Matrix4f clip_from_object(const InstanceView& view, const PinholeIntrinsics& k,
                                 const PixelRect& rect, const DepthRange& depths);

/// A mesh with all attributes for shading, in the memory of the graphics device. Attributes: 0
/// position, 1 and 2 texture coordinates, 3 normal, 4 tangent, 5 colour; missing ones are constants
/// of the context.
struct ShadedMesh {
  VertexArray arrays;
  Buffer triangles;
  std::vector<Buffer> attributes;
  std::vector<DrawRange> ranges;  ///< their kinds are kind_of()
  Buffer flat_normals;            ///< of the triangles in drawing order, 4 floats each
  GlTexture flat_normals_view;
};

/// Triangles whose interpolated normal may vanish also need their flat normal.
inline std::uint32_t kind_of(std::uint16_t slot, bool is_smooth) {
  return 2U * slot + (is_smooth ? 0 : 1);
}
inline std::uint32_t slot_of(const DrawRange& range) {
  return range.kind / 2;
}
inline bool is_smooth(const DrawRange& range) {
  return range.kind % 2 == 0;
}

/// A scene with its textures (RGBA, as in core/material.cpp).
struct ShadedScene {
  std::vector<ShadedMesh> meshes;
  std::vector<GlTexture> textures;
};

ShadedScene upload_shaded(const Scene& scene);

/// An image of four bytes per pixel, with depths. No multisampling: it would mix depths.
class Woods2016Target {
 public:
  /// Resizes and clears the image (all bytes 0), and draws into it from now on.
  void begin(std::uint32_t rows, std::uint32_t cols);

  /// Copies the image to memory, row by row.
  void read(std::vector<std::uint8_t>& rgba);

 private:
  Framebuffer framebuffer_;
  Renderbuffer colours_;
  Renderbuffer depths_;
  GLsizei rows_ = 0;
  GLsizei cols_ = 0;
};

/// Parameters that all draw calls of one image share.
struct Woods2016View {
  const PinholeIntrinsics& pinhole;
  const PhongHeadlight& light;
  Woods2016DepthPlanes planes;  ///< of equation (8)
  DepthRange depths;            ///< of the depth buffer
};

/// The paper's vertex and fragment shaders over a scene.
class Woods2016Drawing {
 public:
  /// Requires a current context, as all functions here.
  explicit Woods2016Drawing(const Scene& scene);

  /// Draws all enabled instances into the current target.
  void draw(const CastRequest& request, const Resolver& resolver, const Woods2016View& scope) const;

 private:
  /// One compiled program; unused features would cost much time in software.
  struct Shader {
    Program program;

    [[nodiscard]] GLint at(const std::string& uniform) const {
      return glGetUniformLocation(program.name(), uniform.c_str());
    }
  };

  [[nodiscard]] Shader make_shader(const char* surface_macro, const char* shine_macro) const;
  [[nodiscard]] const Shader& shader_for(const Material& material, bool is_textured) const;
  void set_scope(const Shader& shader, const Woods2016View& scope) const;
  void set_instance(const Shader& shader, const InstanceView& view,
                    const Woods2016View& scope) const;
  static void set_shares(const Shader& shader, const Material& material,
                         const PhongHeadlight& light);
  static void set_colours(const Shader& shader, const Material& material,
                          const PhongHeadlight& light);
  void set_textures(const Shader& shader, const Material& material, const Mesh& mesh) const;
  void set_texture(const Shader& shader, GLenum unit, const std::string& name,
                   const TextureUse& use) const;
  void draw_instance(std::uint32_t instance, const InstanceView& view,
                     const Woods2016View& scope) const;

  const Scene& scene_;
  bool has_clip_control_;
  ShadedScene shaded_;
  Shader diffuse_;   ///< only diffuse and ambient light
  Shader shiny_;     ///< also specular light
  Shader textured_;  ///< also textures, alpha masks and normal maps
};

}  // namespace glidar::opengl
