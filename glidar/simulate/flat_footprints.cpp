// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/simulate/flat_footprints.hpp>

#include <glidar/simulate/mirrors.hpp>
#include <glidar/simulate/pulse_cast.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <variant>

namespace glidar {
namespace {

/// Sine of the angle that normals at corners may deviate from that of their triangle: roundings of
/// files. At 89 degrees the cosine changes by at most 6e-4 of itself, which shifts the mean range
/// by less than 1e-4 m for the widest footprint that is integrated.
constexpr float kMaxBend = 1e-5F;

/// A vector across the triangle, on its front.
Eigen::Vector3f across(const Mesh& mesh, const Triangle& triangle) {
  const auto corner = [&](std::size_t k) { return mesh.positions_m[triangle[k]]; };
  return (corner(1) - corner(0)).cross(corner(2) - corner(0));
}

/// True if the shading normal is the same on the whole triangle: that of its plane.
bool has_flat_shading(const Mesh& mesh, const Triangle& triangle) {
  if (mesh.normals.empty()) return true;
  const Eigen::Vector3f front = across(mesh, triangle);
  const float max_squared = kMaxBend * kMaxBend * front.squaredNorm();
  for (const std::uint32_t vertex : triangle) {
    const Eigen::Vector3f& normal = mesh.normals[vertex];
    if (!(normal.dot(front) > 0.0F) ||
        normal.cross(front).squaredNorm() > max_squared * normal.squaredNorm())
      return false;
  }
  return true;
}

/// True if two triangles of a mesh are in one plane: the two halves of a rectangle.
bool are_coplanar(const Mesh& mesh, const Triangle& one, const Triangle& other) {
  if (!mesh.origins.empty()) return false;  // vertices may be relative to different ones
  constexpr double kSquared = double{kMaxBend} * double{kMaxBend};
  const Eigen::Vector3d normal = across(mesh, one).cast<double>();
  const Eigen::Vector3d other_normal = across(mesh, other).cast<double>();
  const double size = normal.squaredNorm();
  if (!(normal.cross(other_normal).squaredNorm() <= kSquared * size * other_normal.squaredNorm()))
    return false;
  const Eigen::Vector3d from = mesh.positions_m[one[0]].cast<double>();
  return std::all_of(other.begin(), other.end(), [&](std::uint32_t vertex) {
    const Eigen::Vector3d to = mesh.positions_m[vertex].cast<double>() - from;
    const double height = normal.dot(to);
    return height * height <= kSquared * size * to.squaredNorm();
  });
}

}  // namespace

FlatFootprints::FlatFootprints(const Simulation& s)
    : s_(s),
      hits_(s.workspace.sub_rays.hits),
      up_(axes_of(*s.fired).up),
      pulse_sigma_m_(pulse_sigma_m(s.prepared.sensor.receiver)) {}

/// The triangle that the first sub-ray of a footprint met before, and another of its plane.
struct FlatFootprints::Surface {
  std::uint32_t instance = kInvalidId;
  std::uint32_t primitive = kInvalidId;
  std::uint32_t coplanar = kInvalidId;
  FlatFootprint::Kind kind = FlatFootprint::Kind::sampled;
};

/// The kind of footprints on the triangle if their planes allow it.
FlatFootprint::Kind FlatFootprints::kind_on(std::uint32_t instance, std::uint32_t triangle) const {
  using Kind = FlatFootprint::Kind;
  const Mesh& mesh = s_.scene.meshes[s_.scene.instances[instance].mesh];
  const Material& material = material_of(s_.scene, s_.scene.instances[instance], triangle);
  if (!std::holds_alternative<Lambert>(material.backscatter) || material.alpha_cutoff > 0.0F ||
      material.normal_texture.used() || !has_flat_shading(mesh, mesh.triangles[triangle]))
    return Kind::sampled;
  return material.diffuse_texture.used() || !mesh.colours.empty() ? Kind::coloured : Kind::plain;
}

/// True if footprints on two triangles of an instance, the first with a closed form, have one.
bool FlatFootprints::continues(const Surface& surface, std::uint32_t triangle) const {
  const Instance& instance = s_.scene.instances[surface.instance];
  const Mesh& mesh = s_.scene.meshes[instance.mesh];
  return material_slot(mesh, triangle) == material_slot(mesh, surface.primitive) &&
         are_coplanar(mesh, mesh.triangles[surface.primitive], mesh.triangles[triangle]) &&
         kind_on(surface.instance, triangle) == surface.kind;
}

FlatFootprint::Kind FlatFootprints::kind_of(std::size_t first, Surface& last) const {
  using Kind = FlatFootprint::Kind;
  const PulseModel& model = *s_.prepared.pulse_model;
  const std::size_t end = first + model.sub_rays.size();
  const std::uint32_t instance = hits_.instance[first];
  const std::uint32_t primitive = hits_.primitive[first];
  if (!model.has_closed_form) return Kind::sampled;
  for (std::size_t ray = first + 1; ray < end; ++ray) {
    if (hits_.instance[ray] != instance) return Kind::sampled;
  }
  if (instance == kInvalidId) return Kind::nothing;
  if (instance != last.instance || primitive != last.primitive)
    last = {.instance = instance, .primitive = primitive, .kind = kind_on(instance, primitive)};
  const bool is_black = last.kind == Kind::coloured && !(hits_.diffuse[first] > 0.0F);
  if (last.kind == Kind::sampled || is_black) return Kind::sampled;
  for (std::size_t ray = first + 1; ray < end; ++ray) {
    const std::uint32_t other = hits_.primitive[ray];
    if (other == primitive || other == last.coplanar) continue;
    if (!continues(last, other)) return Kind::sampled;
    last.coplanar = other;
  }
  return last.kind;
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
      flat.moments = moments_of(planes, i);
    } else {
      flat.kind = FlatFootprint::Kind::sampled;
    }
  }
  planes.count = 0;
}

void FlatFootprints::measure(BeamRange pulses, FlatEchoes& echoes) const {
  measure(pulses, FlatFootprint::Kind::plain, echoes);
  measure(pulses, FlatFootprint::Kind::coloured, echoes);
}

/// Of the pulses of one kind.
void FlatFootprints::measure(BeamRange pulses, FlatFootprint::Kind kind, FlatEchoes& echoes) const {
  const SubRayWorkspace& memory = s_.workspace.sub_rays;
  const std::vector<SubRay>& rays = s_.prepared.pulse_model->sub_rays;
  const bool is_coloured = kind == FlatFootprint::Kind::coloured;
  PlaneBatch planes;
  PlaneBatch::Column signal;
  std::array<std::size_t, PlaneBatch::kMax> in_run;
  std::array<PlaneBatch::Column, kMaxSubRays> excess;
  const auto finish = [&] {
    if (is_coloured) {
      add_excess(s_.prepared.pulse_model->lidar_equation.range_exponent, rays, excess, planes);
    }
    PlaneEchoes found;
    find_echoes(pulse_sigma_m_, signal, planes, found);
    for (std::size_t i = 0; i < planes.count; ++i) {
      echoes.range_m[in_run[i]] = found.range_m[i];
      echoes.signal[in_run[i]] = found.signal[i];
      echoes.peak[in_run[i]] = found.peak[i];
      echoes.sigma_m[in_run[i]] = found.sigma_m[i];
    }
    planes.count = 0;
  };
  for (std::size_t pulse = pulses.begin; pulse < pulses.end; ++pulse) {
    const FlatFootprint& flat = memory.flat[pulse - memory.first_pulse];
    if (flat.kind != kind) continue;
    const std::size_t first = first_sub_ray(s_, pulse);
    const std::size_t i = planes.count++;
    set_moments(flat.moments, i, planes);
    signal[i] = memory.signals[first];
    in_run[i] = pulse - pulses.begin;
    // All have the same material, so reflectances are proportional to the diffuse colours.
    const double per_central = is_coloured ? 1.0 / double{hits_.diffuse[first]} : 0.0;
    for (std::size_t k = 0; is_coloured && k < rays.size(); ++k) {
      excess[k][i] = double{hits_.diffuse[first + k]} * per_central - 1.0;
    }
    if (planes.count == PlaneBatch::kMax) finish();
  }
  finish();
}

}  // namespace glidar
