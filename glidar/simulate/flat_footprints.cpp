// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/simulate/flat_footprints.hpp>

#include <glidar/sensor/lidar/beam_surfaces.hpp>
#include <glidar/simulate/mirrors.hpp>

#include <array>
#include <cmath>
#include <variant>

namespace glidar {
namespace {

/// Sine of the angle that normals at corners may deviate from that of their triangle: roundings of
/// files. At 89 degrees the cosine changes by at most 6e-4 of itself, which shifts the mean range
/// by less than 1e-4 m for the widest footprint that is integrated.
constexpr float kMaxBend = 1e-5F;

/// True if the shading normal is the same on the whole triangle: that of its plane.
bool has_flat_shading(const Mesh& mesh, const Triangle& triangle) {
  if (mesh.normals.empty()) return true;
  const auto corner = [&](std::size_t k) { return mesh.positions_m[triangle[k]]; };
  const Eigen::Vector3f across = (corner(1) - corner(0)).cross(corner(2) - corner(0));
  const float max_squared = kMaxBend * kMaxBend * across.squaredNorm();
  for (const std::uint32_t vertex : triangle) {
    const Eigen::Vector3f& normal = mesh.normals[vertex];
    if (!(normal.dot(across) > 0.0F) ||
        normal.cross(across).squaredNorm() > max_squared * normal.squaredNorm())
      return false;
  }
  return true;
}

}  // namespace

FlatFootprints::FlatFootprints(const Simulation& s)
    : s_(s),
      hits_(s.workspace.sub_rays.hits),
      up_(axes_of(*s.fired).up),
      pulse_sigma_m_(pulse_sigma_m(s.prepared.sensor.receiver)) {}

FlatFootprint FlatFootprints::find(std::size_t first) const {
  FlatFootprint flat{.kind = FlatFootprint::Kind::sampled};
  const PulseModel& model = *s_.prepared.pulse_model;
  if (!model.has_closed_form || hits_.instance[first] == kInvalidId ||
      !is_one_triangle(hits_, first, model.sub_rays.size()))
    return flat;
  const Mesh& mesh = s_.scene.meshes[s_.scene.instances[hits_.instance[first]].mesh];
  const Material& material = material_hit(s_.scene, hits_, first);
  if (!std::holds_alternative<Lambert>(material.backscatter) || material.alpha_cutoff > 0.0F ||
      material.normal_texture.used() ||
      !has_flat_shading(mesh, mesh.triangles[hits_.primitive[first]]))
    return flat;
  const bool has_one_colour = !material.diffuse_texture.used() && mesh.colours.empty();
  if (!has_one_colour && !(hits_.diffuse[first] > 0.0F)) return flat;
  flat.plane = plane_across(s_.workspace.sub_rays.beams.directions[first], up_,
                            hits_.range_m[first], hits_.normal[first].cast<double>());
  if (!has_closed_form(*s_.prepared.sensor.footprint, flat.plane, pulse_sigma_m_)) return flat;
  flat.kind = has_one_colour ? FlatFootprint::Kind::plain : FlatFootprint::Kind::coloured;
  return flat;
}

PulseEcho FlatFootprints::measure(const FlatFootprint& flat, std::size_t first, double signal,
                                  WaveformBuffer& waveform) const {
  const std::vector<SubRay>& rays = s_.prepared.pulse_model->sub_rays;
  std::array<double, kMaxSubRays> excess;
  std::size_t sampled = 0;
  if (flat.kind == FlatFootprint::Kind::coloured) {
    // All have the same material, so reflectances are proportional to the diffuse colours.
    const double per_central = 1.0 / double{hits_.diffuse[first]};
    for (; sampled < rays.size(); ++sampled) {
      excess[sampled] = double{hits_.diffuse[first + sampled]} * per_central - 1.0;
    }
  }
  const PlaneEcho echo = integrate_over_plane(
      *s_.prepared.sensor.footprint, flat.plane,
      s_.prepared.pulse_model->lidar_equation.range_exponent, rays, {excess.data(), sampled});
  const double sum = signal * echo.signal;
  waveform.paths = 0;
  waveform.add({echo.range_m, sum, static_cast<std::uint32_t>(first), ReturnSource::surface});
  const double pulse_m2 = pulse_sigma_m_ * pulse_sigma_m_;
  const double width_m2 = pulse_m2 + echo.variance_m2;
  return {.range_m = echo.range_m,
          .signal = sum * std::sqrt(pulse_m2 / width_m2),
          .sigma_m = std::sqrt(width_m2),
          .strongest = 0,
          .begin = 0,
          .end = 1,
          .is_mixed = false};
}

}  // namespace glidar
