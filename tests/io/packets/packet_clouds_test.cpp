// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Messages of decoded packets against messages of the frames that were encoded.
#include "packet_fixture.hpp"

#include <glidar/core/output_frame.hpp>
#include <glidar/core/point_cloud.hpp>
#include <glidar/core/scene.hpp>
#include <glidar/io/packets/sensor_packets.hpp>
#include <glidar/io/ros/cloud_message.hpp>
#include <glidar/io/ros/codec.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <ostream>

namespace glidar::testing {
namespace {

struct CloudStream {
  const char* preset;
  bool is_dual;
  double unit_m;
  std::optional<OusterProfile> profile = std::nullopt;
};

std::ostream& operator<<(std::ostream& out, const CloudStream& stream) {
  out << stream.preset << (stream.is_dual ? " with two returns" : "");
  return stream.profile ? out << ' ' << name(*stream.profile) : out;
}

/// A point of a message.
struct MessagePoint {
  std::int64_t stamp_ns = 0;
  std::uint16_t ring = 0;
  Eigen::Vector3d xyz_m = Eigen::Vector3d::Zero();
};

template <class T>
const std::vector<T>& column_of(const PointCloud& cloud, const char* column) {
  return std::get<std::vector<T>>(find_column(cloud, column)->values);
}

/// Appends the points of a frame's PointCloud2, after a journey through its bytes.
void append_points(const DecodedFrame& from, const Sensor& sensor,
                   std::vector<MessagePoint>& points) {
  const std::vector<std::string> columns = {"xyz", "ring", "time"};
  PointCloud cloud;
  make_point_cloud(from.frame, from.beams, Scene{}, {}, columns, cloud);
  const ros::PointCloud2 sent = ros::to_point_cloud2(cloud, {from.frame, sensor, from.beams});
  const auto bytes = ros::serialize(sent);
  const auto message = ros::deserialize<ros::PointCloud2>(bytes);
  const PointCloud received = ros::to_point_cloud(message);
  const auto& xyz = column_of<double>(received, "xyz");
  const auto& rings = column_of<std::uint16_t>(received, "ring");
  const auto& times = column_of<std::uint32_t>(received, "time");
  for (std::size_t i = 0; i < received.size(); ++i)
    points.push_back({ros::to_ns(message.header.stamp) + times[i],
                      rings[i],
                      {xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]}});
}

/// By ring, pulse and range; pulses are further than 10 us apart.
void sort_points(std::vector<MessagePoint>& points) {
  std::sort(points.begin(), points.end(), [](const MessagePoint& a, const MessagePoint& b) {
    if (a.ring != b.ring) return a.ring < b.ring;
    if (std::abs(a.stamp_ns - b.stamp_ns) > 10'000) return a.stamp_ns < b.stamp_ns;
    return a.xyz_m.squaredNorm() < b.xyz_m.squaredNorm();
  });
}

class PacketClouds : public ::testing::TestWithParam<CloudStream> {};

TEST_P(PacketClouds, OfDecodedPacketsHaveThePointsOfTheFramesWithinTheUnit) {
  const Sensor sensor = packet_sensor(GetParam().preset, GetParam().is_dual);
  PacketOptions options;
  options.ouster.profile = GetParam().profile;
  const auto encoder = make_packet_encoder(sensor, options);
  const auto decoder = make_packet_decoder(sensor, options);
  std::vector<UdpPacket> packets;
  std::vector<MessagePoint> expected;
  for (std::uint32_t number = 0; number < 2; ++number) {
    const DecodedFrame made = room_frame(sensor, number);
    append_points(made, sensor, expected);
    encoder->encode(made.frame, made.beams, packets);
  }
  encoder->finish(packets);
  std::vector<DecodedFrame> frames;
  for (const UdpPacket& packet : packets) decoder->decode(packet, frames);
  decoder->finish(frames);
  std::vector<MessagePoint> found;
  for (const DecodedFrame& frame : frames) append_points(frame, sensor, found);
  sort_points(expected);
  sort_points(found);
  ASSERT_EQ(found.size(), expected.size());
  ASSERT_GT(found.size(), 1000U);
  double excess_m = -1.0;
  std::int64_t late_ns = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    ASSERT_EQ(found[i].ring, expected[i].ring) << i;
    const double limit_m =
        0.5001 * GetParam().unit_m + 0.0105 * kDegree * expected[i].xyz_m.norm() + 2e-6;
    excess_m = std::max(excess_m, (found[i].xyz_m - expected[i].xyz_m).norm() - limit_m);
    late_ns = std::max(late_ns, std::abs(found[i].stamp_ns - expected[i].stamp_ns));
  }
  EXPECT_LE(excess_m, 0.0);
  EXPECT_LE(late_ns, 1'100);
}

TEST(PacketColours, OfDecodedPacketsAreThoseOfTheFirstReturnInHalfPrecision) {
  PacketOptions options;
  options.ouster.profile = OusterProfile::rng19_rfl8_sig16_nir16_rgb16_dual;
  const Sensor sensor = packet_sensor("OS1-32", true);
  const auto encoder = make_packet_encoder(sensor, options);
  const auto decoder = make_packet_decoder(sensor, options);
  const DecodedFrame made = room_frame(sensor, 0);
  std::vector<UdpPacket> packets;
  encoder->encode(made.frame, made.beams, packets);
  encoder->finish(packets);
  std::vector<DecodedFrame> frames;
  for (const UdpPacket& packet : packets) decoder->decode(packet, frames);
  decoder->finish(frames);
  ASSERT_EQ(frames.size(), 1U);
  const Frame& found = frames.front().frame;
  ASSERT_EQ(found.ground_truth.colour.size(), found.range_m.size());
  constexpr float kHalfPrecision = 0x1p-12F;  // of shares up to 1
  std::size_t colours = 0;
  for (std::size_t i = 0; i < found.range_m.size() / 2; ++i) {
    if (found.status[i] != Status::hit) continue;
    ASSERT_EQ(made.frame.status[i], Status::hit) << i;
    const Eigen::Vector3f& wanted = made.frame.ground_truth.colour[i];
    ASSERT_LE((found.ground_truth.colour[i] - wanted).cwiseAbs().maxCoeff(), kHalfPrecision) << i;
    ++colours;
  }
  EXPECT_GT(colours, 10'000U);
}

TEST(PacketColours, AreDemandedOfTheFrame) {
  PacketOptions options;
  options.ouster.profile = OusterProfile::rng19_rfl8_sig16_nir16_rgb16;
  const Sensor sensor = packet_sensor("OS1-32", false);
  DecodedFrame made = room_frame(sensor, 0);
  made.frame.ground_truth.colour.clear();
  std::vector<UdpPacket> packets;
  EXPECT_THAT(
      [&] { make_packet_encoder(sensor, options)->encode(made.frame, made.beams, packets); },
      ::testing::Throws<Error>(::testing::Property(
          &Error::what, ::testing::AllOf(::testing::HasSubstr("a frame without the column colour"),
                                         ::testing::HasSubstr("simulate with this column")))));
  EXPECT_THAT(packet_columns(options), ::testing::Contains("colour"));
}

INSTANTIATE_TEST_SUITE_P(
    All, PacketClouds,
    ::testing::Values(
        CloudStream{"VLP-16", false, 0.002}, CloudStream{"VLP-16", true, 0.002},
        CloudStream{"Puck-Hi-Res", false, 0.002}, CloudStream{"Puck-Hi-Res", true, 0.002},
        CloudStream{"VLP-32C", false, 0.004}, CloudStream{"VLP-32C", true, 0.004},
        CloudStream{"HDL-32E", false, 0.002}, CloudStream{"HDL-32E", true, 0.002},
        CloudStream{"HDL-64E-S3", false, 0.002}, CloudStream{"HDL-64E-S3", true, 0.002},
        CloudStream{"VLS-128", false, 0.004}, CloudStream{"VLS-128", true, 0.004},
        CloudStream{"OS0-128", false, 0.001}, CloudStream{"OS2-128", false, 0.001},
        CloudStream{"OS1-32", false, 0.001, OusterProfile::legacy},
        CloudStream{"OS1-32", false, 0.001, OusterProfile::rng19_rfl8_sig16_nir16},
        CloudStream{"OS1-32", true, 0.001, OusterProfile::rng19_rfl8_sig16_nir16_dual},
        CloudStream{"OS1-32", false, 0.009, OusterProfile::rng15_rfl8_nir8},
        CloudStream{"OS1-32", false, 0.001, OusterProfile::rng19_rfl8_sig16_nir16_rgb16},
        CloudStream{"OS1-32", true, 0.001, OusterProfile::rng19_rfl8_sig16_nir16_rgb16_dual},
        CloudStream{"Pandar64", false, 0.004}, CloudStream{"Pandar64", true, 0.004},
        CloudStream{"QT64", false, 0.004}, CloudStream{"QT64", true, 0.004},
        CloudStream{"XT32", false, 0.004}, CloudStream{"XT32", true, 0.004}));

}  // namespace
}  // namespace glidar::testing
