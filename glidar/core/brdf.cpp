// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/brdf.hpp>

#include <glidar/core/field_visitor.hpp>

namespace glidar {
namespace {

constexpr NumberRule kLobeWidth = {0.0, 180.0, true, "degrees above 0 and below 180"};

}  // namespace

void describe(Lambert& /*lambert*/, FieldVisitor& /*visitor*/) {}

void describe(PhongLike& phong, FieldVisitor& visitor) {
  visitor.number({"specular_fraction", "share of the lobe"}, kZeroToOne, phong.specular_fraction);
  visitor.number({"exponent", "of the lobe"}, kFromZero, phong.exponent);
}

void describe(OrenNayar& oren_nayar, FieldVisitor& visitor) {
  visitor.number({"roughness_deg", "standard deviation of the facets' slopes", kUnitDegree},
                 {0.0, 90.0, false, "degrees from 0 to 90"}, oren_nayar.roughness_rad);
}

void describe(RetroReflector& retro, FieldVisitor& visitor) {
  visitor.number({"gain", "relative to a white diffuse surface"}, kAboveZero, retro.gain);
  visitor.number({"width_deg", "of the lobe", kUnitDegree}, kLobeWidth, retro.width_rad);
}

void describe(Glossy& glossy, FieldVisitor& visitor) {
  visitor.number({"diffuse_fraction", "share of the diffuse part"}, kZeroToOne,
                 glossy.diffuse_fraction);
  visitor.number({"lobe_gain", "middle of the lobe relative to a white diffuse surface"}, kFromZero,
                 glossy.lobe_gain);
  visitor.number({"width_deg", "standard deviation of the lobe", kUnitDegree}, kLobeWidth,
                 glossy.width_rad);
}

void describe(Brdf& brdf, FieldVisitor& visitor) {
  visit_variant(visitor, {"type", "the form of the backscatter", kNoUnit, kRequired}, brdf);
}

}  // namespace glidar
