// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/simulate/flat_footprints.hpp>

#include <glidar/sensor/lidar/beam_surfaces.hpp>
#include <glidar/simulate/mirrors.hpp>
#include <glidar/simulate/pulse_cast.hpp>

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

/// The triangle that a footprint met before.
struct FlatFootprints::Surface {
  std::uint32_t instance = kInvalidId;
  std::uint32_t primitive = kInvalidId;
  FlatFootprint::Kind kind = FlatFootprint::Kind::sampled;
};

/// The kind of footprints on the triangle of a hit if their planes allow it.
FlatFootprint::Kind FlatFootprints::kind_of_surface(std::size_t first) const {
  using Kind = FlatFootprint::Kind;
  const Mesh& mesh = s_.scene.meshes[s_.scene.instances[hits_.instance[first]].mesh];
  const Material& material = material_hit(s_.scene, hits_, first);
  if (!std::holds_alternative<Lambert>(material.backscatter) || material.alpha_cutoff > 0.0F ||
      material.normal_texture.used() ||
      !has_flat_shading(mesh, mesh.triangles[hits_.primitive[first]]))
    return Kind::sampled;
  return material.diffuse_texture.used() || !mesh.colours.empty() ? Kind::coloured : Kind::plain;
}

FlatFootprint::Kind FlatFootprints::kind_of(std::size_t first, Surface& last) const {
  using Kind = FlatFootprint::Kind;
  const PulseModel& model = *s_.prepared.pulse_model;
  if (!model.has_closed_form || !is_one_triangle(hits_, first, model.sub_rays.size()))
    return Kind::sampled;
  if (hits_.instance[first] == kInvalidId) return Kind::nothing;
  if (hits_.instance[first] != last.instance || hits_.primitive[first] != last.primitive)
    last = {hits_.instance[first], hits_.primitive[first], kind_of_surface(first)};
  const bool is_black = last.kind == Kind::coloured && !(hits_.diffuse[first] > 0.0F);
  return is_black ? Kind::sampled : last.kind;
}

void FlatFootprints::find(BeamRange pulses) const {
  SubRayWorkspace& memory = s_.workspace.sub_rays;
  PlaneBatch planes;
  std::array<FlatFootprint*, PlaneBatch::kMax> footprints;
  Surface last;
  for (std::size_t pulse = pulses.begin; pulse < pulses.end; ++pulse) {
    FlatFootprint& flat = memory.flat[pulse - memory.first_pulse];
    const std::size_t first = first_sub_ray(s_, pulse);
    flat.kind = kind_of(first, last);
    if (!flat.is_in_closed_form()) continue;
    const std::size_t i = planes.count++;
    planes.direction.set(i, memory.beams.directions[first]);
    planes.normal.set(i, hits_.normal[first].cast<double>());
    planes.range_m[i] = hits_.range_m[first];
    footprints[i] = &flat;
    if (planes.count == PlaneBatch::kMax) integrate(planes, footprints);
  }
  integrate(planes, footprints);
}

void FlatFootprints::integrate(PlaneBatch& planes,
                               std::span<FlatFootprint* const> footprints) const {
  find_tilts(up_, planes);
  integrate_over_planes({*s_.prepared.sensor.footprint,
                         s_.prepared.pulse_model->lidar_equation.range_exponent, pulse_sigma_m_},
                        planes);
  for (std::size_t i = 0; i < planes.count; ++i) {
    FlatFootprint& flat = *footprints[i];
    if (planes.has_closed_form[i]) {
      flat.echo = plane_echo(planes, i);
    } else {
      flat.kind = FlatFootprint::Kind::sampled;
    }
  }
  planes.count = 0;
}

PulseEcho FlatFootprints::measure(const FlatFootprint& flat, std::size_t first, double signal,
                                  WaveformBuffer& waveform) const {
  PlaneEcho echo = flat.echo;
  if (flat.kind == FlatFootprint::Kind::coloured) {
    // All have the same material, so reflectances are proportional to the diffuse colours.
    const std::vector<SubRay>& rays = s_.prepared.pulse_model->sub_rays;
    const double per_central = 1.0 / double{hits_.diffuse[first]};
    std::array<double, kMaxSubRays> excess;
    for (std::size_t k = 0; k < rays.size(); ++k) {
      excess[k] = double{hits_.diffuse[first + k]} * per_central - 1.0;
    }
    echo.add_excess(s_.prepared.pulse_model->lidar_equation.range_exponent, rays,
                    {excess.data(), rays.size()});
  }
  const double sum = signal * echo.moment[0];
  const double range_m = echo.mean_range_m();
  waveform.paths = 0;
  waveform.add({range_m, sum, static_cast<std::uint32_t>(first), ReturnSource::surface});
  const double pulse_m2 = pulse_sigma_m_ * pulse_sigma_m_;
  const double width_m2 = pulse_m2 + echo.variance_m2();
  return {.range_m = range_m,
          .signal = sum * std::sqrt(pulse_m2 / width_m2),
          .sigma_m = std::sqrt(width_m2),
          .strongest = 0,
          .begin = 0,
          .end = 1,
          .is_mixed = false};
}

}  // namespace glidar
