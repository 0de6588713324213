// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/box_classes.hpp>

#include <glidar/core/error.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace glidar {
namespace {

TEST(BoxedClasses, SurfacesAreNotCountableInAnySpelling) {
  for (const char* name : {"road", "Roads", "building", "BUILDING", "house", "terrain",
                           "road-surface", "Guard Rail", "vegetation", "buildings"})
    EXPECT_FALSE(is_countable(name)) << name;
  for (const char* name : {"car", "pedestrian", "Cyclist", "truck", "bus", "asteroid", "", "s"})
    EXPECT_TRUE(is_countable(name)) << name;
}

TEST(BoxedClasses, NamesReplaceTheCountableOnes) {
  const std::vector<std::string> known = {"unlabelled", "car", "road", "house"};
  EXPECT_EQ(boxed_classes(known), (BoxedClasses{false, true, false, false}));
  const auto of = [&](std::vector<std::string> names) { return boxed_classes(known, names); };
  EXPECT_EQ(of({"house"}), (BoxedClasses{false, false, false, true}));
  EXPECT_EQ(of({"all"}), (BoxedClasses{false, true, true, true}));
}

TEST(BoxedClasses, AnUnknownNameIsRefusedWithTheNearestOne) {
  const std::vector<std::string> known = {"unlabelled", "car", "house"};
  try {
    boxed_classes(known, std::vector<std::string>{"hause"}, "--box-classes");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.parts().where, "--box-classes");
    EXPECT_EQ(error.parts().allowed, "all, car, house");
    EXPECT_THAT(error.parts().remedy, ::testing::HasSubstr("'house'"));
  }
  EXPECT_THROW(boxed_classes(known, std::vector<std::string>{"unlabelled"}), Error);
}

}  // namespace
}  // namespace glidar
