// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// The fuzzer's corpus of the live view, in every build.
#include "support/corpus.hpp"
#include "fuzz/foxglove_decoders.hpp"

#include <gmock/gmock.h>

namespace glidar::foxglove {
namespace {

TEST(FoxgloveCorpus, AcceptsValidMessagesOnly) {
  const auto [accepted, files] = testing::decode_corpus("foxglove", testing::try_foxglove_decoders);
  EXPECT_EQ(files, 10U);
  EXPECT_THAT(accepted, ::testing::ElementsAre("parameters", "subscribe", "unsubscribe"));
}

}  // namespace
}  // namespace glidar::foxglove
