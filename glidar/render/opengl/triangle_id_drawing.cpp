// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/opengl/triangle_id_drawing.hpp>

#include <glidar/core/error.hpp>
#include <glidar/render/opengl/draw_state.hpp>
#include <glidar/render/opengl/program.hpp>
#include <glidar/render/opengl/triangle_id_target.hpp>

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

namespace glidar::opengl {
namespace {

/// The scene; throws Error if a mesh is too large for one draw call.
const Scene& checked(const Scene& scene) {
  constexpr std::size_t kMaxAtOnce = std::numeric_limits<GLsizei>::max() / 3;  // in one draw
  for (const Mesh& mesh : scene.meshes) {
    const std::size_t own = mesh.triangles.size();
    if (own <= kMaxAtOnce) continue;
    throw Error({.where = "opengl renderer",
                 .found = "too many triangles in one mesh: " + std::to_string(own),
                 .allowed = "up to 715827882",
                 .remedy = "use --renderer rays"});
  }
  return scene;
}

}  // namespace

TriangleIdDrawing::Drawer TriangleIdDrawing::make_drawer(const char* mask_macro,
                                                         const char* depth_macro) {
  Drawer drawer{.program = make_program(
                    {.vertex = {shader_text("triangles.vert.glsl")},
                     .fragment = {shader_text("texel.glsl"), shader_text("triangle_ids.frag.glsl")},
                     .macros = {mask_macro, depth_macro}}),
                .clip_from_object = 0,
                .first_id = 0};
  drawer.clip_from_object = glGetUniformLocation(drawer.program.name(), "clip_from_object");
  drawer.first_id = glGetUniformLocation(drawer.program.name(), "first_id");
  return drawer;
}

TriangleIdDrawing::MaskDrawer TriangleIdDrawing::make_mask_drawer(const char* depth_macro) {
  Drawer base = make_drawer("HAS_MASK", depth_macro);
  const GLuint name = base.program.name();
  return {.base = std::move(base),
          .uv_scale_rotate = glGetUniformLocation(name, "mask_use.uv_scale_rotate"),
          .uv_offset = glGetUniformLocation(name, "mask_use.uv_offset"),
          .wrap = glGetUniformLocation(name, "mask_use.wrap"),
          .is_linear = glGetUniformLocation(name, "mask_use.is_linear"),
          .opacity = glGetUniformLocation(name, "opacity"),
          .cutoff = glGetUniformLocation(name, "cutoff")};
}

TriangleIdDrawing::TriangleIdDrawing(const Scene& scene)
    : scene_(scene),
      has_clip_control_(has_clip_control()),
      buffers_(upload(checked(scene))),
      solid_(make_drawer("IS_SOLID", has_clip_control_ ? "HAS_CLIP_CONTROL" : "WRITES_DEPTH")),
      masked_(make_mask_drawer(has_clip_control_ ? "HAS_CLIP_CONTROL" : "WRITES_DEPTH")),
      triangle_ids_(scene, "opengl") {
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    triangle_ids_.set_order(i, buffers_.meshes[scene.instances[i].mesh].drawn);
  }
}

void TriangleIdDrawing::draw(const CastRequest& request, const Resolver& resolver,
                             const PixelRect& rect, const DepthRange& depths) const {
  set_draw_state(has_clip_control_, request.cull_back_faces);
  for (std::uint32_t i = 0; i < scene_.instances.size(); ++i) {
    if (!is_enabled(request, i)) continue;
    draw_instance(i, clip_from_object(resolver.view(i), *request.beams.pinhole, rect, depths));
  }
  glBindVertexArray(0);
  check_gl("drawing");
}

void TriangleIdDrawing::draw_instance(std::uint32_t instance,
                                      const Eigen::Matrix4f& clip_from_object) const {
  const Instance& placed = scene_.instances[instance];
  const MeshBuffers& mesh = buffers_.meshes[placed.mesh];
  glBindVertexArray(mesh.arrays.name());
  for (const DrawRange& range : mesh.ranges) {
    const std::uint32_t material = placed.materials[range.kind];
    const bool is_masked = has_mask(scene_.materials[material]);
    const Drawer& drawer = is_masked ? masked_.base : solid_;
    glUseProgram(drawer.program.name());
    glUniformMatrix4fv(drawer.clip_from_object, 1, GL_FALSE, clip_from_object.data());
    glUniform1ui(drawer.first_id, triangle_ids_.first(instance) + range.first);
    if (is_masked) use_mask(material, mesh);
    draw_triangles(range);
  }
}

void TriangleIdDrawing::use_mask(std::uint32_t material, const MeshBuffers& mesh) const {
  const Material& look = scene_.materials[material];
  const TextureUse& use = look.alpha_texture;
  glUniformMatrix2fv(masked_.uv_scale_rotate, 1, GL_FALSE, use.uv_scale_rotate.data());
  glUniform2f(masked_.uv_offset, use.uv_offset.x(), use.uv_offset.y());
  glUniform2i(masked_.wrap, wrap_number(use.wrap_u), wrap_number(use.wrap_v));
  glUniform1i(masked_.is_linear, use.filter == Filter::linear ? 1 : 0);
  glUniform1f(masked_.opacity, look.opacity);
  glUniform1f(masked_.cutoff, look.alpha_cutoff);
  const auto mask = std::find_if(buffers_.masks.begin(), buffers_.masks.end(),
                                 [&](const MaskTexture& m) { return m.material == material; });
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, mask->texels.name());
  if (!mesh.has_uvs[use.uv_set]) {
    glDisableVertexAttribArray(1);
    glVertexAttrib2f(1, 0.0F, 0.0F);
    return;
  }
  glBindBuffer(GL_ARRAY_BUFFER, mesh.uvs[use.uv_set].name());
  glVertexAttribPointer(1, 2, GL_FLOAT, GL_FALSE, 0, nullptr);
  glEnableVertexAttribArray(1);
}

}  // namespace glidar::opengl
