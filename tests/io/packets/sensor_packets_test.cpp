// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "packet_fixture.hpp"

#include <glidar/io/packets/sensor_packets.hpp>

#include <gmock/gmock.h>

namespace glidar::testing {
namespace {

/// Samples every 10 ms from the epoch of the fixture on: free of forces along x, turning about z.
ImuSamples turning(std::int64_t from_ns, std::int64_t until_ns) {
  constexpr std::int64_t kPeriod_ns = 10'000'000;
  ImuSamples samples;
  for (std::int64_t t_ns = kPacketEpoch_ns; t_ns < until_ns; t_ns += kPeriod_ns) {
    if (t_ns < from_ns) continue;
    samples.t_ns.push_back(t_ns);
    samples.specific_force_m_s2.emplace_back(0.0, 0.0, 9.80665);
    samples.angular_velocity_rad_s.emplace_back(0.0, 0.0, kDegree);
  }
  return samples;
}

std::vector<UdpPacket> two_frames(const Sensor& sensor) {
  SensorPackets encoder(sensor, {}, turning);
  std::vector<UdpPacket> packets;
  for (const std::uint32_t number : {0U, 1U}) {
    const DecodedFrame made = room_frame(sensor, number);
    encoder.encode(made.frame, made.beams, packets);
  }
  encoder.finish(packets);
  return packets;
}

TEST(HasPackets, IsFalseForModelsWithPacketsOfAnotherFormat) {
  for (const char* preset : {"XT32", "QT64", "Pandar64", "Livox-Mid-360", "Puck-Hi-Res"})
    EXPECT_TRUE(has_packets(packet_sensor(preset, false))) << preset;
  for (const char* preset : {"XT32M", "XT16", "QT128", "Pandar128", "VLP-32A", "D435"})
    EXPECT_FALSE(has_packets(packet_sensor(preset, false))) << preset;
}

TEST(HasImuPackets, IsTrueForPresetsOfOusterAndLivoxOnly) {
  for (const char* preset : {"OS1-32", "Livox-Avia"})
    EXPECT_TRUE(has_imu_packets(packet_sensor(preset, false))) << preset;
  for (const char* preset : {"XT32", "VLP-16", "D435"})
    EXPECT_FALSE(has_imu_packets(packet_sensor(preset, false))) << preset;
}

TEST(HasPacketMessages, IsTrueForPresetsOfOusterAndVelodyneOnly) {
  for (const char* preset : {"OS1-32", "VLP-16"})
    EXPECT_TRUE(has_packet_messages(packet_sensor(preset, false))) << preset;
  for (const char* preset : {"XT32", "Livox-Avia", "D435"})
    EXPECT_FALSE(has_packet_messages(packet_sensor(preset, false))) << preset;
}

TEST(SensorPackets, OfOusterHaveTheSamplesOfTheImuAmongThoseOfTheBeams) {
  std::vector<OusterImu> samples;
  std::int64_t last_ns = 0;
  for (const UdpPacket& packet : two_frames(packet_sensor("OS1-32", false))) {
    EXPECT_GE(packet.stamp_ns,
              last_ns - 20'000'000);  // the last packet of a frame waits for the next
    last_ns = packet.stamp_ns;
    if (packet.port == kOusterImuPort) samples.push_back(decode_ouster_imu(packet.payload));
  }
  ASSERT_EQ(samples.size(), 20U);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    EXPECT_EQ(samples[i].stamp_ns, static_cast<std::uint64_t>(kPacketEpoch_ns) + i * 10'000'000U);
    EXPECT_FLOAT_EQ(samples[i].acceleration_g[2], 1.0F);
    EXPECT_FLOAT_EQ(samples[i].rate_deg_s[2], 1.0F);
  }
}

TEST(SensorPackets, OfLivoxHaveTheSamplesOfTheImuInRadiansPerSecond) {
  std::size_t samples = 0;
  for (const UdpPacket& packet : two_frames(packet_sensor("Livox-Avia", false))) {
    if (packet.port != kLivoxImuPort) continue;
    EXPECT_EQ(packet.source_port, kLivoxImuSourcePort);
    EXPECT_EQ(packet.payload.size(), 60U);
    const LivoxPacket read = decode_livox_packet(packet.payload);
    EXPECT_EQ(read.type, LivoxDataType::imu);
    EXPECT_EQ(read.stamp_ns, static_cast<std::uint64_t>(kPacketEpoch_ns) + samples * 10'000'000U);
    EXPECT_FLOAT_EQ(read.acceleration_g[2], 1.0F);
    EXPECT_FLOAT_EQ(read.rate_rad_s[2], static_cast<float>(kDegree));
    ++samples;
  }
  EXPECT_EQ(samples, 20U);
}

TEST(SensorPackets, OfOtherManufacturersHaveNoImu) {
  for (const UdpPacket& packet : two_frames(packet_sensor("VLP-16", false)))
    EXPECT_THAT(packet.port, ::testing::AnyOf(2368, 8308));
}

}  // namespace
}  // namespace glidar::testing
