// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/noise/noise.hpp>
#include <glidar/sensor/optics/spinning.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <numeric>
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

std::string read_bytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream whole;
  whole << file.rdbuf();
  return whole.str();
}

/// The data packets of a capture (libpcap's format: 24 bytes, then 16 before each packet).
std::vector<Packet> read_capture(const std::filesystem::path& path) {
  const std::string bytes = read_bytes(path);
  std::vector<Packet> packets;
  for (std::size_t at = 24; at + 16 <= bytes.size();) {
    const std::size_t length = number(bytes, at + 8, 4);
    const std::size_t data = at + 16 + 42;  // after the Ethernet, IP and UDP headers
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
  if (folder == nullptr)
    GTEST_SKIP() << "GLIDAR_DATA is not set; set it to a folder with real data";
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
  simulated.firing_period_ns = 55'296.0;
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
    // the motor's angle deviates by some tenths of a degree per turn
    ASSERT_NEAR(std::remainder(found_deg - expected_deg, 360.0), 0.0, 1.0) << i;
  }
}

/// One column of an Ouster: when it was taken, its number in the turn, its ranges.
struct OusterColumn {
  std::int64_t time_ns = 0;
  std::uint32_t number = 0;
  std::vector<std::uint32_t> ranges_mm{};
};

constexpr std::size_t kOusterRows = 128;

/// The columns of a packet of the profile RNG15_RFL8_NIR8 (Ouster, "Lidar packet format"): 32 bytes
/// of head, then 16 columns of a head of 12 bytes and a word a pixel, whose low 15 bits count 8 mm.
void read_columns(const std::string& packet,
                  std::map<std::uint32_t, std::vector<OusterColumn>>& frames) {
  constexpr std::size_t kColumn = 12 + 4 * kOusterRows;
  std::vector<OusterColumn>& columns = frames[number(packet, 2, 2)];
  for (std::size_t c = 0; c < 16; ++c) {
    const std::size_t at = 32 + c * kColumn;
    if (number(packet, at + 10, 2) % 2 == 0) continue;  // not valid
    OusterColumn& column = columns.emplace_back();
    column.time_ns = std::int64_t{number(packet, at, 4)} |
                     static_cast<std::int64_t>(number(packet, at + 4, 4)) << 32U;
    column.number = number(packet, at + 8, 2);
    for (std::size_t row = 0; row < kOusterRows; ++row) {
      column.ranges_mm.push_back(8U * (number(packet, at + 12 + 4 * row, 4) & 0x7FFFU));
    }
  }
}

/// The frames of a capture; its UDP packets come in fragments of IPv4, in their order.
std::map<std::uint32_t, std::vector<OusterColumn>> read_ouster(const std::filesystem::path& path) {
  const std::string bytes = read_bytes(path);
  std::map<std::uint32_t, std::vector<OusterColumn>> frames;
  std::string datagram;
  for (std::size_t at = 24; at + 16 <= bytes.size();) {
    const std::size_t ip = at + 16 + 14;  // after the headers of the record and of Ethernet
    at += 16 + number(bytes, at + 8, 4);
    const auto big = [&](std::size_t from) {
      return static_cast<unsigned char>(bytes[from]) * 256U +
             static_cast<unsigned char>(bytes[from + 1]);
    };
    const std::uint32_t fragment = big(ip + 6);  // 0x2000: more follow; the rest: offset / 8
    if ((fragment & 0x1FFFU) == 0) datagram.clear();
    datagram += bytes.substr(ip + 20, big(ip + 2) - 20);
    constexpr std::size_t kUdpHead = 8;
    constexpr std::size_t kPacket = 64 + 16 * (12 + 4 * kOusterRows);
    const bool is_whole = (fragment & 0x2000U) == 0;
    if (is_whole && datagram.size() == kUdpHead + kPacket) {
      read_columns(datagram.substr(kUdpHead), frames);
    }
  }
  return frames;
}

/// Greatest common divisor of all ranges but 0.
std::uint32_t quantum_mm(const std::vector<OusterColumn>& columns) {
  std::uint32_t common = 0;
  for (const OusterColumn& column : columns) {
    for (const std::uint32_t range_mm : column.ranges_mm) common = std::gcd(common, range_mm);
  }
  return common;
}

/// Times from column to column.
std::vector<double> steps_us(std::vector<std::int64_t> times_ns) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < times_ns.size(); ++i) {
    steps.push_back(1e-3 * static_cast<double>(times_ns[i] - times_ns[i - 1]));
  }
  std::sort(steps.begin(), steps.end());
  return steps;
}

/// A turn of an OS-128 in its mode 1024x10.
Beams ouster_turn() {
  Spinning simulated;
  simulated.channels.resize(kOusterRows);
  simulated.columns_per_turn = 1024;
  return make_beams(simulated, {0, 100'000'000});
}

class OusterRecording : public ::testing::TestWithParam<const char*> {
 protected:
  static std::map<std::uint32_t, std::vector<OusterColumn>> frames() {
    return read_ouster(std::filesystem::path(std::getenv("GLIDAR_DATA")) / "recordings/ouster" /
                       GetParam());
  }
};

TEST_P(OusterRecording, HasTheSimulatedTimesOfColumns) {
  if (std::getenv("GLIDAR_DATA") == nullptr) {
    GTEST_SKIP() << "GLIDAR_DATA is not set; set it to a folder with real data";
  }
  const Beams beams = ouster_turn();
  std::vector<std::int64_t> simulated_ns;
  for (std::size_t c = 0; c < beams.cols; ++c) simulated_ns.push_back(beams.times_ns[c]);
  const std::vector<double> simulated_us = steps_us(simulated_ns);
  const double span_ms = 1e-6 * static_cast<double>(simulated_ns.back());
  EXPECT_NEAR(simulated_us.front(), 97.65625, 1e-3);  // times are whole nanoseconds
  EXPECT_NEAR(simulated_us.back(), 97.65625, 1e-3);
  const auto recorded = frames();
  ASSERT_FALSE(recorded.empty());
  for (const auto& [frame, columns] : recorded) {
    ASSERT_EQ(columns.size(), beams.cols) << frame;
    std::vector<std::int64_t> times_ns;
    for (std::size_t c = 0; c < columns.size(); ++c) {
      ASSERT_EQ(columns[c].number, c);
      times_ns.push_back(columns[c].time_ns);
      // the encoder starts columns, so that speed variations are visible; they average out over a
      // turn
      const double since_us = 1e-3 * static_cast<double>(times_ns[c] - times_ns[0]);
      ASSERT_NEAR(since_us, 1e-3 * static_cast<double>(simulated_ns[c]), 200.0) << c;
    }
    const std::vector<double> found_us = steps_us(times_ns);
    EXPECT_NEAR(found_us[found_us.size() / 2], 97.66, 0.2) << frame;
    EXPECT_GT(found_us.front(), 92.0);
    EXPECT_LT(found_us.back(), 103.0);
    EXPECT_NEAR(1e-6 * static_cast<double>(times_ns.back() - times_ns.front()), span_ms, 0.1);
  }
}

TEST_P(OusterRecording, HasTheSimulatedQuantumOfRange) {
  if (std::getenv("GLIDAR_DATA") == nullptr) {
    GTEST_SKIP() << "GLIDAR_DATA is not set; set it to a folder with real data";
  }
  constexpr double kQuantum_m = 0.008;  // of the profile of low data rate; others count 1 mm
  for (const auto& [frame, columns] : frames()) EXPECT_EQ(quantum_mm(columns), 8U) << frame;

  Beams beams = ouster_turn();
  beams.range_offset_m = 0.015806;  // ranges count from the axis
  Frame frame;
  resize(frame, beams.size());
  for (std::size_t i = 0; i < beams.size(); ++i) {
    frame.range_m[i] = 1.0 + 1e-4 * static_cast<double>(i);
    frame.status[i] = Status::hit;
  }
  ThreadPool thread_pool(2);
  NoiseWorkspace workspace;
  apply_noise(plan_noise({RangeQuantization{.step_m = kQuantum_m}}, 0.1), beams, thread_pool,
              workspace, frame);
  OusterColumn simulated;
  for (const double range_m : frame.range_m) {
    const double range_mm = 1e3 * (range_m + beams.range_offset_m);
    ASSERT_NEAR(range_mm, std::round(range_mm), 1e-6);
    simulated.ranges_mm.push_back(static_cast<std::uint32_t>(std::lround(range_mm)));
  }
  EXPECT_EQ(quantum_mm({simulated}), 8U);
}

INSTANTIATE_TEST_SUITE_P(Captures, OusterRecording,
                         ::testing::Values("OS-0-128-U1_v2.3.0_1024x10.pcap",
                                           "OS-1-128_v2.3.0_1024x10_lb_n3.pcap"),
                         [](const auto& test) {
                           return std::string(test.param).substr(0, 4) == "OS-0" ? "OS0" : "OS1";
                         });

}  // namespace
}  // namespace glidar
