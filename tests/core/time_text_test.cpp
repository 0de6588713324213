// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/time_text.hpp>

#include <gtest/gtest.h>

#include <limits>

namespace glidar {
namespace {

TEST(TimeText, SecondsAreExactToTheNanosecondInEveryNotation) {
  constexpr std::int64_t kTime_ns = 1'403'636'580'838'555'648;
  for (const char* text : {"1403636580.838555648", "1.403636580838555648e+09",
                           "+1403636580838555648E-9", "0001403636580.8385556480"}) {
    EXPECT_EQ(parse_seconds_ns(text), kTime_ns) << text;
  }
  EXPECT_EQ(parse_seconds_ns("-0.000000001"), -1);
  EXPECT_EQ(parse_seconds_ns("7"), 7'000'000'000);
  EXPECT_EQ(parse_seconds_ns(".25"), 250'000'000);
  EXPECT_EQ(parse_seconds_ns("3."), 3'000'000'000);
  EXPECT_EQ(parse_seconds_ns("0.0000000015"), 2);
  EXPECT_EQ(parse_seconds_ns("0.00000000149"), 1);
  EXPECT_EQ(parse_seconds_ns("5e-10"), 1);
  EXPECT_EQ(parse_seconds_ns("4e-10"), 0);
  EXPECT_EQ(parse_seconds_ns("1e-300"), 0);
  EXPECT_EQ(parse_seconds_ns("-9200000000"), -9'200'000'000'000'000'000);
}

TEST(TimeText, OtherTextsAreNoSeconds) {
  for (const char* text :
       {"", ".", "-", "+-1", "1 ", " 1", "1,5", "0x10", "nan", "inf", "1e", "e5", "1e5.0", "1.2.3",
        "9200000001", "1e10", "1e300", "1403636580838555648"}) {
    EXPECT_EQ(parse_seconds_ns(text), std::nullopt) << text;
  }
}

TEST(TimeText, DatesAreInUtc) {
  EXPECT_EQ(parse_date_ns("1970-01-01T00:00:00Z"), 0);
  EXPECT_EQ(parse_date_ns("2026-01-01T00:00:00Z"), 1'767'225'600'000'000'000);
  EXPECT_EQ(parse_date_ns("2024-02-29T23:59:59.123456789Z"), 1'709'251'199'123'456'789);
  for (const char* text :
       {"", "2026-01-01", "2026-01-01T00:00:00", "2026-01-01 00:00:00Z", "2026-02-29T00:00:00Z",
        "2026-13-01T00:00:00Z", "2026-01-01T24:00:00Z", "2026-01-01T00:60:00Z",
        "2026-01-01T00:00:60Z", "2026-01-01T00:00:0Z", "2026-01-01T00:00:1e1Z",
        "1969-12-31T00:00:00Z", "2300-01-01T00:00:00Z", "+026-01-01T00:00:00Z"}) {
    EXPECT_EQ(parse_date_ns(text), std::nullopt) << text;
  }
}

TEST(TimeText, DecimalSecondsReadBack) {
  EXPECT_EQ(decimal_seconds(0), "0");
  EXPECT_EQ(decimal_seconds(-1), "-0.000000001");
  EXPECT_EQ(decimal_seconds(12'500'000'000), "12.5");
  EXPECT_EQ(decimal_seconds(std::numeric_limits<std::int64_t>::min()), "-9223372036.854775808");
  for (const std::int64_t t_ns : {1'700'000'000'123'456'789L, -1'000'000'007L, 100'000'000L}) {
    EXPECT_EQ(parse_seconds_ns(decimal_seconds(t_ns)), t_ns);
  }
}

}  // namespace
}  // namespace glidar
