// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/advice.hpp>

#include <gtest/gtest.h>

namespace glidar::app {
namespace {

const char* const kPly = "Stanford Polygon Library (PLY)";

Eigen::AlignedBox3d box(const Eigen::Vector3d& least, const Eigen::Vector3d& most) {
  return {least, most};
}

TEST(UpAdvice, GltfIsYUpByItsDefinition) {
  const std::string advice = up_advice("glTF2", box({-1, -1, -1}, {1, 1, 1}));
  EXPECT_NE(advice.find("--up y"), std::string::npos);
  EXPECT_EQ(advice.find("guess"), std::string::npos);
}

TEST(UpAdvice, GuessesYForWhatStandsOnOrAboveZeroAlongYAlone) {
  const Eigen::AlignedBox3d bunny = box({-0.095, 0.033, -0.062}, {0.061, 0.187, 0.059});
  for (const char* format : {kPly, "Stereolithography (STL)", "Wavefront Object", "OFF"}) {
    EXPECT_NE(up_advice(format, bunny).find("a guess"), std::string::npos) << format;
  }
  EXPECT_NE(up_advice(kPly, box({-1, -0.01, -1}, {1, 2, 1})), "");
}

TEST(UpAdvice, SaysNothingWhereNothingPointsToY) {
  EXPECT_EQ(up_advice(kPly, box({-1, -1, 0}, {1, 1, 2})), "");   // stands on z
  EXPECT_EQ(up_advice(kPly, box({-1, -1, -1}, {1, 1, 1})), "");  // around zero
  EXPECT_EQ(up_advice(kPly, box({0, 0, 0}, {1, 1, 1})), "");     // in a corner
  EXPECT_EQ(up_advice(kPly, box({-1, 0, -1}, {1, 0, 1})), "");   // flat
  EXPECT_EQ(up_advice(kPly, Eigen::AlignedBox3d()), "");
  EXPECT_EQ(up_advice("built-in", box({-1, 0, -1}, {1, 2, 1})), "");  // up is +z
  EXPECT_EQ(up_advice("Collada", box({-1, 0, -1}, {1, 2, 1})), "");   // the file says
}

}  // namespace
}  // namespace glidar::app
