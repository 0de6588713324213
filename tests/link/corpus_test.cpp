// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// The fuzzer's corpus of the lock-step protocol, in every build.
#include "support/corpus.hpp"
#include "fuzz/lockstep_decoders.hpp"

#include <gmock/gmock.h>

namespace glidar::link {
namespace {

TEST(LockstepCorpus, AcceptsValidRequestsOnly) {
  const auto [accepted, files] = testing::decode_corpus("lockstep", testing::try_lockstep_decoders);
  EXPECT_EQ(files, 14U);
  EXPECT_THAT(accepted, ::testing::ElementsAre("batch", "describe", "measure", "no_objects"));
}

}  // namespace
}  // namespace glidar::link
