// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/osi/osi_trace.hpp>

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <string>

namespace glidar::osi {
namespace {

// The numbers are those of osi_object.proto; tests/python/osi_test.py compares them with the names
// in ASAM's own package.
TEST(MovingType, OfAVehicleHasItsKind) {
  EXPECT_EQ(moving_type("truck").type, 2U);
  EXPECT_EQ(moving_type("truck").vehicle_type, 7U);
  EXPECT_EQ(moving_type("vehicle").type, 2U);
  EXPECT_EQ(moving_type("vehicle").vehicle_type, 1U);
}

TEST(MovingType, IgnoresCaseAndSeparatorsOfWords) {
  for (const char* name : {"Small Car", "small-car", "SMALL_CAR"})
    EXPECT_EQ(moving_type(name).vehicle_type, 2U) << name;
  EXPECT_EQ(moving_type("Person").type, 3U);
}

TEST(MovingType, OfUnknownNamesIsOther) {
  for (const char* name : {"", "cart", "unlabelled"}) {
    EXPECT_EQ(moving_type(name).type, 1U) << name;
    EXPECT_EQ(moving_type(name).vehicle_type, 1U) << name;
  }
}

TEST(StationaryType, IgnoresCaseAndSeparatorsOfWords) {
  EXPECT_EQ(stationary_type("Building"), 3U);
  EXPECT_EQ(stationary_type("speed bump"), 17U);
  EXPECT_EQ(stationary_type("rock"), 1U);
}

/// The numbers of a message of three doubles with the fields 1, 2 and 3.
std::array<double, 3> numbers(const ProtobufMessage& message) {
  constexpr std::size_t kFieldBytes = 9;
  const std::string& bytes = message.bytes();
  EXPECT_EQ(bytes.size(), 3 * kFieldBytes);
  std::array<double, 3> found{};
  for (std::size_t k = 0; k < found.size(); ++k) {
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < 8; ++i)
      bits |= std::uint64_t{static_cast<unsigned char>(bytes.at(k * kFieldBytes + 1 + i))} << 8 * i;
    found[k] = std::bit_cast<double>(bits);
  }
  return found;
}

Eigen::Matrix3d rotation_of(const std::array<double, 3>& roll_pitch_yaw) {
  return (Eigen::AngleAxisd(roll_pitch_yaw[2], Eigen::Vector3d::UnitZ()) *
          Eigen::AngleAxisd(roll_pitch_yaw[1], Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(roll_pitch_yaw[0], Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

TEST(OsiValues, AnglesGiveTheRotationAgainAlsoStraightUpAndDown) {
  constexpr double kQuarter = std::numbers::pi / 2;
  for (const double pitch : {-kQuarter, -1.2, 0.0, 0.7, kQuarter}) {
    for (const double roll : {-3.0, -0.4, 0.0, 2.0}) {
      for (const double yaw : {-2.5, 0.0, 1.0, 3.1}) {
        const Eigen::Matrix3d rotation = rotation_of({roll, pitch, yaw});
        const auto found = numbers(orientation(rotation));
        EXPECT_LT((rotation_of(found) - rotation).norm(), 1e-12)
            << roll << ' ' << pitch << ' ' << yaw;
        EXPECT_LE(std::abs(found[1]), kQuarter + 1e-15);
      }
    }
  }
}

TEST(OsiValues, SphericalCoordinatesGiveThePointAgain) {
  for (const Eigen::Vector3d& point :
       {Eigen::Vector3d(3.0, 4.0, 1.0), Eigen::Vector3d(-1.0, -2.0, -7.0),
        Eigen::Vector3d(-5.0, 0.0, 0.0), Eigen::Vector3d(0.0, 0.0, 2.0)}) {
    const auto [distance, azimuth, elevation] = numbers(spherical(point));
    const Eigen::Vector3d again(distance * std::cos(elevation) * std::cos(azimuth),
                                distance * std::cos(elevation) * std::sin(azimuth),
                                distance * std::sin(elevation));
    EXPECT_LT((again - point).norm(), 1e-14 * (1.0 + point.norm()));
  }
}

TEST(OsiValues, TimesBeforeZeroHaveNanosecondsAboveZero) {
  const auto wanted = [](std::int64_t seconds, std::uint64_t nanos) {
    return ProtobufMessage().integer(1, seconds).integer(2, nanos).bytes();
  };
  EXPECT_EQ(timestamp(0).bytes(), wanted(0, 0));
  EXPECT_EQ(timestamp(1'500'000'001).bytes(), wanted(1, 500'000'001));
  EXPECT_EQ(timestamp(-1).bytes(), wanted(-1, 999'999'999));
  EXPECT_EQ(timestamp(-2'000'000'000).bytes(), wanted(-2, 0));
}

}  // namespace

}  // namespace glidar::osi

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
