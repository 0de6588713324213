// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/error.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/sensor/sensor.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace glidar {
namespace {

/// One beam that meets a surface whose shading normal makes `cosine` with it.
float intensity(const PhongHeadlight& light, const Reflectance& reflectance, double range_m,
                float cosine) {
  Frame frame;
  resize(frame, 1);
  frame.status = {Status::hit};
  frame.ground_truth.range_m = {range_m};
  frame.ground_truth.cos_shading = {cosine};
  frame.ground_truth.reflectance = {reflectance};
  shade_phong(light, {0, 1}, frame);
  return frame.intensity[0];
}

TEST(PhongHeadlight, MatchesEquationsThreeToFive) {
  const PhongHeadlight light{.attenuation_constant = 1.5,
                             .attenuation_linear_per_m = 0.2,
                             .attenuation_quadratic_per_m2 = 0.03,
                             .ambient = 0.2};
  const Reflectance surface{.diffuse = 0.6F, .ambient = 0.5F, .specular = 0.3F, .shininess = 12.0F};
  const double d = 4.0;
  const double c = 0.8;
  const double a = 1.0 / (1.5 + 0.2 * d + 0.03 * d * d);                // (3)
  const double colour = 0.2 * 0.5 + 0.6 * c + 0.3 * std::pow(c, 12.0);  // (5)
  EXPECT_NEAR(intensity(light, surface, d, 0.8F), a * colour, 1e-6);    // (4)
}

TEST(PhongHeadlight, BackFacesHaveTheAmbientTermOnly) {
  const PhongHeadlight light{.attenuation_linear_per_m = 0.0, .attenuation_quadratic_per_m2 = 0.0};
  const Reflectance surface{.diffuse = 1.0F, .ambient = 0.5F, .specular = 1.0F, .shininess = 2.0F};
  EXPECT_FLOAT_EQ(intensity(light, surface, 3.0, -0.5F), 0.2F * 0.5F);
}

TEST(PhongHeadlight, ShininessZeroMakesTheSpecularConstant) {
  const PhongHeadlight light{
      .attenuation_linear_per_m = 0.0, .attenuation_quadratic_per_m2 = 0.0, .ambient = 0.0};
  EXPECT_FLOAT_EQ(intensity(light, {.specular = 0.4F}, 1.0, 0.3F), 0.4F);
}

TEST(PhongHeadlight, IsZeroWhereNothingIsReported) {
  Frame frame;
  resize(frame, 1);
  frame.ground_truth.range_m = {1.0};
  frame.ground_truth.cos_shading = {1.0F};
  frame.ground_truth.reflectance = {{.diffuse = 1.0F, .ambient = 1.0F, .specular = 1.0F}};
  frame.status = {Status::too_far};
  shade_phong({}, {0, 1}, frame);
  EXPECT_EQ(frame.intensity[0], 0.0F);
}

TEST(PhongHeadlight, RejectsNegativeAndUndefinedNumbers) {
  EXPECT_NO_THROW(validate(PhongHeadlight{}));
  EXPECT_THROW(validate(PhongHeadlight{.attenuation_linear_per_m = -1.0}), Error);
  EXPECT_THROW(validate(PhongHeadlight{.ambient = kNaN}), Error);
  EXPECT_THROW(validate(PhongHeadlight{.attenuation_constant = 0.0,
                                       .attenuation_linear_per_m = 0.0,
                                       .attenuation_quadratic_per_m2 = 0.0}),
               Error);
}

}  // namespace
}  // namespace glidar
