// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/advice.hpp>

#include <gtest/gtest.h>

#include <limits>

namespace glidar::app {
namespace {

const char* const kPly = "Stanford Polygon Library (PLY)";

Eigen::AlignedBox3d box(const Eigen::Vector3d& least, const Eigen::Vector3d& most) {
  return {least, most};
}

TEST(UpAdvice, IsEmptyForFormatsThatDeclareTheirUpAxis) {
  for (const char* format : {"glTF2", "Collada", "Autodesk FBX", "3mf"}) {
    EXPECT_EQ(up_advice(format, box({-1, 0, -1}, {1, 2, 1})), "") << format;
  }
}

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Scene square_of(double side_m, bool unit_known) {
  Scene scene;
  Mesh mesh;
  const auto half = static_cast<float>(0.5 * side_m);
  mesh.positions_m = {{-half, -half, 0.0F}, {half, -half, 0.0F}, {half, half, 0.0F}};
  mesh.triangles = {{0, 1, 2}};
  scene.meshes.push_back(mesh);
  scene.sources.push_back({.path = "a", .hash = "", .unit_known = unit_known});
  scene.materials.emplace_back();
  scene.instances.push_back({.name = "a", .materials = {0}});
  return scene;
}

TEST(SizeAdvice, IsNotGivenForSitesThatASensorReachesNorForTerrain) {
  Scene scene = square_of(1500.0, false);
  EXPECT_EQ(size_advice(scene, false, 100.0).size(), 1U);
  EXPECT_TRUE(size_advice(scene, false, 300.0).empty());
  scene.meshes.front().triangles.resize(1000, {0, 1, 2});
  EXPECT_TRUE(size_advice(scene, false, kInfinity).empty());
  scene.meshes.front().triangles.resize(2000, {0, 2, 1});  // a plate
  EXPECT_EQ(size_advice(scene, false, kInfinity).size(), 1U);
}

TEST(SizeAdvice, IsGivenForAssumedUnitsOnly) {
  EXPECT_EQ(size_advice(square_of(5000.0, false), false, kInfinity).size(), 1U);
  EXPECT_TRUE(size_advice(square_of(5000.0, false), true, kInfinity).empty());
  EXPECT_TRUE(size_advice(square_of(5000.0, true), false, kInfinity).empty());
  EXPECT_EQ(size_advice(square_of(1e-4, false), false, kInfinity).size(), 1U);
  EXPECT_TRUE(size_advice(square_of(1e-4, true), false, kInfinity).empty());
}

TEST(UpAdvice, SuggestsYForModelsOnOrAboveZeroAlongYOnly) {
  const Eigen::AlignedBox3d bunny = box({-0.095, 0.033, -0.062}, {0.061, 0.187, 0.059});
  for (const char* format : {kPly, "Stereolithography (STL)", "Wavefront Object", "OFF"}) {
    EXPECT_NE(up_advice(format, bunny).find("a guess"), std::string::npos) << format;
  }
  EXPECT_NE(up_advice(kPly, box({-1, -0.01, -1}, {1, 2, 1})), "");
}

TEST(UpAdvice, IsEmptyWithoutASignOfY) {
  EXPECT_EQ(up_advice(kPly, box({-1, -1, 0}, {1, 1, 2})), "");   // on the plane z = 0
  EXPECT_EQ(up_advice(kPly, box({-1, -1, -1}, {1, 1, 1})), "");  // around zero
  EXPECT_EQ(up_advice(kPly, box({0, 0, 0}, {1, 1, 1})), "");     // in a corner
  EXPECT_EQ(up_advice(kPly, box({-1, 0, -1}, {1, 0, 1})), "");   // flat
  EXPECT_EQ(up_advice(kPly, Eigen::AlignedBox3d()), "");
  EXPECT_EQ(up_advice("built-in", box({-1, 0, -1}, {1, 2, 1})), "");  // up is +z
  EXPECT_EQ(up_advice("Collada", box({-1, 0, -1}, {1, 2, 1})), "");   // declared by the file
}

}  // namespace
}  // namespace glidar::app
