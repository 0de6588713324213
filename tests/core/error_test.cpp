// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/error.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace glidar {
namespace {

TEST(Error, SaysWhereWhatAllowedAndWhatToDo) {
  const Error error({.where = "camera.yaml:3:8: width",
                     .found = "-5",
                     .allowed = "1 to 65536",
                     .remedy = "give a size in pixels"});
  EXPECT_STREQ(error.what(),
               "camera.yaml:3:8: width: -5; allowed: 1 to 65536; give a size in pixels");
  EXPECT_EQ(error.parts().found, "-5");
}

TEST(Error, LeavesOutWhatIsEmpty) {
  EXPECT_STREQ(Error({.where = "", .found = "broken", .allowed = "", .remedy = ""}).what(),
               "broken");
}

TEST(NumberText, IsTheShortestThatReadsBackTheSame) {
  EXPECT_EQ(number_text(0.1), "0.1");
  EXPECT_EQ(number_text(1e300), "1e+300");
  EXPECT_EQ(number_text(-2.0), "-2");
  EXPECT_EQ(number_text(std::nan("")), "nan");
  EXPECT_EQ(number_text(-2.2250738585072014e-308), "-2.2250738585072014e-308");
}

TEST(NearestWord, FindsTheTypo) {
  const std::vector<std::string> known = {"width", "height", "fov_deg"};
  EXPECT_EQ(nearest_word("widht", known), "width");
  EXPECT_EQ(nearest_word("fov_dge", known), "fov_deg");
}

TEST(NearestWord, SaysNothingWhenNothingIsNear) {
  const std::vector<std::string> known = {"width", "height"};
  EXPECT_EQ(nearest_word("temperature", known), "");
  EXPECT_EQ(nearest_word("x", std::vector<std::string>{}), "");
}

}  // namespace
}  // namespace glidar
