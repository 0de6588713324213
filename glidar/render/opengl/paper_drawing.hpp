// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/light.hpp>
#include <glidar/render/opengl/paper_buffers.hpp>
#include <glidar/render/opengl/projection.hpp>
#include <glidar/render/paper_picture.hpp>
#include <glidar/render/resolve.hpp>

#include <array>

namespace glidar::opengl {

/// What of one picture is the same for all that is drawn.
struct PaperScope {
  const PinholeIntrinsics& pinhole;
  const Light& light;
  PaperPlanes planes;  ///< of equation (8)
  DepthRange depths;   ///< of the depth buffer
};

/// The paper's vertex and fragment shaders over a scene.
class PaperDrawing {
 public:
  /// Needs a current context, as everything here does.
  explicit PaperDrawing(const Scene& scene);

  /// Draws what is there into the current target.
  void draw(const CastRequest& request, const Resolver& resolver, const PaperScope& scope) const;

 private:
  static constexpr std::size_t kTextures = 4;

  [[nodiscard]] GLint at(const std::string& uniform) const {
    return glGetUniformLocation(program_.name(), uniform.c_str());
  }
  void set_scope(const PaperScope& scope) const;
  void draw_instance(std::uint32_t instance, const InstanceView& view,
                     const PaperScope& scope) const;
  void set_material(const Material& material) const;
  void set_texture(std::size_t unit, const TextureUse& use) const;

  const Scene& scene_;
  bool has_clip_control_;
  ShadedScene shaded_;
  Program program_;
  struct TextureUniforms {
    GLint is_used;
    GLint uv_set;
    GLint uv_scale_rotate;
    GLint uv_offset;
    GLint wrap;
    GLint is_linear;
  };
  std::array<TextureUniforms, kTextures> textures_{};
};

}  // namespace glidar::opengl
