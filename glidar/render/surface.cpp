// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/surface.hpp>

namespace glidar {
namespace {

/// A per-vertex attribute interpolated over the triangle.
template <class Vector>
Vector interpolate(const std::vector<Vector>& values, const SurfacePoint& surface_point) {
  const Triangle& corners = surface_point.mesh.triangles[surface_point.triangle];
  const float w1 = surface_point.weights.x();
  const float w2 = surface_point.weights.y();
  return (1.0F - w1 - w2) * values[corners[0]] + w1 * values[corners[1]] + w2 * values[corners[2]];
}

/// The texel of a material's texture at a point; white when the texture is not used.
Eigen::Vector4f texel_at(const Scene& scene, const SurfacePoint& surface_point,
                         const TextureUse& use) {
  if (!use.used()) return Eigen::Vector4f::Ones();
  return sample(use, scene.textures, uv_at(surface_point, use.uv_set));
}

}  // namespace

const Material& material_at(const Scene& scene, const SurfacePoint& surface_point) {
  return material_of(scene, surface_point.instance, surface_point.triangle);
}

Eigen::Vector2f uv_at(const SurfacePoint& surface_point, std::uint8_t uv_set) {
  const std::vector<Eigen::Vector2f>& uvs = surface_point.mesh.uvs[uv_set];
  return uvs.empty() ? Eigen::Vector2f::Zero() : interpolate(uvs, surface_point);
}

bool is_cut_out(const Scene& scene, const SurfacePoint& surface_point) {
  const Material& material = material_at(scene, surface_point);
  if (!(material.alpha_cutoff > 0.0F)) return false;
  const Eigen::Vector2f uv = uv_at(surface_point, material.alpha_texture.uv_set);
  return opacity_at(material, scene.textures, uv) < material.alpha_cutoff;
}

bool has_normal_map(const Material& material, const Mesh& mesh) {
  return material.normal_texture.used() && !mesh.tangents.empty();
}

Eigen::Vector3f apply_normal_map(const Scene& scene, const SurfacePoint& surface_point,
                                 const Eigen::Vector3f& smooth) {
  const Material& material = material_at(scene, surface_point);
  const Eigen::Vector4f tangent4 = interpolate(surface_point.mesh.tangents, surface_point);
  const Eigen::Vector3f raw = tangent4.head<3>();
  const Eigen::Vector3f along = raw - smooth * smooth.dot(raw);
  const float length = along.norm();
  constexpr float kShortest = 1e-6F;  // below it the direction of +u is not defined here
  if (!(length > kShortest)) return smooth;
  const Eigen::Vector3f tangent = along / length;
  const float sign = tangent4.w() < 0.0F ? -1.0F : 1.0F;
  const Eigen::Vector3f bitangent = sign * smooth.cross(tangent);
  const Eigen::Vector3f rgb = texel_at(scene, surface_point, material.normal_texture).head<3>();
  const Eigen::Vector3f local = 2.0F * rgb - Eigen::Vector3f::Ones();  // n = 2 rgb - 1
  const Eigen::Vector3f normal = tangent * (local.x() * material.normal_scale) +
                                 bitangent * (local.y() * material.normal_scale) +
                                 smooth * local.z();
  const float bent_length = normal.norm();
  return bent_length > kShortest ? Eigen::Vector3f(normal / bent_length) : smooth;
}

}  // namespace glidar
