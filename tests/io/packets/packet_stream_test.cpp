// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "packet_fixture.hpp"

#include <glidar/core/error.hpp>
#include <glidar/io/packets/hesai.hpp>
#include <glidar/io/packets/sensor_packets.hpp>
#include <support/test_folder.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace glidar::testing {
namespace {

struct Stream {
  const char* preset;
  bool is_dual;
  double unit_m;
};

std::ostream& operator<<(std::ostream& out, const Stream& stream) {
  return out << stream.preset << (stream.is_dual ? " with two returns" : "");
}

std::vector<UdpPacket> packets_of(const Sensor& sensor, std::uint32_t frames) {
  std::vector<UdpPacket> packets;
  const auto encoder = make_packet_encoder(sensor);
  for (std::uint32_t number = 0; number < frames; ++number) {
    const DecodedFrame made = room_frame(sensor, number);
    encoder->encode(made.frame, made.beams, packets);
  }
  encoder->finish(packets);
  return packets;
}

std::vector<DecodedFrame> decoded(const Sensor& sensor, const std::vector<UdpPacket>& packets) {
  std::vector<DecodedFrame> frames;
  const auto decoder = make_packet_decoder(sensor);
  for (const UdpPacket& packet : packets) decoder->decode(packet, frames);
  decoder->finish(frames);
  return frames;
}

class PacketStream : public ::testing::TestWithParam<Stream> {};

TEST_P(PacketStream, RoundTripIsWithinHalfAUnitACentidegreeAndAMicrosecond) {
  const Sensor sensor = packet_sensor(GetParam().preset, GetParam().is_dual);
  std::vector<FlatReturn> truth;
  for (std::uint32_t number = 0; number < 2; ++number) flatten(room_frame(sensor, number), truth);
  std::vector<FlatReturn> found;
  for (const DecodedFrame& frame : decoded(sensor, packets_of(sensor, 2))) flatten(frame, found);
  sort_returns(truth);
  sort_returns(found);
  ASSERT_EQ(found.size(), truth.size());
  double range_m = 0.0;
  double angle_rad = 0.0;
  std::int64_t time_ns = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    ASSERT_EQ(found[i].ring, truth[i].ring) << i;
    range_m = std::max(range_m, std::abs(found[i].range_m - truth[i].range_m));
    const double sine = found[i].direction.cross(truth[i].direction).norm();
    angle_rad = std::max(angle_rad, std::asin(std::min(1.0, sine)));
    time_ns = std::max(time_ns, std::abs(found[i].stamp_ns - truth[i].stamp_ns));
  }
  EXPECT_LE(range_m, 0.5001 * GetParam().unit_m);
  EXPECT_LE(angle_rad, 0.01 * kDegree);
  EXPECT_LE(time_ns, 1'100);
}

TEST_P(PacketStream, DecodedFramesAreEncodedToTheSameBytes) {
  const Sensor sensor = packet_sensor(GetParam().preset, GetParam().is_dual);
  const std::vector<UdpPacket> packets = packets_of(sensor, 1);
  if (sensor.name.starts_with("Ouster"))
    GTEST_SKIP() << "the signal is not the reflectivity; nothing to do";
  std::vector<UdpPacket> again;
  const auto encoder = make_packet_encoder(sensor);
  for (DecodedFrame& frame : decoded(sensor, packets)) {
    for (float& value : frame.frame.intensity) value /= 255.0F;
    encoder->encode(frame.frame, frame.beams, again);
  }
  encoder->finish(again);
  ASSERT_EQ(again.size(), packets.size());
  for (std::size_t i = 0; i < packets.size(); ++i) {
    if (packets[i].port == 8308) continue;  // its time is rounded twice
    ASSERT_EQ(again[i].payload.size(), packets[i].payload.size());
    for (std::size_t at = 0; at < packets[i].payload.size(); ++at)
      ASSERT_EQ(again[i].payload[at], packets[i].payload[at]) << "packet " << i << ", byte " << at;
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, PacketStream,
    ::testing::Values(Stream{"VLP-16", false, 0.002}, Stream{"VLP-16", true, 0.002},
                      Stream{"Puck-Hi-Res", false, 0.002}, Stream{"VLP-32C", false, 0.004},
                      Stream{"VLP-32C", true, 0.004}, Stream{"HDL-32E", false, 0.002},
                      Stream{"HDL-32E", true, 0.002}, Stream{"HDL-64E-S3", false, 0.002},
                      Stream{"HDL-64E-S3", true, 0.002}, Stream{"VLS-128", false, 0.004},
                      Stream{"VLS-128", true, 0.004}, Stream{"OS1-32", false, 0.001},
                      Stream{"OS1-32", true, 0.001}, Stream{"Pandar64", false, 0.004},
                      Stream{"Pandar64", true, 0.004}, Stream{"QT64", false, 0.004},
                      Stream{"QT64", true, 0.004}, Stream{"XT32", false, 0.004},
                      Stream{"XT32", true, 0.004}));

TEST(PacketEncoder, RejectsASensorWhoseLasersFireAtOtherTimes) {
  Sensor sensor = packet_sensor("VLP-16", false);
  std::get<Spinning>(sensor.optics).channels[3].fire_time_ns += 100.0;
  try {
    make_packet_encoder(sensor);
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("Velodyne VLP-16"));
    EXPECT_THAT(error.what(), ::testing::HasSubstr("fire_time_us[3]: 7.012"));
  }
}

TEST(PacketEncoder, RejectsFramesOfAnotherSensor) {
  std::vector<UdpPacket> packets;
  const DecodedFrame other = room_frame(packet_sensor("VLP-32C", false), 0);
  const auto encoder = make_packet_encoder(packet_sensor("VLP-16", false));
  EXPECT_THROW(encoder->encode(other.frame, other.beams, packets), Error);
  EXPECT_THROW(make_packet_encoder(preset("TiM781")), Error);
}

TEST(PacketEncoder, PacketsContinueAcrossFrames) {
  const Sensor sensor = packet_sensor("VLP-16", false);
  const std::vector<UdpPacket> packets = packets_of(sensor, 3);
  std::size_t data = 0;
  for (const UdpPacket& packet : packets) data += packet.payload.size() == 1206 ? 1 : 0;
  EXPECT_EQ(data, 227U);  // 0.3 s of 1.327104 ms, the last one filled
}

TEST(PacketDecoder, IgnoresNothingMalformed) {
  const Sensor sensor = packet_sensor("VLP-16", false);
  std::vector<UdpPacket> packets = packets_of(sensor, 1);
  const auto decoder = make_packet_decoder(sensor);
  std::vector<DecodedFrame> frames;
  UdpPacket packet = packets.front();
  packet.payload.pop_back();
  EXPECT_THROW(decoder->decode(packet, frames), Error);
  packet = packets.front();
  packet.payload[0] = std::byte{0};
  EXPECT_THROW(decoder->decode(packet, frames), Error);
  packet = packets.front();
  packet.payload[1205] = std::byte{0x28};
  EXPECT_THROW(decoder->decode(packet, frames), Error);
}

TEST(PacketWriter, AppearsWhenItIsFinished) {
  const TestFolder folder;
  const Sensor sensor = packet_sensor("OS1-32", false);
  PacketWriter writer(folder / "scan.pcap", sensor);
  const DecodedFrame made = room_frame(sensor, 0);
  writer.write(made.frame, made.beams);
  EXPECT_FALSE(std::filesystem::exists(folder / "scan.pcap"));
  writer.finish();
  EXPECT_EQ(writer.packets(), 64U);
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"scan.json", "scan.pcap"}));
  const OusterSource source = load_ouster_source(folder / "scan.json");
  PcapReader reader(folder / "scan.pcap");
  const auto decoder = make_ouster_decoder(source);
  std::vector<DecodedFrame> frames;
  for (UdpPacket packet; reader.next(packet);) decoder->decode(packet, frames);
  decoder->finish(frames);
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames.front().beams.cols, 1024U);
}

}  // namespace
}  // namespace glidar::testing
