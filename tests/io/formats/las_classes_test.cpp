// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/las_classes.hpp>

#include <gmock/gmock.h>

namespace glidar {
namespace {

using ::testing::ElementsAre;

TEST(LasStandardClass, IsThatOfTheSpecification) {
  EXPECT_EQ(las_standard_class("unclassified"), 1);
  EXPECT_EQ(las_standard_class("ground"), 2);
  EXPECT_EQ(las_standard_class("low_vegetation"), 3);
  EXPECT_EQ(las_standard_class("medium_vegetation"), 4);
  EXPECT_EQ(las_standard_class("high_vegetation"), 5);
  EXPECT_EQ(las_standard_class("building"), 6);
  EXPECT_EQ(las_standard_class("low_noise"), 7);
  EXPECT_EQ(las_standard_class("water"), 9);
  EXPECT_EQ(las_standard_class("rail"), 10);
  EXPECT_EQ(las_standard_class("road_surface"), 11);
  EXPECT_EQ(las_standard_class("wire_guard"), 13);
  EXPECT_EQ(las_standard_class("wire_conductor"), 14);
  EXPECT_EQ(las_standard_class("transmission_tower"), 15);
  EXPECT_EQ(las_standard_class("wire_structure_connector"), 16);
  EXPECT_EQ(las_standard_class("bridge_deck"), 17);
  EXPECT_EQ(las_standard_class("high_noise"), 18);
  EXPECT_EQ(las_standard_class("overhead_structure"), 19);
  EXPECT_EQ(las_standard_class("ignored_ground"), 20);
  EXPECT_EQ(las_standard_class("snow"), 21);
}

TEST(LasStandardClass, IgnoresCaseAndSeparatorsOfWords) {
  for (const char* name : {"Road Surface", "road-surface", "ROAD_SURFACE"})
    EXPECT_EQ(las_standard_class(name), 11) << name;
  for (const char* name : {"", "car", "roads"}) EXPECT_EQ(las_standard_class(name), 0) << name;
}

TEST(LasClassCodes, OfOtherClassesAreUserDefinable) {
  const std::vector<std::string> names = {"unlabelled", "car", "tree", "person"};
  EXPECT_THAT(las_class_codes(names), ElementsAre(1, 64, 5, 66));
}

TEST(LasClassCodes, BeyondTheUserDefinableOnesAreUnclassified) {
  std::vector<std::string> names(200, "thing");
  names[199] = "water";
  const std::vector<std::uint8_t> codes = las_class_codes(names);
  EXPECT_EQ(codes[0], 1);
  EXPECT_EQ(codes[192], 255);
  EXPECT_EQ(codes[193], 1);
  EXPECT_EQ(codes[199], 9);
}

}  // namespace
}  // namespace glidar
