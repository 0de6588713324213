// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// The messages that the fuzzer keeps, in every build.
#include "fuzz/legacy_decoders.hpp"
#include "fuzz/lockstep_decoders.hpp"

#include <support/source_folder.hpp>

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>

namespace glidar::link {
namespace {

/// What a decoder makes of the messages of a folder.
struct Tried {
  std::set<std::string> taken;  ///< files that are messages
  std::size_t files = 0;
};

Tried tried(const char* protocol, bool (*decode)(std::span<const std::byte>)) {
  Tried result;
  for (const auto& entry : std::filesystem::directory_iterator(
           std::filesystem::path(kSourceFolder) / "tests/fuzz/corpus" / protocol)) {
    std::ifstream file(entry.path(), std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(file)), {});
    ++result.files;
    if (decode(std::as_bytes(std::span(bytes)))) {
      result.taken.insert(entry.path().filename().string());
    }
  }
  return result;
}

TEST(LegacyCorpus, IsTakenWhereItIsAMessageAndRefusedElsewhere) {
  const auto [taken, files] = tried("legacy", testing::try_legacy_decoders);
  EXPECT_GT(files, 20U);
  EXPECT_THAT(taken, ::testing::IsSupersetOf({"pose", "pose_turned", "cloud", "cloud_empty",
                                              "shutdown_cloud", "shutdown_pose"}));
  for (const char* name :
       {"pose_short", "pose_long", "pose_nan", "pose_far", "pose_zero_quaternion",
        "pose_other_type", "cloud_short", "cloud_nan", "empty", "noise"}) {
    EXPECT_FALSE(taken.contains(name)) << name;
  }
}

TEST(LockstepCorpus, IsTakenWhereItIsARequestAndRefusedElsewhere) {
  const auto [taken, files] = tried("lockstep", testing::try_lockstep_decoders);
  EXPECT_EQ(files, 14U);
  EXPECT_THAT(taken, ::testing::ElementsAre("batch", "describe", "measure", "no_objects"));
}

}  // namespace
}  // namespace glidar::link
