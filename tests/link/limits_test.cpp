// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/connection_guard.hpp>

#include "support/error_text.hpp"

#include <gmock/gmock.h>

#include <string>

namespace glidar::link {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string refusal(const std::string& text) {
  Limits limits;
  std::string error = error_text([&] { set_limit(limits, text); });
  EXPECT_EQ(limits, Limits{});
  return error;
}

TEST(Limits, EachIsSetByItsNameWithinItsRange) {
  for (const LimitKind& kind : limit_kinds()) {
    Limits limits;
    EXPECT_GE(limits.*kind.value, kind.min) << kind.name;
    EXPECT_LE(limits.*kind.value, kind.max) << kind.name;
    for (const std::int64_t value : {kind.min, kind.max}) {
      set_limit(limits, std::string(kind.name) + "=" + std::to_string(value));
      EXPECT_EQ(limits.*kind.value, value) << kind.name;
    }
    limits.*kind.value = Limits{}.*kind.value;
    EXPECT_EQ(limits, Limits{}) << kind.name;
    EXPECT_THAT(limit_text(limits, kind.value), HasSubstr(std::string(kind.name)));
  }
}

TEST(Limits, AnUnknownNameIsAnErrorWithTheClosestMatch) {
  EXPECT_THAT(refusal("reply-mb=4"), AllOf(HasSubstr("--limit"), HasSubstr("'reply-mb=4'"),
                                           HasSubstr("did you mean reply-mib?")));
  EXPECT_THAT(refusal(""), HasSubstr("connections, connections-per-s"));
}

TEST(Limits, AnInvalidValueIsAnErrorWithRangeAndExample) {
  for (const char* value : {"=0", "=-1", "=1.5", "=many", "=", "", "=1000001", "=4 "}) {
    EXPECT_THAT(refusal("requests" + std::string(value)),
                AllOf(HasSubstr("--limit requests"), HasSubstr("from 1 to 1000000"),
                      HasSubstr("for example --limit requests=16")))
        << value;
  }
}

}  // namespace
}  // namespace glidar::link
