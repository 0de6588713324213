// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/model/height_map.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace glidar {
namespace {

Texture grey(std::uint32_t width, std::uint32_t height, auto height_at) {
  Texture image{"heights", width, height, 1, {}};
  for (std::uint32_t row = 0; row < height; ++row) {
    for (std::uint32_t column = 0; column < width; ++column) {
      image.texels.push_back(static_cast<std::uint8_t>(height_at(row, column)));
    }
  }
  return image;
}

/// The normal that a renderer makes of a texel.
Eigen::Vector3d normal_at(const HeightNormals& map, std::uint32_t row, std::uint32_t column) {
  const std::uint8_t* rgb = &map.texture.texels[(row * map.texture.width + column) * 3];
  const Eigen::Vector3d n(2.0 * rgb[0] / 255.0 - 1.0, 2.0 * rgb[1] / 255.0 - 1.0,
                          2.0 * rgb[2] / 255.0 - 1.0);
  return Eigen::Vector3d(n.x() * double{map.normal_scale}, n.y() * double{map.normal_scale}, n.z())
      .normalized();
}

TEST(HeightMap, NormalsOfARampTiltDownhill) {
  // Eight steps of 255 a column to the right: slope 8/255 inside; the border wraps and is steeper.
  const HeightNormals map = normals_from_heights(grey(16, 4, [](auto, auto c) { return 8 * c; }));
  const Eigen::Vector3d expected = Eigen::Vector3d(-8.0 / 255.0, 0.0, 1.0).normalized();
  for (std::uint32_t column = 1; column < 15; ++column) {
    EXPECT_LT((normal_at(map, 2, column) - expected).norm(), 4e-3) << column;
  }
}

TEST(HeightMap, RowsPointDownAndYUp) {
  const HeightNormals map = normals_from_heights(grey(4, 16, [](auto r, auto) { return 8 * r; }));
  const Eigen::Vector3d expected = Eigen::Vector3d(0.0, 8.0 / 255.0, 1.0).normalized();
  EXPECT_LT((normal_at(map, 8, 1) - expected).norm(), 4e-3);
}

TEST(HeightMap, TheSmallestSlopeSurvivesQuantizationTo8Bits) {
  // One step of 255 over two texels everywhere but at the crest: slope 0.5/255 each.
  const HeightNormals map =
      normals_from_heights(grey(64, 2, [](auto, auto c) { return c < 32 ? c / 2 : (63 - c) / 2; }));
  const double mean = (normal_at(map, 0, 10).x() + normal_at(map, 0, 11).x()) / 2.0;
  EXPECT_NEAR(mean, -0.5 / 255.0, 2e-5);
}

TEST(HeightMap, AFlatImageGivesFlatNormals) {
  const HeightNormals map = normals_from_heights(grey(3, 3, [](auto, auto) { return 77; }));
  EXPECT_TRUE(std::isfinite(map.normal_scale));
  EXPECT_GT(normal_at(map, 1, 1).z(), 0.9999);
}

TEST(HeightMap, NormalMapsAreDistinguishedFromHeightMaps) {
  Texture normal_map{"n", 1, 1, 3, {128, 128, 255}};
  EXPECT_TRUE(looks_like_normal_map(normal_map));
  const Texture white{"w", 1, 1, 3, {255, 255, 255}};
  EXPECT_FALSE(looks_like_normal_map(white));
  const Texture brown{"b", 1, 1, 3, {120, 90, 60}};
  EXPECT_FALSE(looks_like_normal_map(brown));
  EXPECT_FALSE(looks_like_normal_map(grey(2, 2, [](auto, auto) { return 200; })));
}

}  // namespace
}  // namespace glidar
