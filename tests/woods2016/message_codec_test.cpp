// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/math/constants.hpp>
#include <glidar/woods2016/protocol.hpp>

#include "link/message_bytes.hpp"
#include "support/error_text.hpp"

#include <gmock/gmock.h>

#include <cmath>

namespace glidar::woods2016 {
namespace {

using ::testing::HasSubstr;
using testing::MessageBytes;

MessageBytes placement_bytes(std::array<double, 11> numbers) {
  MessageBytes message;
  message.text("v").raw({7, 0, 0, 0, 0, 0, 0, 0x80});
  for (const double number : numbers) message.number(number);
  return message;
}

constexpr std::array<double, 11> kNumbers = {0.6,  0.0, 0.8, 0.0, 1.0, -2.0,
                                             30.0, 1.0, 0.0, 0.0, 0.0};

TEST(PlacementMessage, IsReadFromBytesWrittenByHand) {
  const MessageBytes message = placement_bytes(kNumbers);
  ASSERT_EQ(message.bytes.size(), 97U);
  const Placement placement = decode_placement(message.bytes);
  EXPECT_EQ(placement.timestamp, 0x8000000000000007U);
  EXPECT_DOUBLE_EQ(placement.object.w(), 0.6);
  EXPECT_DOUBLE_EQ(placement.object.y(), 0.8);
  EXPECT_EQ(placement.translation_m, Eigen::Vector3d(1.0, -2.0, 30.0));
  EXPECT_EQ(placement.sensor.w(), 1.0);
}

TEST(PlacementMessage, WritesTheBytesItReads) {
  const MessageBytes message = placement_bytes(kNumbers);
  const auto written = encode_placement(decode_placement(message.bytes));
  EXPECT_TRUE(
      std::equal(written.begin(), written.end(), message.bytes.begin(), message.bytes.end()));
}

TEST(PlacementMessage, WrongSizeIsAnErrorWithBothSizes) {
  MessageBytes message = placement_bytes(kNumbers);
  message.bytes.pop_back();
  EXPECT_THAT(error_text([&] { decode_placement(message.bytes); }),
              ::testing::AllOf(HasSubstr("96 bytes"), HasSubstr("97")));
  message.bytes.resize(98);
  EXPECT_THAT(error_text([&] { decode_placement(message.bytes); }), HasSubstr("98 bytes"));
  message.bytes.resize(std::size_t{1} << 24U);
  EXPECT_THAT(error_text([&] { decode_placement(message.bytes); }), HasSubstr("16777216 bytes"));
  for (std::size_t size = 1; size < 97; ++size) {
    message.bytes.resize(size);
    EXPECT_THROW(decode_placement(message.bytes), Error) << size;
  }
  EXPECT_THAT(error_text([] { decode_placement({}); }), HasSubstr("it is empty"));
}

TEST(PlacementMessage, WrongTypeIsAnErrorWithTheFirstByte) {
  MessageBytes message = placement_bytes(kNumbers);
  message.bytes[0] = std::byte{'c'};
  EXPECT_THAT(error_text([&] { decode_placement(message.bytes); }), HasSubstr("'c'; allowed: 'v'"));
  message.bytes[0] = std::byte{0x07};
  EXPECT_THAT(error_text([&] { decode_placement(message.bytes); }), HasSubstr("0x07"));
}

TEST(PlacementMessage, NumbersThatAreNotFiniteAreErrorsWithTheirName) {
  const std::array<const char*, 11> names = {
      "object w",      "object x", "object y", "object z", "translation x", "translation y",
      "translation z", "sensor w", "sensor x", "sensor y", "sensor z"};
  for (std::size_t i = 0; i < names.size(); ++i) {
    for (const double bad : {kNaN, HUGE_VAL, -HUGE_VAL}) {
      auto numbers = kNumbers;
      numbers.at(i) = bad;
      EXPECT_THAT(error_text([&] { decode_placement(placement_bytes(numbers).bytes); }),
                  HasSubstr(names.at(i)));
    }
  }
}

TEST(PlacementMessage, PositionsTooFarAwayAreErrors) {
  auto numbers = kNumbers;
  numbers[5] = -1e15;
  EXPECT_NO_THROW(decode_placement(placement_bytes(numbers).bytes));
  numbers[5] = -1.1e15;
  EXPECT_THAT(error_text([&] { decode_placement(placement_bytes(numbers).bytes); }),
              HasSubstr("translation y is -1.1e+15"));
}

TEST(PlacementMessage, QuaternionsOfWrongLengthAreErrors) {
  for (const double length : {0.0, 0.998, 1.002, 2.0, 1e-300, 1e300}) {
    auto numbers = kNumbers;
    numbers[7] = length;
    EXPECT_THAT(error_text([&] { decode_placement(placement_bytes(numbers).bytes); }),
                HasSubstr("the sensor's quaternion has the length"))
        << length;
  }
}

TEST(PlacementMessage, SinglePrecisionQuaternionsAreNormalised) {
  auto numbers = kNumbers;
  numbers[0] = 0.6F;
  numbers[2] = 0.8F;
  EXPECT_NEAR(decode_placement(placement_bytes(numbers).bytes).object.norm(), 1.0, 1e-15);
}

PointCloud cloud_of(std::vector<double> xyz, std::vector<float> intensity) {
  const auto points = static_cast<std::uint32_t>(intensity.size());
  PointCloud cloud{1, points, "legacy", Pose::Identity(), {}};
  cloud.columns.push_back({"xyz", {"x", "y", "z"}, std::move(xyz)});
  cloud.columns.push_back({"intensity", {"intensity"}, std::move(intensity)});
  return cloud;
}

std::vector<std::byte> encoded(const PointCloud& cloud, std::uint64_t timestamp) {
  std::vector<std::byte> bytes(cloud_bytes(cloud.size()));
  bytes.resize(encode_cloud(cloud, timestamp, bytes));
  return bytes;
}

TEST(CloudMessage, HasTheDocumentedBytesWithoutMisses) {
  const PointCloud cloud =
      cloud_of({1.0, 2.0, -0.5, kNaN, kNaN, kNaN, 0.25, 0.0, 8.0}, {0.5F, 0.0F, 1.0F});
  const MessageBytes expected = MessageBytes()
                                    .text("c")
                                    .raw({5, 1, 0, 0, 0, 0, 0, 0})
                                    .raw({0, 0, 0x80, 0x3f, 0, 0, 0, 0x40, 0, 0, 0, 0xbf})
                                    .raw({0, 0, 0, 0x3f})
                                    .raw({0, 0, 0x80, 0x3e, 0, 0, 0, 0, 0, 0, 0, 0x41})
                                    .raw({0, 0, 0x80, 0x3f});
  EXPECT_EQ(encoded(cloud, 261), expected.bytes);
}

TEST(CloudMessage, WithoutHitsIsTheHeaderOnly) {
  const PointCloud cloud = cloud_of({kNaN, kNaN, kNaN}, {0.0F});
  EXPECT_EQ(encoded(cloud, 0).size(), 9U);
  EXPECT_TRUE(decode_cloud(encoded(cloud, 0)).points.empty());
}

TEST(CloudMessage, RoundTripsLosslessly) {
  const Cloud cloud = decode_cloud(encoded(cloud_of({1.0, 2.0, 3.0}, {0.5F}), ~std::uint64_t{0}));
  EXPECT_EQ(cloud.timestamp, ~std::uint64_t{0});
  ASSERT_EQ(cloud.points.size(), 1U);
  EXPECT_EQ(cloud.points[0].z_m, 3.0F);
  EXPECT_EQ(cloud.points[0].intensity, 0.5F);
}

TEST(CloudMessage, IncompletePointsAreErrors) {
  std::vector<std::byte> bytes = encoded(cloud_of({1.0, 2.0, 3.0}, {0.5F}), 1);
  bytes.pop_back();
  EXPECT_THAT(error_text([&] { decode_cloud(bytes); }), HasSubstr("24 bytes"));
  EXPECT_THAT(error_text([&] { decode_cloud(std::span(bytes).first(8)); }), HasSubstr("8 bytes"));
  EXPECT_THAT(error_text([] { decode_cloud({}); }), HasSubstr("it is empty"));
  const auto nan = MessageBytes().text("c").number(std::uint64_t{1}).number(1.0F).number(kNaNf);
  MessageBytes with_nan = nan;
  with_nan.number(0.0F).number(0.0F);
  EXPECT_THAT(error_text([&] { decode_cloud(with_nan.bytes); }), HasSubstr("point 0"));
}

TEST(CloudMessage, RequiresItsColumnsAndABufferOfItsSize) {
  PointCloud cloud = cloud_of({1.0, 2.0, 3.0}, {0.5F});
  std::vector<std::byte> small(cloud_bytes(1) - 1);
  EXPECT_THAT(error_text([&] { encode_cloud(cloud, 1, small); }), HasSubstr("24 bytes"));
  cloud.columns.pop_back();
  EXPECT_THAT(error_text([&] { encoded(cloud, 1); }), HasSubstr("no column intensity"));
}

TEST(ShutdownMessage, HasEightBytesForAnyTopic) {
  const auto bytes = encode_shutdown("c");
  EXPECT_EQ(MessageBytes().text("cKTHXBAI").bytes, std::vector(bytes.begin(), bytes.end()));
  EXPECT_TRUE(is_shutdown(MessageBytes().text("vKTHXBAI").bytes));
  EXPECT_FALSE(is_shutdown(MessageBytes().text("vKTHXBAI!").bytes));
  EXPECT_FALSE(is_shutdown(MessageBytes().text("vKTHXBA").bytes));
  EXPECT_FALSE(is_shutdown({}));
}

}  // namespace
}  // namespace glidar::woods2016
