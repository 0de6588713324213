// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/dds/topic_names.hpp>

#include <glidar/core/error.hpp>

#include <gtest/gtest.h>

namespace glidar::dds {
namespace {

TEST(TopicNames, RelativeNamesAreInTheNamespace) {
  EXPECT_EQ(full_topic_name("velodyne_points"), "/velodyne_points");
  EXPECT_EQ(full_topic_name("points", "robot"), "/robot/points");
  EXPECT_EQ(full_topic_name("points", "/fleet/robot"), "/fleet/robot/points");
  EXPECT_EQ(full_topic_name("points", "/robot/"), "/robot/points");
  EXPECT_EQ(full_topic_name("/tf", "robot"), "/tf");
}

TEST(TopicNames, HaveThePrefixOfRosInDds) {
  EXPECT_EQ(dds_topic_name("/robot/points"), "rt/robot/points");
}

TEST(TopicNames, RefusesNamesThatRosRefuses) {
  for (const char* name : {"", "/", "points/", "a//b", "1st", "/a/2nd", "a-b", "a b", "~/points",
                           "a__b", "caf\u00e9", "/a\n"}) {
    EXPECT_THROW(full_topic_name(name), Error) << name;
  }
  EXPECT_THROW(full_topic_name("points", "my robot"), Error);
  EXPECT_NO_THROW(full_topic_name("/" + std::string(246, 'a')));
  EXPECT_THROW(full_topic_name("/" + std::string(247, 'a')), Error);
}

}  // namespace
}  // namespace glidar::dds
