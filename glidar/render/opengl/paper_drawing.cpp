// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/opengl/paper_drawing.hpp>

#include <glidar/render/opengl/draw_state.hpp>
#include <glidar/render/opengl/program.hpp>

#include <string>

namespace glidar::opengl {
namespace {

constexpr double kSteps = 65536.0;
constexpr GLenum kFlatNormalsUnit = 4;
/// The textures of a material, in the order of their units.
constexpr std::array<const char*, 4> kTextureNames = {"diffuse", "specular", "mask", "normal"};

/// D of equation (8), 65536 (z - n) / (f - n), linear in a vertex of the mesh.
Eigen::Vector4f steps_from_object(const InstanceView& view, const PaperPlanes& planes) {
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

}  // namespace

PaperDrawing::PaperDrawing(const Scene& scene)
    : scene_(scene),
      has_clip_control_(has_clip_control()),
      shaded_(upload_shaded(scene)),
      program_(
          make_program({.vertex = {"paper.vert.glsl"},
                        .fragment = {"texel.glsl", "paper.frag.glsl"},
                        .macros = {has_clip_control_ ? "HAS_CLIP_CONTROL" : "WRITES_DEPTH"}})) {
  glUseProgram(program_.name());
  for (std::size_t unit = 0; unit < kTextures; ++unit) {
    const std::string name = kTextureNames[unit];
    glUniform1i(at(name + "_texture"), static_cast<GLint>(unit));
    textures_[unit] = {.is_used = at(name + "_use.is_used"),
                       .uv_set = at(name + "_use.uv_set"),
                       .uv_scale_rotate = at(name + "_use.use.uv_scale_rotate"),
                       .uv_offset = at(name + "_use.use.uv_offset"),
                       .wrap = at(name + "_use.use.wrap"),
                       .is_linear = at(name + "_use.use.is_linear")};
  }
  glUniform1i(at("flat_normals"), static_cast<GLint>(kFlatNormalsUnit));
}

void PaperDrawing::draw(const CastRequest& request, const Resolver& resolver,
                        const PaperScope& scope) const {
  set_draw_state(has_clip_control_, request.cull_back_faces);
  glUseProgram(program_.name());
  set_scope(scope);
  glVertexAttrib4f(5, 1.0F, 1.0F, 1.0F, 1.0F);  // meshes without colours are white
  for (std::uint32_t i = 0; i < scene_.instances.size(); ++i) {
    if (is_present(request, i)) draw_instance(i, resolver.view(i), scope);
  }
  glBindVertexArray(0);
  check_gl("drawing");
}

void PaperDrawing::set_scope(const PaperScope& scope) const {
  const PinholeIntrinsics& k = scope.pinhole;
  const auto f = [](double value) { return static_cast<GLfloat>(value); };
  glUniform2f(at("focal_px"), f(k.fx), f(k.fy));
  glUniform2f(at("centre_px"), f(k.cx - k.pixel_centre + 0.5), f(k.cy - k.pixel_centre + 0.5));
  glUniform1f(at("near_m"), f(scope.planes.near_m));
  glUniform1f(at("metres_per_step"), f((scope.planes.far_m - scope.planes.near_m) / kSteps));
  glUniform3f(at("attenuation"), f(scope.light.attenuation_constant),
              f(scope.light.attenuation_linear_per_m), f(scope.light.attenuation_quadratic_per_m2));
  glUniform1f(at("scene_ambient"), f(scope.light.ambient));
}

void PaperDrawing::draw_instance(std::uint32_t instance, const InstanceView& view,
                                 const PaperScope& scope) const {
  const Instance& placed = scene_.instances[instance];
  const Mesh& mesh = scene_.meshes[placed.mesh];
  const ShadedMesh& shaded = shaded_.meshes[placed.mesh];
  const PinholeIntrinsics& k = scope.pinhole;
  const Eigen::Matrix4f clip = clip_from_object(view, k, {0, 0, k.height, k.width}, scope.depths);
  const Eigen::Vector4f steps = steps_from_object(view, scope.planes);
  const Eigen::Matrix3f turn = view.object_from_sensor.cast<float>();
  glUniformMatrix4fv(at("clip_from_object"), 1, GL_FALSE, clip.data());
  glUniform4fv(at("steps_from_object"), 1, steps.data());
  glUniformMatrix3fv(at("object_from_sensor"), 1, GL_FALSE, turn.data());
  glUniform1i(at("has_normals"), mesh.normals.empty() ? 0 : 1);
  glUniform1i(at("has_tangents"), mesh.tangents.empty() ? 0 : 1);
  glBindVertexArray(shaded.arrays.name());
  glActiveTexture(GL_TEXTURE0 + kFlatNormalsUnit);
  glBindTexture(GL_TEXTURE_BUFFER, shaded.flat_normals_view.name());
  for (const DrawRange& range : shaded.ranges) {
    set_material(scene_.materials[placed.materials[range.slot]]);
    glUniform1i(at("first_triangle"), static_cast<GLint>(range.first));
    draw_triangles(range);
  }
}

void PaperDrawing::set_material(const Material& material) const {
  glUniform3fv(at("ambient"), 1, material.ambient.data());
  glUniform3fv(at("diffuse"), 1, material.diffuse.data());
  glUniform3fv(at("specular"), 1, material.specular.data());
  glUniform1f(at("shininess"), material.shininess);
  glUniform1f(at("opacity"), material.opacity);
  glUniform1f(at("cutoff"), material.alpha_cutoff);
  glUniform1i(at("mask_is_alpha"), last_is_alpha(scene_, material.alpha_texture) ? 1 : 0);
  glUniform1f(at("normal_scale"), material.normal_scale);
  set_texture(0, material.diffuse_texture);
  set_texture(1, material.specular_texture);
  set_texture(2, material.alpha_texture);
  set_texture(3, material.normal_texture);
}

void PaperDrawing::set_texture(std::size_t unit, const TextureUse& use) const {
  const TextureUniforms& to = textures_[unit];
  glUniform1i(to.is_used, use.used() ? 1 : 0);
  if (!use.used()) return;
  glUniform1i(to.uv_set, use.uv_set);
  glUniformMatrix2fv(to.uv_scale_rotate, 1, GL_FALSE, use.uv_scale_rotate.data());
  glUniform2f(to.uv_offset, use.uv_offset.x(), use.uv_offset.y());
  glUniform2i(to.wrap, wrap_number(use.wrap_u), wrap_number(use.wrap_v));
  glUniform1i(to.is_linear, use.filter == Filter::linear ? 1 : 0);
  glActiveTexture(static_cast<GLenum>(GL_TEXTURE0 + unit));
  glBindTexture(GL_TEXTURE_2D, shaded_.textures[static_cast<std::size_t>(use.texture)].name());
}

}  // namespace glidar::opengl
