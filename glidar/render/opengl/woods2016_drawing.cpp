// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/opengl/woods2016_drawing.hpp>

#include <glidar/render/opengl/draw_state.hpp>
#include <glidar/render/opengl/program.hpp>

#include <string>

namespace glidar::opengl {
namespace {

constexpr double kSteps = 65536.0;
constexpr GLenum kFlatNormalsUnit = 4;  // after the four textures of a material

/// D of equation (8), 65536 (z - n) / (f - n), linear in a vertex of the mesh.
Eigen::Vector4f steps_from_object(const InstanceView& view, const Woods2016DepthPlanes& planes) {
  const Eigen::Vector3d boresight = view.scale * view.object_from_sensor.col(2);
  const double per_metre = kSteps / (planes.far_m - planes.near_m);
  Eigen::Vector4d row;
  row << per_metre * boresight, per_metre * (-boresight.dot(view.sensor_in_object) - planes.near_m);
  return row.cast<float>();
}

bool last_is_alpha(const Scene& scene, const TextureUse& use) {
  if (!use.used()) return false;
  const std::uint32_t channels = scene.textures[static_cast<std::size_t>(use.texture)].channels;
  return channels == 2 || channels == 4;
}

bool has_mask(const Material& material) {
  return material.alpha_cutoff > 0.0F;
}

/// False if interpolated normals and the material's own colours suffice.
bool needs_textures(const Material& material, const Mesh& mesh, const DrawRange& range) {
  return !is_smooth(range) || material.diffuse_texture.used() || material.specular_texture.used() ||
         has_mask(material) || !mesh.colours.empty() ||
         (material.normal_texture.used() && !mesh.tangents.empty());
}

GLfloat single(double value) {
  return static_cast<GLfloat>(value);
}

}  // namespace

Woods2016Drawing::Woods2016Drawing(const Scene& scene)
    : scene_(scene),
      has_clip_control_(has_clip_control()),
      shaded_(upload_shaded(scene)),
      diffuse_(make_shader("IS_PLAIN", "IS_DIFFUSE")),
      shiny_(make_shader("IS_PLAIN", "IS_SHINY")),
      textured_(make_shader("HAS_TEXTURES", "IS_SHINY")) {}

Woods2016Drawing::Shader Woods2016Drawing::make_shader(const char* surface_macro,
                                                       const char* shine_macro) const {
  return {make_program({.vertex = {shader_text("woods2016.vert.glsl")},
                        .fragment = {shader_text("texel.glsl"), shader_text("woods2016.frag.glsl")},
                        .macros = {surface_macro, shine_macro,
                                   has_clip_control_ ? "HAS_CLIP_CONTROL" : "WRITES_DEPTH"}})};
}

void Woods2016Drawing::draw(const CastRequest& request, const Resolver& resolver,
                            const Woods2016View& scope) const {
  set_draw_state(has_clip_control_, request.cull_back_faces);
  for (const Shader* shader : {&diffuse_, &shiny_, &textured_}) {
    glUseProgram(shader->program.name());
    set_scope(*shader, scope);
  }
  glVertexAttrib4f(5, 1.0F, 1.0F, 1.0F, 1.0F);  // meshes without colours are white
  for (std::uint32_t i = 0; i < scene_.instances.size(); ++i) {
    if (is_enabled(request, i)) draw_instance(i, resolver.view(i), scope);
  }
  glBindVertexArray(0);
  check_gl("drawing");
}

void Woods2016Drawing::set_scope(const Shader& shader, const Woods2016View& scope) const {
  const PhongHeadlight& light = scope.light;
  glUniform3f(shader.at("attenuation"), single(light.attenuation_constant),
              single(light.attenuation_linear_per_m), single(light.attenuation_quadratic_per_m2));
  glUniform1i(shader.at("flat_normals"), static_cast<GLint>(kFlatNormalsUnit));
}

void Woods2016Drawing::draw_instance(std::uint32_t instance, const InstanceView& view,
                                     const Woods2016View& scope) const {
  const Instance& placed = scene_.instances[instance];
  const Mesh& mesh = scene_.meshes[placed.mesh];
  const ShadedMesh& shaded = shaded_.meshes[placed.mesh];
  glBindVertexArray(shaded.arrays.name());
  glActiveTexture(GL_TEXTURE0 + kFlatNormalsUnit);
  glBindTexture(GL_TEXTURE_BUFFER, shaded.flat_normals_view.name());
  for (const DrawRange& range : shaded.ranges) {
    const Material& material = scene_.materials[placed.materials[slot_of(range)]];
    const bool is_textured = needs_textures(material, mesh, range);
    const Shader& shader = shader_for(material, is_textured);
    glUseProgram(shader.program.name());
    set_instance(shader, view, scope);
    glUniform1f(shader.at("shininess"), material.shininess);
    if (is_textured) {
      set_colours(shader, material, scope.light);
      set_textures(shader, material, mesh);
    } else {
      set_shares(shader, material, scope.light);
    }
    glUniform1i(shader.at("first_triangle"), static_cast<GLint>(range.first));
    draw_triangles(range);
  }
}

void Woods2016Drawing::set_instance(const Shader& shader, const InstanceView& view,
                                    const Woods2016View& scope) const {
  const PinholeIntrinsics& k = scope.pinhole;
  const Eigen::Matrix4f clip = clip_from_object(view, k, {0, 0, k.height, k.width}, scope.depths);
  const Eigen::Vector4f steps = steps_from_object(view, scope.planes);
  const Eigen::Vector3f sensor = view.sensor_in_object.cast<float>();
  glUniformMatrix4fv(shader.at("clip_from_object"), 1, GL_FALSE, clip.data());
  glUniform4fv(shader.at("steps_from_object"), 1, steps.data());
  glUniform3fv(shader.at("sensor"), 1, sensor.data());
  glUniform1f(shader.at("metres_per_unit"), single(view.scale));
}

const Woods2016Drawing::Shader& Woods2016Drawing::shader_for(const Material& material,
                                                             bool is_textured) const {
  if (is_textured) return textured_;
  return luminance(material.specular) > 0.0F ? shiny_ : diffuse_;
}

void Woods2016Drawing::set_shares(const Shader& shader, const Material& material,
                                  const PhongHeadlight& light) {
  glUniform3f(shader.at("plain_shares"), single(light.ambient * luminance(material.ambient)),
              luminance(material.diffuse), luminance(material.specular));
}

void Woods2016Drawing::set_colours(const Shader& shader, const Material& material,
                                   const PhongHeadlight& light) {
  glUniform1f(shader.at("scene_ambient"), single(light.ambient));
  glUniform3fv(shader.at("ambient"), 1, material.ambient.data());
  glUniform3fv(shader.at("diffuse"), 1, material.diffuse.data());
  glUniform3fv(shader.at("specular"), 1, material.specular.data());
}

void Woods2016Drawing::set_textures(const Shader& shader, const Material& material,
                                    const Mesh& mesh) const {
  glUniform1f(shader.at("opacity"), material.opacity);
  glUniform1f(shader.at("cutoff"), material.alpha_cutoff);
  glUniform1i(shader.at("mask_is_alpha"), last_is_alpha(scene_, material.alpha_texture) ? 1 : 0);
  glUniform1f(shader.at("normal_scale"), material.normal_scale);
  glUniform1i(shader.at("has_tangents"), mesh.tangents.empty() ? 0 : 1);
  set_texture(shader, 0, "diffuse", material.diffuse_texture);
  set_texture(shader, 1, "specular", material.specular_texture);
  set_texture(shader, 2, "mask", material.alpha_texture);
  set_texture(shader, 3, "normal", material.normal_texture);
}

void Woods2016Drawing::set_texture(const Shader& shader, GLenum unit, const std::string& name,
                                   const TextureUse& use) const {
  glUniform1i(shader.at(name + "_texture"), static_cast<GLint>(unit));
  glUniform1i(shader.at(name + "_use.is_used"), use.used() ? 1 : 0);
  if (!use.used()) return;
  glUniform1i(shader.at(name + "_use.uv_set"), use.uv_set);
  glUniformMatrix2fv(shader.at(name + "_use.use.uv_scale_rotate"), 1, GL_FALSE,
                     use.uv_scale_rotate.data());
  glUniform2f(shader.at(name + "_use.use.uv_offset"), use.uv_offset.x(), use.uv_offset.y());
  glUniform2i(shader.at(name + "_use.use.wrap"), wrap_number(use.wrap_u), wrap_number(use.wrap_v));
  glUniform1i(shader.at(name + "_use.use.is_linear"), use.filter == Filter::linear ? 1 : 0);
  glActiveTexture(GL_TEXTURE0 + unit);
  glBindTexture(GL_TEXTURE_2D, shaded_.textures[static_cast<std::size_t>(use.texture)].name());
}

}  // namespace glidar::opengl
