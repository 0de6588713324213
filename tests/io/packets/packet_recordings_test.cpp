// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Packets of real sensors are decoded to numbers and encoded again (GLIDAR_DATA).
#include "packet_fixture.hpp"

#include <glidar/io/bags/sqlite_bag_reader.hpp>
#include <glidar/io/files/input_file.hpp>
#include <glidar/io/packets/hesai.hpp>
#include <glidar/io/packets/ouster.hpp>
#include <glidar/io/packets/pcap_file.hpp>
#include <glidar/io/packets/velodyne.hpp>
#include <support/data.hpp>

#include <gmock/gmock.h>

#include <array>
#include <filesystem>
#include <memory>
#include <ostream>

namespace glidar::testing {
namespace {

using Payload = std::vector<std::byte>;

/// The payloads of one size in a capture file of the data folder.
std::vector<Payload> recorded_payloads(const std::string& capture, std::size_t size) {
  std::vector<Payload> payloads;
  PcapReader reader(data_folder() / "recordings" / capture);
  for (UdpPacket packet; reader.next(packet);)
    if (packet.payload.size() == size) payloads.push_back(packet.payload);
  return payloads;
}

/// Offsets of the bytes that differ.
std::vector<std::size_t> changed_bytes(const Payload& a, const Payload& b) {
  std::vector<std::size_t> changed;
  if (a.size() != b.size()) return {std::max(a.size(), b.size())};
  for (std::size_t i = 0; i < a.size(); ++i)
    if (a[i] != b[i]) changed.push_back(i);
  return changed;
}

TEST(PacketRecordings, OfAVlp16AreEncodedToTheSameBytes) {
  GLIDAR_NEEDS_DATA();
  const auto payloads =
      recorded_payloads("velodyne/sample_velodyne_vlp16_gps.pcap", kVelodynePacketBytes);
  EXPECT_EQ(payloads.size(), 293U);
  for (const Payload& payload : payloads)
    ASSERT_THAT(changed_bytes(payload, encode(decode_velodyne_packet(payload))),
                ::testing::IsEmpty());
}

TEST(PacketRecordings, OfPositionsOfAVlp16AreEncodedToTheSameBytes) {
  GLIDAR_NEEDS_DATA();
  const auto payloads =
      recorded_payloads("velodyne/sample_velodyne_vlp16_gps.pcap", kVelodynePositionBytes);
  EXPECT_EQ(payloads.size(), 57U);
  for (const Payload& payload : payloads)
    ASSERT_THAT(changed_bytes(payload, encode(decode_velodyne_position(payload))),
                ::testing::IsEmpty());
}

struct OusterRecording {
  const char* metadata;
  const char* capture;
  std::size_t packets;
};

void PrintTo(const OusterRecording& recording, std::ostream* out) {
  *out << recording.capture;
}

class OusterPacketRecordings : public ::testing::TestWithParam<OusterRecording> {};

TEST_P(OusterPacketRecordings, AreEncodedToTheSameBytes) {
  GLIDAR_NEEDS_DATA();
  const OusterSource source = load_ouster_source(data_folder() / "recordings/ouster" /
                                                 (std::string(GetParam().metadata) + ".json"));
  const auto payloads = recorded_payloads(std::string("ouster/") + GetParam().capture + ".pcap",
                                          ouster_packet_bytes(source.format));
  EXPECT_EQ(payloads.size(), GetParam().packets);
  const std::uint32_t columns = std::get<Spinning>(source.sensor.optics).columns_per_turn;
  for (const Payload& payload : payloads) {
    const OusterPacket packet = decode_ouster_packet(payload, source.format);
    ASSERT_THAT(changed_bytes(payload, encode(packet, source.format, columns)),
                ::testing::IsEmpty());
  }
}

INSTANTIATE_TEST_SUITE_P(All, OusterPacketRecordings,
                         ::testing::Values(OusterRecording{"OS-0-128-U1_v2.3.0_1024x10",
                                                           "OS-0-128-U1_v2.3.0_1024x10", 64},
                                           OusterRecording{"OS-1-128_v2.3.0_1024x10",
                                                           "OS-1-128_v2.3.0_1024x10_lb_n3", 192},
                                           OusterRecording{"crc_test", "crc_test", 34}));

TEST(PacketRecordings, OfAnOusterImuAreEncodedToTheSameBytes) {
  GLIDAR_NEEDS_DATA();
  const auto payloads = recorded_payloads("ouster/crc_test.pcap", kOusterImuBytes);
  EXPECT_EQ(payloads.size(), 10U);
  for (const Payload& payload : payloads)
    ASSERT_THAT(changed_bytes(payload, encode(decode_ouster_imu(payload))), ::testing::IsEmpty());
}

/// The packets in the messages of the recorded XT32.
std::vector<Payload> xt32_payloads() {
  constexpr std::array kHead = {std::byte{0xEE}, std::byte{0xFF}, std::byte{6}, std::byte{1}};
  constexpr std::ptrdiff_t kBytes = 1080;
  std::vector<Payload> payloads;
  const std::filesystem::path path = data_folder() / "depth/nebula/xt32.db3";
  const auto bag =
      bags::open_sqlite_bag(path, std::make_shared<InputBudget>(std::filesystem::file_size(path)));
  for (bags::BagMessage message; bag->next(message);) {
    auto at = std::search(message.data.begin(), message.data.end(), kHead.begin(), kHead.end());
    while (message.data.end() - at >= kBytes) {
      payloads.emplace_back(at, at + kBytes);
      at = std::search(at + kBytes, message.data.end(), kHead.begin(), kHead.end());
    }
  }
  return payloads;
}

TEST(PacketRecordings, OfAnXt32AreEncodedToTheSameBytes) {
  GLIDAR_NEEDS_DATA();
  const HesaiModel& model = *find_hesai_model(packet_sensor("XT32", true));
  const auto payloads = xt32_payloads();
  EXPECT_EQ(payloads.size(), 2000U);
  for (const Payload& payload : payloads)
    ASSERT_THAT(changed_bytes(payload, encode(decode_hesai_packet(payload, model), model)),
                ::testing::IsEmpty());
}

}  // namespace
}  // namespace glidar::testing
