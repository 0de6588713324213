// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/material.hpp>
#include <glidar/math/constants.hpp>

#include <gtest/gtest.h>

namespace glidar {
namespace {

/// Two by two grey texels: top row 0 51, bottom row 102 255.
std::vector<Texture> grey() {
  return {{.name = "grey", .width = 2, .height = 2, .channels = 1, .texels = {0, 51, 102, 255}}};
}

float grey_at(const TextureUse& use, float u, float v) {
  return sample(use, grey(), {u, v}).x() * 255.0F;
}

TEST(Sample, HasVUpwardsAndTexelCentresAtHalves) {
  const TextureUse use{.texture = 0, .filter = Filter::nearest};
  EXPECT_FLOAT_EQ(grey_at(use, 0.25F, 0.75F), 0.0F);
  EXPECT_FLOAT_EQ(grey_at(use, 0.75F, 0.75F), 51.0F);
  EXPECT_FLOAT_EQ(grey_at(use, 0.25F, 0.25F), 102.0F);
  EXPECT_FLOAT_EQ(grey_at(use, 0.75F, 0.25F), 255.0F);
}

TEST(Sample, InterpolatesBetweenCentres) {
  const TextureUse use{.texture = 0, .wrap_u = Wrap::clamp, .wrap_v = Wrap::clamp};
  EXPECT_FLOAT_EQ(grey_at(use, 0.25F, 0.75F), 0.0F);
  EXPECT_NEAR(grey_at(use, 0.5F, 0.75F), 25.5F, 1e-4F);
  EXPECT_NEAR(grey_at(use, 0.5F, 0.5F), (0.0F + 51.0F + 102.0F + 255.0F) / 4.0F, 1e-4F);
}

TEST(Sample, WrapsRepeatsAndMirrors) {
  TextureUse use{.texture = 0, .filter = Filter::nearest};
  EXPECT_FLOAT_EQ(grey_at(use, 1.25F, 0.75F), 0.0F);
  EXPECT_FLOAT_EQ(grey_at(use, -0.25F, 0.75F), 51.0F);
  use.wrap_u = Wrap::mirror;
  EXPECT_FLOAT_EQ(grey_at(use, 1.25F, 0.75F), 51.0F);
  EXPECT_FLOAT_EQ(grey_at(use, -0.25F, 0.75F), 0.0F);
  use.wrap_u = Wrap::clamp;
  EXPECT_FLOAT_EQ(grey_at(use, 7.0F, 0.75F), 51.0F);
  EXPECT_FLOAT_EQ(grey_at(use, -7.0F, 0.75F), 0.0F);
}

TEST(Sample, AppliesTheUvTransform) {
  TextureUse use{.texture = 0, .filter = Filter::nearest};
  use.uv_scale_rotate = 2.0F * Eigen::Matrix2f::Identity();
  use.uv_offset = {0.5F, 0.0F};
  EXPECT_FLOAT_EQ(grey_at(use, 0.125F, 0.375F), 51.0F);  // looked up at 0.75, 0.75
}

TEST(Sample, CopiesGreyToRgbAndKeepsAlpha) {
  const std::vector<Texture> textures = {
      {.name = "ga", .width = 1, .height = 1, .channels = 2, .texels = {51, 102}}};
  const Eigen::Vector4f found = sample({.texture = 0}, textures, {0.5F, 0.5F});
  EXPECT_TRUE(found.isApprox(Eigen::Vector4f(0.2F, 0.2F, 0.2F, 0.4F)));
}

TEST(Sample, SurvivesHugeAndUndefinedCoordinates) {
  const TextureUse use{.texture = 0};
  const float nan = kNaNf;
  EXPECT_TRUE(sample(use, grey(), {1e30F, -1e30F}).allFinite());
  EXPECT_EQ(sample(use, grey(), {nan, 0.0F}), Eigen::Vector4f::Ones());
}

TEST(OpacityAt, IsAlphaOrElseGrey) {
  Material material;
  material.opacity = 0.5F;
  EXPECT_FLOAT_EQ(opacity_at(material, grey(), {0.75F, 0.25F}), 0.5F);
  material.alpha_texture = {.texture = 0, .filter = Filter::nearest};
  EXPECT_FLOAT_EQ(opacity_at(material, grey(), {0.25F, 0.25F}), 0.2F);
}

}  // namespace
}  // namespace glidar
