// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/phong_headlight.hpp>
#include <glidar/render/opengl/projection.hpp>
#include <glidar/render/opengl/woods2016_buffers.hpp>
#include <glidar/render/resolver.hpp>
#include <glidar/render/woods2016_camera.hpp>

#include <string>

namespace glidar::opengl {

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
