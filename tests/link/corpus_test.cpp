// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// The messages that the fuzzer keeps, in every build.
#include "fuzz/legacy_decoders.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>

namespace glidar::legacy {
namespace {

TEST(LegacyCorpus, IsTakenWhereItIsAMessageAndRefusedElsewhere) {
  std::set<std::string> taken;
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(
           std::filesystem::path(GLIDAR_SOURCE_FOLDER) / "tests/fuzz/corpus/legacy")) {
    std::ifstream file(entry.path(), std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(file)), {});
    ++files;
    if (testing::try_legacy_decoders(std::as_bytes(std::span(bytes)))) {
      taken.insert(entry.path().filename().string());
    }
  }
  EXPECT_GT(files, 20U);
  EXPECT_THAT(taken, ::testing::IsSupersetOf({"pose", "pose_turned", "cloud", "cloud_empty",
                                              "shutdown_cloud", "shutdown_pose"}));
  for (const char* name :
       {"pose_short", "pose_long", "pose_nan", "pose_far", "pose_zero_quaternion",
        "pose_other_type", "cloud_short", "cloud_nan", "empty", "noise"}) {
    EXPECT_FALSE(taken.contains(name)) << name;
  }
}

}  // namespace
}  // namespace glidar::legacy
