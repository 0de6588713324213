// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/fisher_output.hpp>
#include <glidar/core/error.hpp>

#include <gtest/gtest.h>

namespace glidar::app {
namespace {

TEST(FisherOptions, FileIsBesideTheOutput) {
  EXPECT_EQ(fisher_path("x/cloud.v2.pcd"), "x/cloud.v2.fisher.json");
  EXPECT_EQ(fisher_path("view.depth.png"), "view.fisher.json");
}

TEST(FisherOptions, EveryFrameHasAFileAlsoInASharedFolder) {
  EXPECT_EQ(fisher_path("x/out.kitti"), "x/out.fisher.json");
  EXPECT_EQ(fisher_path("x/out.kitti", 3), "x/out_000003.fisher.json");
  EXPECT_EQ(fisher_path("x/cloud_000003.pcd", 3), "x/cloud_000003.fisher.json");
}

TEST(FisherOptions, NeedAnOutputFile) {
  RenderFlags flags;
  flags.fisher.is_requested = true;
  flags.output.format = "pcd";
  flags.output.paths = {"-"};
  EXPECT_THROW(check_fisher(flags), Error);
  flags.output.paths = {"-", "a.pcd"};
  EXPECT_NO_THROW(check_fisher(flags));
}

}  // namespace
}  // namespace glidar::app
