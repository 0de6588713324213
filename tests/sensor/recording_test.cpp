// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/spinning.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace glidar {
namespace {

constexpr std::size_t kSequencesInAPacket = 24;

/// A packet of a VLP-16 (manual, data packet format): the azimuth of every second firing sequence
/// and the microsecond of the hour in which the first one started.
struct Packet {
  std::array<double, kSequencesInAPacket / 2> azimuths_deg{};
  std::int64_t time_us = 0;
};

std::uint32_t number(const std::string& bytes, std::size_t at, std::size_t count) {
  std::uint32_t value = 0;
  for (std::size_t i = count; i-- > 0;) {
    value = value << 8U | static_cast<unsigned char>(bytes[at + i]);
  }
  return value;
}

/// The data packets of a capture (libpcap's format: 24 bytes, then 16 before each packet).
std::vector<Packet> read_capture(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream whole;
  whole << file.rdbuf();
  const std::string bytes = whole.str();
  std::vector<Packet> packets;
  for (std::size_t at = 24; at + 16 <= bytes.size();) {
    const std::size_t length = number(bytes, at + 8, 4);
    const std::size_t data = at + 16 + 42;  // behind the Ethernet, IP and UDP heads
    at += 16 + length;
    if (length != 1248 || at > bytes.size()) continue;
    Packet packet;
    for (std::size_t b = 0; b < packet.azimuths_deg.size(); ++b) {
      packet.azimuths_deg.at(b) = 0.01 * number(bytes, data + 100 * b + 2, 2);
    }
    packet.time_us = number(bytes, data + 1200, 4);
    packets.push_back(packet);
  }
  return packets;
}

double turned_deg(double from_deg, double to_deg) {
  return std::fmod(to_deg - from_deg + 360.0, 360.0);
}

TEST(Recording, OfAVlp16HasTheSimulatedTimesAndAzimuths) {
  const char* folder = std::getenv("GLIDAR_DATA");
  if (folder == nullptr) GTEST_SKIP() << "GLIDAR_DATA is not set: no real data to test with";
  const std::vector<Packet> packets = read_capture(
      std::filesystem::path(folder) / "recordings/velodyne/sample_velodyne_vlp16_gps.pcap");
  ASSERT_GT(packets.size(), 100U);
  const double passed_us = static_cast<double>(packets.back().time_us - packets.front().time_us);
  double passed_deg = 0.0;
  for (std::size_t i = 1; i < packets.size(); ++i) {
    passed_deg += turned_deg(packets[i - 1].azimuths_deg[0], packets[i].azimuths_deg[0]);
  }

  Spinning simulated;
  simulated.channels.resize(1);
  simulated.sequence_ns = 55'296.0;
  simulated.rotation_hz = passed_deg / 360.0 / (1e-6 * passed_us);
  EXPECT_NEAR(simulated.rotation_hz, 10.0, 0.2);  // the unit ran at 600 turns a minute
  const Beams beams = make_beams(simulated, {0, 1'000'000'000});
  for (std::size_t i = 0; i + 1 < packets.size(); ++i) {
    const std::size_t first = i * kSequencesInAPacket;
    if (first >= beams.cols) break;
    // the recording counts whole microseconds, by a crystal that is true to some parts in 1e5
    const double since_us = static_cast<double>(packets[i].time_us - packets[0].time_us);
    ASSERT_NEAR(since_us, 1e-3 * beams.times_ns[first], 1.0 + 1e-5 * since_us) << i;
    const Eigen::Vector3d& d = beams.directions[first];
    const double expected_deg = std::atan2(-d.y(), d.x()) * 180.0 / std::numbers::pi;
    const double found_deg = turned_deg(packets[0].azimuths_deg[0], packets[i].azimuths_deg[0]);
    // the motor's speed wavers by some tenths of a degree in a turn
    ASSERT_NEAR(std::remainder(found_deg - expected_deg, 360.0), 0.0, 1.0) << i;
  }
}

}  // namespace
}  // namespace glidar
