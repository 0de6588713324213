// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/error.hpp>
#include <glidar/link/lockstep.hpp>
#include <glidar/math/constants.hpp>
#include <support/error_text.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <limits>

namespace glidar::lockstep {
namespace {

using ::testing::HasSubstr;

/// Bytes put together by hand, from the tables of docs/link/lockstep.md.
class Hand {
 public:
  template <class Number>
  Hand& put(Number number) {
    std::array<std::byte, sizeof(Number)> raw{};
    std::memcpy(raw.data(), &number, sizeof(Number));
    bytes.insert(bytes.end(), raw.begin(), raw.end());
    return *this;
  }
  Hand& letters(const char* text, std::size_t size) {
    for (std::size_t i = 0; i < size; ++i) put(i < std::strlen(text) ? text[i] : '\0');
    return *this;
  }
  Hand& body(double x, double qw, double rate_z, double velocity_y) {
    for (const double number :
         {x, 0.0, 0.0, qw, 0.0, 0.0, 0.0, 0.0, 0.0, rate_z, 0.0, velocity_y, 0.0}) {
      put(number);
    }
    return *this;
  }
  std::vector<std::byte> bytes;
};

Hand measure_start(std::uint32_t columns, std::uint32_t moments, std::uint32_t objects) {
  Hand hand;
  hand.letters("GLDR", 4).put(std::uint16_t{1}).put(std::uint16_t{1}).put(std::uint64_t{77});
  for (const std::uint32_t number : {0U, 1U, columns, moments, objects, 0U}) hand.put(number);
  return hand;
}

/// Two columns, one moment, one object.
Hand good() {
  Hand hand = measure_start(2, 1, 1);
  hand.letters("xyz", 24).letters("intensity", 24);
  hand.put(std::int64_t{-5}).put(std::uint64_t{9}).put(std::uint32_t{3}).put(std::uint32_t{0});
  hand.body(2.0, 1.0, 0.0, 0.0).body(4.0, 1.0, 0.25, -3.0);
  return hand;
}

std::string error_of(const std::vector<std::byte>& bytes) {
  std::uint64_t id = 0;
  return error_text([&] { decode_request(bytes, id); });
}

/// The good request with other bytes at a place.
template <class Number>
std::string error_with(std::size_t at, Number number) {
  Hand hand = good();
  std::memcpy(hand.bytes.data() + at, &number, sizeof(Number));
  return error_of(hand.bytes);
}

constexpr std::size_t kMoment = 40 + 2 * 24;
constexpr std::size_t kSensor = kMoment + 24;
constexpr std::size_t kObject = kSensor + 104;

TEST(DecodeRequest, ReadsEveryFieldOfBytesWrittenByHand) {
  std::uint64_t id = 0;
  const Request request = decode_request(good().bytes, id);
  EXPECT_EQ(id, 77U);
  const auto& measure = std::get<Measure>(request);
  EXPECT_EQ(measure.id, 77U);
  EXPECT_TRUE(measure.drop_invalid);
  EXPECT_THAT(measure.columns, ::testing::ElementsAre("xyz", "intensity"));
  ASSERT_EQ(measure.moments.size(), 1U);
  const Moment& moment = measure.moments[0];
  EXPECT_EQ(moment.t_ns, -5);
  EXPECT_EQ(moment.seed, 9U);
  EXPECT_EQ(moment.number, 3U);
  EXPECT_EQ(moment.sensor.world_from_body.translation().x(), 2.0);
  ASSERT_EQ(moment.objects.size(), 1U);
  EXPECT_EQ(moment.objects[0].world_from_body.translation().x(), 4.0);
  EXPECT_EQ(moment.objects[0].rate_rad_s, Eigen::Vector3d(0.0, 0.0, 0.25));
  EXPECT_EQ(moment.objects[0].velocity_m_s, Eigen::Vector3d(0.0, -3.0, 0.0));
}

TEST(Encode, WritesTheSameBytesAsByHand) {
  std::uint64_t id = 0;
  EXPECT_EQ(encode(decode_request(good().bytes, id)), good().bytes);
  Hand describe;
  describe.letters("GLDR", 4).put(std::uint16_t{1}).put(std::uint16_t{0}).put(std::uint64_t{5});
  EXPECT_EQ(encode(Describe{5}), describe.bytes);
  EXPECT_EQ(std::get<Describe>(decode_request(describe.bytes, id)).id, 5U);
}

TEST(DecodeRequest, RejectsAnyWrongLength) {
  const std::vector<std::byte> whole = good().bytes;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_THAT(error_of({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)}),
                HasSubstr("size"))
        << size;
  }
  std::vector<std::byte> longer = whole;
  longer.push_back(std::byte{0});
  EXPECT_THAT(error_of(longer), HasSubstr("size"));
}

TEST(DecodeRequest, ReadsTheIdOfInvalidRequests) {
  Hand hand = good();
  hand.bytes.pop_back();
  std::uint64_t id = 0;
  EXPECT_THROW(decode_request(hand.bytes, id), Error);
  EXPECT_EQ(id, 77U);
}

TEST(DecodeRequest, ReportsTheInvalidField) {
  EXPECT_THAT(error_with(0, 'X'), HasSubstr("GLDR"));
  EXPECT_THAT(error_with(4, std::uint16_t{2}), HasSubstr("version: 2; allowed: 1"));
  EXPECT_THAT(error_with(6, std::uint16_t{9}), HasSubstr("kind: 9"));
  EXPECT_THAT(error_with(20, 2U), HasSubstr("flags: 2"));
  EXPECT_THAT(error_with(24, 0U), HasSubstr("number of columns: 0; allowed: 1 to 64"));
  EXPECT_THAT(error_with(24, 0xffffffffU), HasSubstr("number of columns"));
  EXPECT_THAT(error_with(28, 0xffffffffU), HasSubstr("number of moments"));
  EXPECT_THAT(error_with(32, 0xffffffffU), HasSubstr("number of objects"));
  EXPECT_THAT(error_with(32, 1'000'000U), HasSubstr("size"));
  EXPECT_THAT(error_with(36, 1U), HasSubstr("reserved"));
  EXPECT_THAT(error_with(40, 'A'), HasSubstr("name of a column"));
  EXPECT_THAT(error_with(40, '\0'), HasSubstr("name of a column"));
  EXPECT_THAT(error_with(kMoment + 20, 1U), HasSubstr("moment 0, reserved"));
}

TEST(DecodeRequest, RejectsNumbersThatAreNotFinite) {
  const double nan = kNaN;
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, infinity, -infinity, 1e300}) {
    EXPECT_THAT(error_with(kSensor, bad), HasSubstr("moment 0, sensor, position"));
    EXPECT_THAT(error_with(kObject + 8, bad), HasSubstr("moment 0, object 0, position"));
    EXPECT_THAT(error_with(kObject + 24, bad), HasSubstr("object 0, quaternion"));
    EXPECT_THAT(error_with(kObject + 56, bad), HasSubstr("object 0, rate"));
    EXPECT_THAT(error_with(kObject + 80, bad), HasSubstr("object 0, velocity"));
  }
}

TEST(DecodeRequest, RejectsQuaternionsThatAreNotOfLengthOne) {
  EXPECT_THAT(error_with(kSensor + 24, 0.0), HasSubstr("length 0"));
  EXPECT_THAT(error_with(kSensor + 24, 1.1), HasSubstr("length 1.1"));
  EXPECT_EQ(error_with(kSensor + 24, 1.0005), "no error") << "written with few digits";
}

TEST(EncodeHead, HasTheLayoutOfTheTables) {
  PointCloud cloud;
  cloud.columns = {{"xyz", {"x", "y", "z"}, std::vector<double>(6)},
                   {"ring", {"ring"}, std::vector<std::uint16_t>(2)}};
  const CloudHead head{
      .stamp_ns = -2,
      .seed = 8,
      .number = 4,
      .rows = 1,
      .cols = 2,
      .frame_id = "lidar_frame",
      .world_from_cloud = make_pose({1.0, 2.0, 3.0}, Eigen::Quaterniond::Identity())};
  Hand hand;
  hand.letters("GLDR", 4).put(std::uint16_t{1}).put(std::uint16_t{2}).put(std::uint64_t{6});
  hand.put(1U).put(2U);
  hand.letters("xyz", 24).letters("f8", 2).put(std::uint16_t{3}).put(0U);
  hand.letters("ring", 24).letters("u2", 2).put(std::uint16_t{1}).put(0U);
  hand.put(std::int64_t{-2}).put(std::uint64_t{8}).put(4U).put(1U).put(2U).put(0U);
  hand.letters("lidar_frame", 32);
  for (const double number : {1.0, 2.0, 3.0, 1.0, 0.0, 0.0, 0.0}) hand.put(number);
  EXPECT_EQ(encode_head(6, {{head}}, cloud), hand.bytes);
  EXPECT_EQ(hand.bytes.size(), 24U + 2U * 32U + 120U);
  EXPECT_EQ(bytes_of(cloud.columns[0]).size(), 48U);
}

TEST(EncodeTextHead, DistinguishesErrorsFromDescriptions) {
  Hand hand;
  hand.letters("GLDR", 4).put(std::uint16_t{1}).put(std::uint16_t{3}).put(std::uint64_t{1});
  EXPECT_EQ(encode_text_head(1, TextKind::error), hand.bytes);
}

}  // namespace
}  // namespace glidar::lockstep
