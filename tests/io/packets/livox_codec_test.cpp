// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/packets/livox.hpp>

#include "packet_fixture.hpp"

#include <glidar/core/error.hpp>
#include <glidar/io/packets/sensor_packets.hpp>

#include <gmock/gmock.h>

#include <map>

namespace glidar::testing {
namespace {

/// A preset and a data type, with the unit of its coordinates.
struct LivoxStream {
  const char* preset;
  LivoxDataType type;
  double unit_m;
  double unit_rad;  ///< of angles
};

std::ostream& operator<<(std::ostream& out, const LivoxStream& stream) {
  return out << stream.preset << ", data type " << static_cast<int>(stream.type);
}

std::vector<UdpPacket> livox_packets(const Sensor& sensor, LivoxDataType type,
                                     std::uint32_t frames) {
  std::vector<UdpPacket> packets;
  const auto encoder = make_livox_encoder(sensor, type);
  for (std::uint32_t number = 0; number < frames; ++number) {
    const DecodedFrame made = room_frame(sensor, number);
    encoder->encode(made.frame, made.beams, packets);
  }
  encoder->finish(packets);
  return packets;
}

std::vector<DecodedFrame> livox_frames(const Sensor& sensor,
                                       const std::vector<UdpPacket>& packets) {
  std::vector<DecodedFrame> frames;
  const auto decoder = make_packet_decoder(sensor);
  for (const UdpPacket& packet : packets) decoder->decode(packet, frames);
  decoder->finish(frames);
  return frames;
}

class LivoxPackets : public ::testing::TestWithParam<LivoxStream> {};

TEST_P(LivoxPackets, RoundTripIsWithinHalfAUnitPerAxisAndATenthOfAMicrosecond) {
  const LivoxStream& stream = GetParam();
  const Sensor sensor = packet_sensor(stream.preset, false);
  const std::vector<DecodedFrame> found =
      livox_frames(sensor, livox_packets(sensor, stream.type, 2));
  ASSERT_GE(found.size(), 2U);  // the last packet may begin a third
  for (std::uint32_t number = 0; number < 2; ++number) {
    const DecodedFrame truth = room_frame(sensor, number);
    const DecodedFrame& got = found[number];
    ASSERT_EQ(got.beams.rows, truth.beams.rows);
    ASSERT_EQ(got.beams.cols, truth.beams.cols);
    EXPECT_EQ(got.frame.stamp_ns, truth.frame.stamp_ns + truth.beams.times_ns[0]);
    for (std::size_t i = 0; i < truth.beams.size(); ++i) {
      ASSERT_EQ(got.frame.status[i], truth.frame.status[i]) << i;
      ASSERT_EQ(got.beams.rings[i], truth.beams.rings[i]);
      const std::int64_t late_ns = got.frame.stamp_ns + got.beams.times_ns[i] -
                                   truth.frame.stamp_ns - truth.beams.times_ns[i];
      ASSERT_LE(std::abs(late_ns), 100);
      if (truth.frame.status[i] != Status::hit) continue;
      const double range_m = truth.frame.range_m[i];
      const double error_m =
          (got.frame.range_m[i] * got.beams.directions[i] - range_m * truth.beams.directions[i])
              .norm();
      ASSERT_LE(error_m, 0.8661 * stream.unit_m + 0.7072 * stream.unit_rad * range_m);
      ASSERT_EQ(got.frame.intensity[i], std::round(150.0F * truth.frame.intensity[i]));
    }
  }
}

TEST_P(LivoxPackets, HaveThePointsOfTheSdkInTheOrderOfFiring) {
  const LivoxStream& stream = GetParam();
  const Sensor sensor = packet_sensor(stream.preset, false);
  const std::map<LivoxDataType, std::size_t> sizes = {{LivoxDataType::cartesian_mm, 1380},
                                                      {LivoxDataType::cartesian_cm, 804},
                                                      {LivoxDataType::spherical, 996}};
  const std::size_t beams = std::get<Prism>(sensor.optics).incidence_rad.size();
  std::uint64_t last_ns = 0;
  for (const UdpPacket& packet : livox_packets(sensor, stream.type, 1)) {
    EXPECT_EQ(packet.payload.size(), sizes.at(stream.type));
    EXPECT_EQ(packet.port, 56301);
    EXPECT_EQ(packet.source_port, 56300);
    const LivoxPacket read = decode_livox_packet(packet.payload);
    EXPECT_EQ(read.points.size(), 96U);
    EXPECT_EQ(read.interval * 100.0,
              1e9 / std::get<Prism>(sensor.optics).pulse_hz * 96.0 / static_cast<double>(beams));
    EXPECT_GT(read.stamp_ns, last_ns);
    last_ns = read.stamp_ns;
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, LivoxPackets,
    ::testing::Values(LivoxStream{"Livox-Mid-40", LivoxDataType::cartesian_mm, 0.001, 0.0},
                      LivoxStream{"Livox-Mid-70", LivoxDataType::cartesian_cm, 0.01, 0.0},
                      LivoxStream{"Livox-Avia", LivoxDataType::cartesian_mm, 0.001, 0.0},
                      LivoxStream{"Livox-Avia", LivoxDataType::cartesian_cm, 0.01, 0.0},
                      LivoxStream{"Livox-Avia", LivoxDataType::spherical, 0.001, 0.01 * kDegree}));

TEST(LivoxPacket, HasTheBytesOfTheProtocol) {
  LivoxPacket packet;
  packet.interval = 0x2580;
  packet.count = 0x0102;
  packet.frame = 3;
  packet.stamp_ns = 0x1122334455667788;
  packet.points = {{{1, -2, 0x01020304}, 150, 16}};
  const std::vector<std::byte> bytes = encode(packet);
  const std::vector<int> expected = {0,    50,   0,    0x80, 0x25, 1,    0,    2,    1,    3,
                                     1,    1,    0,    0,    0,    0,    0,    0,    0,    0,
                                     0,    0,    0,    0,    0x7d, 0xea, 0xef, 0x41, 0x88, 0x77,
                                     0x66, 0x55, 0x44, 0x33, 0x22, 0x11, 1,    0,    0,    0,
                                     0xfe, 0xff, 0xff, 0xff, 4,    3,    2,    1,    150,  16};
  ASSERT_EQ(bytes.size(), expected.size());
  for (std::size_t i = 0; i < bytes.size(); ++i)
    EXPECT_EQ(std::to_integer<int>(bytes[i]), expected[i]) << "byte " << i;
}

TEST(LivoxPacket, RejectsEveryDamagedByteButUnusedOnes) {
  LivoxPacket packet;
  packet.points.resize(2);
  const std::vector<std::byte> good = encode(packet);
  EXPECT_NO_THROW(decode_livox_packet(good));
  for (std::size_t size = 0; size < good.size(); ++size)
    EXPECT_THROW(decode_livox_packet(std::span(good).first(size)), Error) << size;
  for (std::size_t i = 0; i < good.size(); ++i) {
    const bool is_free = i == 3 || i == 4 || (i >= 7 && i <= 9) || (i >= 11 && i < 24);
    std::vector<std::byte> bad = good;
    bad[i] ^= std::byte{0xFF};
    if (is_free)
      EXPECT_NO_THROW(decode_livox_packet(bad)) << i;
    else
      EXPECT_THROW(decode_livox_packet(bad), Error) << i;
  }
}

TEST(LivoxPacket, PointsBeyondTheBitsOfTheTypeAreNoReturns) {
  Sensor sensor = packet_sensor("Livox-Mid-40", false);
  DecodedFrame made = room_frame(sensor, 0);
  for (double& range_m : made.frame.range_m) range_m = 400.0;
  std::vector<UdpPacket> packets;
  make_livox_encoder(sensor, LivoxDataType::cartesian_cm)->encode(made.frame, made.beams, packets);
  ASSERT_FALSE(packets.empty());
  for (const LivoxPoint& point : decode_livox_packet(packets[0].payload).points)
    EXPECT_EQ(point.numbers, (std::array<std::int64_t, 3>{}));
}

TEST(LivoxEncoder, CountsPacketsOnFromFrameToFrame) {
  const Sensor sensor = packet_sensor("Livox-Mid-40", false);
  std::uint16_t expected = 0;
  for (const UdpPacket& packet : livox_packets(sensor, LivoxDataType::cartesian_mm, 3))
    EXPECT_EQ(decode_livox_packet(packet.payload).count, expected++);
  EXPECT_GT(expected, 200);
}

TEST(LivoxEncoder, RejectsSensorsThatDoNotFit) {
  Sensor dual = packet_sensor("Livox-Avia", false);
  dual.receiver.returns.resize(2);
  EXPECT_THROW(make_packet_encoder(dual), Error);
  Sensor seven = packet_sensor("Livox-Avia", false);
  std::get<Prism>(seven.optics).incidence_rad.resize(7);
  EXPECT_THROW(make_packet_encoder(seven), Error);
  EXPECT_THROW(make_livox_encoder(packet_sensor("VLP-16", false)), Error);
  EXPECT_THROW(make_livox_encoder(packet_sensor("Livox-Avia", false), LivoxDataType::imu), Error);
}

TEST(LivoxDecoder, QuarterTurnsOfSphericalPointsAreExactlyOnTheAxes) {
  const Sensor sensor = packet_sensor("Livox-Mid-40", false);
  LivoxPacket packet;
  packet.type = LivoxDataType::spherical;
  packet.interval = 9600;
  packet.points.assign(kLivoxPoints, {{5000, 9000, 9000}, 10, 0});  // 5 m to the left
  packet.points[1].numbers = {5000, 9000, 18'000};
  packet.points[2].numbers = {5000, 9000, 27'000};
  packet.points[3].numbers = {5000, 18'000, 0};
  const std::vector<DecodedFrame> frames =
      livox_frames(sensor, {{0, 56300, 56301, encode(packet)}});
  ASSERT_EQ(frames.size(), 1U);
  const std::vector<Eigen::Vector3d>& directions = frames[0].beams.directions;
  EXPECT_EQ(directions.at(0), Eigen::Vector3d(0.0, 1.0, 0.0));
  EXPECT_EQ(directions.at(1), Eigen::Vector3d(-1.0, 0.0, 0.0));
  EXPECT_EQ(directions.at(2), Eigen::Vector3d(0.0, -1.0, 0.0));
  EXPECT_EQ(directions.at(3), Eigen::Vector3d(0.0, 0.0, -1.0));
  EXPECT_EQ(frames[0].frame.range_m.at(0), 5.0);
}

TEST(LivoxDecoder, IgnoresCommandsAndSamplesOfTheImu) {
  const Sensor sensor = packet_sensor("Livox-Avia", false);
  const auto decoder = make_livox_decoder(sensor);
  std::vector<DecodedFrame> frames;
  LivoxPacket imu;
  imu.type = LivoxDataType::imu;
  decoder->decode({0, 56400, 56401, encode(imu)}, frames);
  decoder->decode({0, 56100, 56101, {std::byte{0xAA}, std::byte{0}}}, frames);
  decoder->finish(frames);
  EXPECT_TRUE(frames.empty());
}

}  // namespace
}  // namespace glidar::testing
