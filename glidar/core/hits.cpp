// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/hits.hpp>

#include <glidar/math/constants.hpp>

#include <algorithm>
#include <type_traits>

namespace glidar {

HitFieldMask operator|(const HitFieldMask& a, const HitFieldMask& b) {
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
          .poses = a.poses || b.poses};
}

void resize(Hits& hits, std::size_t size, const HitFieldMask& fields) {
  const auto size_if = [size](bool requested) { return requested ? size : std::size_t{0}; };
  hits.range_m.resize(size);
  hits.instance.resize(size);
  hits.primitive.resize(size);
  hits.depth_m.resize(size_if(fields.depth));
  hits.normal.resize(size_if(fields.normal));
  hits.shading_normal.resize(size_if(fields.shading_normal));
  hits.cos_incidence.resize(size_if(fields.incidence));
  hits.cos_shading.resize(size_if(fields.shading));
  hits.barycentrics.resize(size_if(fields.barycentrics));
  hits.colour.resize(size_if(fields.colour));
  hits.diffuse.resize(size_if(fields.diffuse));
  hits.reflectance.resize(size_if(fields.reflectance));
  hits.object_point_m.resize(size_if(fields.object_point));
  hits.noise_scale.resize(size_if(fields.noise_scale));
}

void copy_hit(const Hits& from, std::size_t source, const HitFieldMask& fields, Hits& to,
              std::size_t target) {
  to.range_m[target] = from.range_m[source];
  to.instance[target] = from.instance[source];
  to.primitive[target] = from.primitive[source];
  if (fields.depth) to.depth_m[target] = from.depth_m[source];
  if (fields.normal) to.normal[target] = from.normal[source];
  if (fields.shading_normal) to.shading_normal[target] = from.shading_normal[source];
  if (fields.incidence) to.cos_incidence[target] = from.cos_incidence[source];
  if (fields.shading) to.cos_shading[target] = from.cos_shading[source];
  if (fields.barycentrics) to.barycentrics[target] = from.barycentrics[source];
  if (fields.colour) to.colour[target] = from.colour[source];
  if (fields.diffuse) to.diffuse[target] = from.diffuse[source];
  if (fields.reflectance) to.reflectance[target] = from.reflectance[source];
  if (fields.object_point) to.object_point_m[target] = from.object_point_m[source];
  if (fields.noise_scale) to.noise_scale[target] = from.noise_scale[source];
}

void write_misses(const HitFieldMask& fields, std::size_t first, std::size_t count, Hits& hits) {
  const auto fill = [first, count](bool requested, auto& column, const auto& value) {
    if (requested) std::fill_n(column.begin() + static_cast<std::ptrdiff_t>(first), count, value);
  };
  // Number by number, which compilers vectorise.
  const auto fill_vectors = [first, count](bool requested, auto& column, auto value) {
    constexpr auto kSize =
        static_cast<std::size_t>(std::decay_t<decltype(column)>::value_type::SizeAtCompileTime);
    if (requested && count > 0) std::fill_n(column[first].data(), kSize * count, value);
  };
  fill(true, hits.range_m, kNaN);
  fill(true, hits.instance, kInvalidId);
  fill(true, hits.primitive, kInvalidId);
  fill(fields.depth, hits.depth_m, kNaN);
  fill_vectors(fields.normal, hits.normal, kNaNf);
  fill_vectors(fields.shading_normal, hits.shading_normal, kNaNf);
  fill(fields.incidence, hits.cos_incidence, kNaNf);
  fill(fields.shading, hits.cos_shading, kNaNf);
  fill_vectors(fields.barycentrics, hits.barycentrics, kNaNf);
  fill_vectors(fields.object_point, hits.object_point_m, kNaN);
  fill_vectors(fields.colour, hits.colour, 0.0F);
  fill(fields.diffuse, hits.diffuse, 0.0F);
  fill(fields.reflectance, hits.reflectance, Reflectance{});
  fill(fields.noise_scale, hits.noise_scale, 1.0F);
}

}  // namespace glidar
