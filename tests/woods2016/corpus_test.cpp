// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// The fuzzer's corpus of the Woods 2016 protocol, in every build.
#include "support/corpus.hpp"
#include "fuzz/woods2016_decoders.hpp"

#include <gmock/gmock.h>

namespace glidar {
namespace {

TEST(Woods2016Corpus, AcceptsValidMessagesOnly) {
  const auto [accepted, files] =
      testing::decode_corpus("woods2016", testing::try_woods2016_decoders);
  EXPECT_GT(files, 20U);
  EXPECT_THAT(accepted, ::testing::IsSupersetOf({"pose", "pose_turned", "cloud", "cloud_empty",
                                                 "shutdown_cloud", "shutdown_pose"}));
  for (const char* name :
       {"pose_short", "pose_long", "pose_nan", "pose_far", "pose_zero_quaternion",
        "pose_other_type", "cloud_short", "cloud_nan", "empty", "noise"}) {
    EXPECT_FALSE(accepted.contains(name)) << name;
  }
}

}  // namespace
}  // namespace glidar
