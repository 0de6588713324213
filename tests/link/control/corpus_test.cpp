// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// The fuzzer's corpus of the interfaces for drivers, in every build.
#include "support/corpus.hpp"
#include "fuzz/control_decoders.hpp"

#include <gmock/gmock.h>

namespace glidar::control {
namespace {

TEST(ControlCorpus, AcceptsValidRequestsAndPacketsOnly) {
  const auto [accepted, files] = testing::decode_corpus("control", testing::try_control_decoders);
  EXPECT_EQ(files, 16U);
  EXPECT_THAT(accepted, ::testing::ElementsAre("http_config", "http_metadata", "livox_configure",
                                               "livox_packet", "livox_query", "livox_search",
                                               "ptc_calibration", "ptc_destination"));
}

}  // namespace
}  // namespace glidar::control
