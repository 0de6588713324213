// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause

#include <glidar/core/beams.hpp>
#include <glidar/core/error.hpp>
#include <glidar/core/phong_headlight.hpp>
#include <glidar/core/scene.hpp>
#include <glidar/render/draw_order.hpp>
#include <glidar/render/grid_window.hpp>
#include <glidar/render/opengl/draw_state.hpp>
#include <glidar/render/opengl/egl_context.hpp>
#include <glidar/render/opengl/gl_object.hpp>
#include <glidar/render/pieces_renderer.hpp>
#include <glidar/render/pinhole_only.hpp>
#include <glidar/render/planes.hpp>
#include <glidar/render/resolver.hpp>
#include <glidar/render/triangle_ids.hpp>
#include <glidar/render/visible_depths.hpp>
#include <glidar/render/woods2016_camera.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
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

Eigen::Matrix4f clip_from_object(const InstanceView& view, const PinholeIntrinsics& k,
                                 const PixelRect& rect, const DepthRange& depths) {
  // A beam goes through pixel (u, v) at u + pixel_centre; windows have centres at u + 0.5.
  const double centre_x = k.cx - k.pixel_centre + 0.5 - rect.first_col;
  const double centre_y = k.cy - k.pixel_centre + 0.5 - rect.first_row;
  const double to_depth = depths.near_m / (depths.far_m - depths.near_m);
  const Eigen::Matrix<double, 3, 4> sensor_matrix = sensor_from_object(view);
  Eigen::Matrix4d clip;
  clip.row(0) = 2.0 * k.fx / rect.cols * sensor_matrix.row(0) +
                (2.0 * centre_x / rect.cols - 1.0) * sensor_matrix.row(2);
  clip.row(1) = 2.0 * k.fy / rect.rows * sensor_matrix.row(1) +
                (2.0 * centre_y / rect.rows - 1.0) * sensor_matrix.row(2);
  clip.row(2) = -to_depth * sensor_matrix.row(2);
  clip(2, 3) += to_depth * depths.far_m;
  clip.row(3) = sensor_matrix.row(2);
  // Some graphics devices draw nothing at 1e-30 m. A common factor of all four coordinates has no
  // other effect, and a power of two rounds nothing.
  return (std::ldexp(1.0, -std::ilogb(depths.far_m)) * clip).cast<float>();
}

namespace {

template <class Value>
void fill(const Buffer& buffer, GLenum target, const std::vector<Value>& values) {
  glBindBuffer(target, buffer.name());
  glBufferData(target, static_cast<GLsizeiptr>(values.size() * sizeof(Value)), values.data(),
               GL_STATIC_DRAW);
}

/// Uploads an attribute of the bound vertex array, if the mesh has it.
template <class Vector>
void give(GLuint attribute, const DrawOrder& order, const std::vector<Vector>& values,
          ShadedMesh& mesh) {
  if (values.empty()) return;
  fill(mesh.attributes.emplace_back(), GL_ARRAY_BUFFER, in_order(order, values));
  glVertexAttribPointer(attribute, Vector::RowsAtCompileTime, GL_FLOAT, GL_FALSE, 0, nullptr);
  glEnableVertexAttribArray(attribute);
}

void upload_flat_normals(const Mesh& mesh, const std::vector<std::uint32_t>& drawn,
                         const ShadedMesh& shaded) {
  GLint max_size = 0;
  glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &max_size);
  if (drawn.size() > static_cast<std::size_t>(max_size)) {
    throw Error({.where = "opengl renderer",
                 .found = "a mesh of " + std::to_string(drawn.size()) + " triangles",
                 .allowed = "up to " + std::to_string(max_size) +
                            " with this driver's quantized framebuffer",
                 .remedy = "leave --quantized-framebuffer out"});
  }
  std::vector<Eigen::Vector4f> normals;
  normals.reserve(drawn.size());
  for (const std::uint32_t t : drawn) {
    normals.push_back(plane_of(mesh, t).normal.cast<float>().homogeneous());
  }
  fill(shaded.flat_normals, GL_TEXTURE_BUFFER, normals);
  glBindTexture(GL_TEXTURE_BUFFER, shaded.flat_normals_view.name());
  glTexBuffer(GL_TEXTURE_BUFFER, GL_RGBA32F, shaded.flat_normals.name());
}

/// Interpolated unit vectors less than 120 degrees apart do not vanish.
bool has_smooth_normals(const Mesh& mesh, const Triangle& t) {
  constexpr float kCosineOf120 = -0.5F;
  if (mesh.normals.empty()) return false;
  const Eigen::Vector3f& a = mesh.normals[t[0]];
  const Eigen::Vector3f& b = mesh.normals[t[1]];
  const Eigen::Vector3f& c = mesh.normals[t[2]];
  return std::min({a.dot(b), b.dot(c), c.dot(a)}) > kCosineOf120;
}

std::vector<std::uint32_t> kinds_of(const Mesh& mesh) {
  std::vector<std::uint32_t> kinds;
  kinds.reserve(mesh.triangles.size());
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    kinds.push_back(kind_of(material_slot(mesh, i), has_smooth_normals(mesh, mesh.triangles[i])));
  }
  return kinds;
}

ShadedMesh upload_mesh(const Mesh& mesh) {
  ShadedMesh shaded;
  DrawOrder order = draw_order(mesh, kinds_of(mesh));
  glBindVertexArray(shaded.arrays.name());
  give(0, order, mesh.positions_m, shaded);
  give(1, order, mesh.uvs[0], shaded);
  give(2, order, mesh.uvs[1], shaded);
  give(3, order, mesh.normals, shaded);
  give(4, order, mesh.tangents, shaded);
  give(5, order, mesh.colours, shaded);
  fill(shaded.triangles, GL_ELEMENT_ARRAY_BUFFER, order.triangles);
  upload_flat_normals(mesh, order.drawn, shaded);
  shaded.ranges = std::move(order.ranges);
  return shaded;
}

/// Converts a texture to RGBA; a missing alpha is opaque.
std::vector<std::uint8_t> to_rgba(const Texture& texture) {
  const std::size_t pixels = std::size_t{texture.width} * texture.height;
  const std::size_t n = texture.channels;
  const bool is_grey = n < 3;
  const bool has_alpha = n == 2 || n == 4;
  std::vector<std::uint8_t> rgba(4 * pixels);
  for (std::size_t i = 0; i < pixels; ++i) {
    const std::uint8_t* from = &texture.texels[n * i];
    rgba[4 * i] = from[0];
    rgba[4 * i + 1] = from[is_grey ? 0 : 1];
    rgba[4 * i + 2] = from[is_grey ? 0 : 2];
    rgba[4 * i + 3] = has_alpha ? from[n - 1] : std::uint8_t{255};
  }
  return rgba;
}

GlTexture upload_texture(const Texture& texture) {
  GlTexture uploaded;
  const std::vector<std::uint8_t> rgba = to_rgba(texture);
  glBindTexture(GL_TEXTURE_2D, uploaded.name());
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, static_cast<GLsizei>(texture.width),
               static_cast<GLsizei>(texture.height), 0, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);  // there are no smaller levels
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  return uploaded;
}

}  // namespace

ShadedScene upload_shaded(const Scene& scene) {
  ShadedScene shaded;
  for (const Mesh& mesh : scene.meshes) shaded.meshes.push_back(upload_mesh(mesh));
  for (const Texture& texture : scene.textures) {
    shaded.textures.push_back(upload_texture(texture));
  }
  check_gl("taking the scene into the graphics device's memory");
  return shaded;
}

void Woods2016Target::begin(std::uint32_t rows, std::uint32_t cols) {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  GLint max_size = 0;
  glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &max_size);
  if (rows > static_cast<std::uint32_t>(max_size) || cols > static_cast<std::uint32_t>(max_size)) {
    throw Error({.where = "quantized framebuffer",
                 .found = std::to_string(cols) + " x " + std::to_string(rows) + " pixels",
                 .allowed = "up to " + std::to_string(max_size) + " on a side with this driver",
                 .remedy = "leave --quantized-framebuffer out"});
  }
  if (rows_ != static_cast<GLsizei>(rows) || cols_ != static_cast<GLsizei>(cols)) {
    rows_ = static_cast<GLsizei>(rows);
    cols_ = static_cast<GLsizei>(cols);
    glBindRenderbuffer(GL_RENDERBUFFER, colours_.name());
    glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, cols_, rows_);
    glBindRenderbuffer(GL_RENDERBUFFER, depths_.name());
    glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT32F, cols_, rows_);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER,
                              colours_.name());
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depths_.name());
    check_gl("allocating a framebuffer");
  }
  glViewport(0, 0, cols_, rows_);
  constexpr std::array<GLfloat, 4> kNoPaper = {0.0F, 0.0F, 0.0F, 0.0F};
  constexpr GLfloat kFarthest = 0.0F;
  glClearBufferfv(GL_COLOR, 0, kNoPaper.data());
  glClearBufferfv(GL_DEPTH, 0, &kFarthest);
}

void Woods2016Target::read(std::vector<std::uint8_t>& rgba) {
  rgba.resize(std::size_t{4} * static_cast<std::size_t>(rows_) * static_cast<std::size_t>(cols_));
  glReadPixels(0, 0, cols_, rows_, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  check_not_lost();
  check_gl("reading a framebuffer");
}

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

namespace glidar {
namespace {

class OpenglWoods2016Camera final : public Woods2016Camera {
 public:
  OpenglWoods2016Camera(const Scene& scene, const RendererOptions& options,
                        std::unique_ptr<opengl::Context> context)
      : thread_pool_(options.threads), resolver_(scene), context_(std::move(context)) {
    const opengl::ScopedDrawState state(*context_);
    gpu_ = std::make_unique<GpuResources>(scene);
  }

  ~OpenglWoods2016Camera() override {
    const opengl::ScopedDrawState state(*context_);
    gpu_.reset();
  }

  void draw(const CastRequest& request, const PhongHeadlight& light,
            const std::optional<Woods2016DepthPlanes>& planes,
            Woods2016Framebuffer& framebuffer) override {
    check(request, resolver_.scene());
    check_pinhole(request.beams, "opengl");
    resolver_.set_poses(request.world_from_sensor, request.world_from_instance);
    framebuffer.rows = request.beams.rows;
    framebuffer.cols = request.beams.cols;
    const Woods2016DepthPlanes used = planes ? *planes : tight_depth_planes(request);
    framebuffer.near_m = used.near_m;
    framebuffer.far_m = used.far_m;
    if (!(used.far_m > used.near_m)) {
      framebuffer.rgba.assign(std::size_t{4} * framebuffer.rows * framebuffer.cols, 0);
      return;
    }
    const opengl::ScopedDrawState state(*context_);
    gpu_->target.begin(framebuffer.rows, framebuffer.cols);
    gpu_->drawing.draw(request, resolver_,
                       {.pinhole = *request.beams.pinhole,
                        .light = light,
                        .planes = used,
                        .depths = tight_depth_range(used.near_m, used.far_m)});
    gpu_->target.read(framebuffer.rgba);
  }

 private:
  /// Objects in the memory of the graphics device.
  struct GpuResources {
    explicit GpuResources(const Scene& scene) : drawing(scene) {}
    opengl::Woods2016Drawing drawing;
    opengl::Woods2016Target target;
  };

  /// Section 2.3 of the paper: planes tightly around the visible surfaces.
  [[nodiscard]] Woods2016DepthPlanes tight_depth_planes(const CastRequest& request) {
    const Scene& scene = resolver_.scene();
    DepthSpan span;
    for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
      if (!is_enabled(request, i)) continue;
      span.extend(visible_depths_.of(resolver_.view(i), resolver_.mesh(i), *request.beams.pinhole,
                                     thread_pool_));
    }
    // A surface across the boresight has one depth; the planes must not coincide.
    constexpr double kMinGap = 1e-6;
    const double margin = kMinGap * span.farthest_m - (span.farthest_m - span.nearest_m);
    if (margin > 0.0) return {span.nearest_m - 0.5 * margin, span.farthest_m + 0.5 * margin};
    return {span.nearest_m, span.farthest_m};
  }

  ThreadPool thread_pool_;
  Resolver resolver_;
  VisibleDepths visible_depths_;
  std::unique_ptr<opengl::Context> context_;
  std::unique_ptr<GpuResources> gpu_;
};

}  // namespace

std::unique_ptr<Woods2016Camera> make_woods2016_camera(const Scene& scene,
                                                       const RendererOptions& options) {
  validate(scene);
  return make_woods2016_camera(scene, options,
                               std::make_unique<opengl::EglContext>(options.graphics_device));
}

std::unique_ptr<Woods2016Camera> make_woods2016_camera(const Scene& scene,
                                                       const RendererOptions& options,
                                                       std::unique_ptr<opengl::Context> context) {
  validate(scene);
  const auto make = [&](const Scene& whole) -> std::unique_ptr<Woods2016Camera> {
    return std::make_unique<OpenglWoods2016Camera>(whole, options, std::move(context));
  };
  return has_pieces(scene) ? make_pieces_camera(scene, make) : make(scene);
}

}  // namespace glidar
