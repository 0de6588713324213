// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/instruction_set.hpp>

#include <support/error_text.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace glidar {
namespace {

TEST(InstructionSet, EveryUsableOneIsFoundByItsName) {
  const auto usable = usable_instruction_sets();
  ASSERT_FALSE(usable.empty());
  EXPECT_EQ(usable.front(), InstructionSet::baseline);
  for (const InstructionSet set : usable) EXPECT_EQ(find_instruction_set(to_string(set)), set);
}

TEST(InstructionSet, TheFastestIsFoundWithoutAName) {
  EXPECT_EQ(find_instruction_set(""), usable_instruction_sets().back());
}

TEST(InstructionSet, AnUnknownNameIsAnErrorThatListsTheUsableOnes) {
  EXPECT_THAT(error_text([] { (void)find_instruction_set("sse9"); }),
              ::testing::HasSubstr("no kernel 'sse9'; allowed: baseline"));
}

}  // namespace
}  // namespace glidar
