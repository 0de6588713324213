// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/osi/osi_trace.hpp>

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

namespace glidar {
namespace {

using std::string_literals::operator""s;

TEST(ProtobufMessage, HasTheBytesOfTheExamplesOfTheSpecification) {
  // protobuf.dev, "Encoding": a = 150; b = "testing"; c = a message with the first one
  const ProtobufMessage a = ProtobufMessage().integer(1, std::uint64_t{150});
  EXPECT_EQ(a.bytes(), "\x08\x96\x01"s);
  EXPECT_EQ(ProtobufMessage().text(2, "testing").bytes(), "\x12\x07testing"s);
  EXPECT_EQ(ProtobufMessage().message(3, a).bytes(), "\x1a\x03\x08\x96\x01"s);
}

TEST(ProtobufMessage, StoresIntegersWithTheirSignAndLargeFieldNumbers) {
  EXPECT_EQ(ProtobufMessage().integer(1, std::int64_t{-2}).bytes(),
            "\x08\xfe\xff\xff\xff\xff\xff\xff\xff\xff\x01"s);
  EXPECT_EQ(ProtobufMessage().integer(26, std::uint64_t{0}).bytes(), "\xd0\x01\x00"s);
  EXPECT_EQ(ProtobufMessage().real(3, 1.0).bytes(), "\x19\x00\x00\x00\x00\x00\x00\xf0\x3f"s);
}

TEST(ProtobufMessage, ReplacesBytesThatAreNotUtf8) {
  EXPECT_EQ(ProtobufMessage().text(1, "a\xff\xc3\xa4\xe2\x82").bytes(),
            "\x0a\x06"
            "a?\xc3\xa4??"s);
}

}  // namespace
}  // namespace glidar
