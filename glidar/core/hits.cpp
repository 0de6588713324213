// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/hits.hpp>

#include <glidar/math/constants.hpp>
#include <glidar/math/simd.hpp>

#include <algorithm>
#include <type_traits>

namespace glidar {
namespace {

// std::fill_n() uses the vectors of the oldest processor only.
GLIDAR_SIMD void fill_numbers(double* first, std::size_t count, double value) {
  for (std::size_t i = 0; i < count; ++i) first[i] = value;
}
GLIDAR_SIMD void fill_numbers(float* first, std::size_t count, float value) {
  for (std::size_t i = 0; i < count; ++i) first[i] = value;
}

}  // namespace

HitColumnMask operator|(const HitColumnMask& a, const HitColumnMask& b) {
  return {.depth = a.depth || b.depth,
          .normal = a.normal || b.normal,
          .shading_normal = a.shading_normal || b.shading_normal,
          .incidence = a.incidence || b.incidence,
          .shading = a.shading || b.shading,
          .barycentrics = a.barycentrics || b.barycentrics,
          .colour = a.colour || b.colour,
          .diffuse = a.diffuse || b.diffuse,
          .reflectance = a.reflectance || b.reflectance,
          .object_point = a.object_point || b.object_point,
          .noise_scale = a.noise_scale || b.noise_scale,
          .poses = a.poses || b.poses,
          .radial_velocity = a.radial_velocity || b.radial_velocity,
          .boxes = a.boxes || b.boxes};
}

void resize(Hits& hits, std::size_t size, const HitColumnMask& hit_columns) {
  const auto size_if = [size](bool requested) { return requested ? size : std::size_t{0}; };
  hits.range_m.resize(size);
  hits.instance.resize(size);
  hits.primitive.resize(size);
  hits.depth_m.resize(size_if(hit_columns.depth));
  hits.normal.resize(size_if(hit_columns.normal));
  hits.shading_normal.resize(size_if(hit_columns.shading_normal));
  hits.cos_incidence.resize(size_if(hit_columns.incidence));
  hits.cos_shading.resize(size_if(hit_columns.shading));
  hits.barycentrics.resize(size_if(hit_columns.barycentrics));
  hits.colour.resize(size_if(hit_columns.colour));
  hits.diffuse.resize(size_if(hit_columns.diffuse));
  hits.reflectance.resize(size_if(hit_columns.reflectance));
  hits.object_point_m.resize(size_if(hit_columns.object_point));
  hits.noise_scale.resize(size_if(hit_columns.noise_scale));
}

void copy_hit(const Hits& from, std::size_t source, const HitColumnMask& hit_columns, Hits& to,
              std::size_t target) {
  to.range_m[target] = from.range_m[source];
  to.instance[target] = from.instance[source];
  to.primitive[target] = from.primitive[source];
  if (hit_columns.depth) to.depth_m[target] = from.depth_m[source];
  if (hit_columns.normal) to.normal[target] = from.normal[source];
  if (hit_columns.shading_normal) to.shading_normal[target] = from.shading_normal[source];
  if (hit_columns.incidence) to.cos_incidence[target] = from.cos_incidence[source];
  if (hit_columns.shading) to.cos_shading[target] = from.cos_shading[source];
  if (hit_columns.barycentrics) to.barycentrics[target] = from.barycentrics[source];
  if (hit_columns.colour) to.colour[target] = from.colour[source];
  if (hit_columns.diffuse) to.diffuse[target] = from.diffuse[source];
  if (hit_columns.reflectance) to.reflectance[target] = from.reflectance[source];
  if (hit_columns.object_point) to.object_point_m[target] = from.object_point_m[source];
  if (hit_columns.noise_scale) to.noise_scale[target] = from.noise_scale[source];
}

void write_misses(const HitColumnMask& hit_columns, std::size_t first, std::size_t count,
                  Hits& hits) {
  const auto fill = [first, count](bool requested, auto& column, const auto& value) {
    if (requested) std::fill_n(column.begin() + static_cast<std::ptrdiff_t>(first), count, value);
  };
  const auto fill_vectors = [first, count](bool requested, auto& column, auto value) {
    constexpr auto kSize =
        static_cast<std::size_t>(std::decay_t<decltype(column)>::value_type::SizeAtCompileTime);
    if (requested && count > 0) fill_numbers(column[first].data(), kSize * count, value);
  };
  fill_numbers(hits.range_m.data() + first, count, kNaN);
  fill(true, hits.instance, kInvalidId);
  fill(true, hits.primitive, kInvalidId);
  fill(hit_columns.depth, hits.depth_m, kNaN);
  fill_vectors(hit_columns.normal, hits.normal, kNaNf);
  fill_vectors(hit_columns.shading_normal, hits.shading_normal, kNaNf);
  fill(hit_columns.incidence, hits.cos_incidence, kNaNf);
  fill(hit_columns.shading, hits.cos_shading, kNaNf);
  fill_vectors(hit_columns.barycentrics, hits.barycentrics, kNaNf);
  fill_vectors(hit_columns.object_point, hits.object_point_m, kNaN);
  fill_vectors(hit_columns.colour, hits.colour, 0.0F);
  fill(hit_columns.diffuse, hits.diffuse, 0.0F);
  fill(hit_columns.reflectance, hits.reflectance, Reflectance{});
  fill(hit_columns.noise_scale, hits.noise_scale, 1.0F);
}

}  // namespace glidar
