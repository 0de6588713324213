// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "packet_fixture.hpp"

#include <glidar/io/packets/velodyne.hpp>

#include <gtest/gtest.h>

namespace glidar::testing {
namespace {

Hdl64Status status_of(PacketReturnMode mode) {
  const Sensor sensor = packet_sensor("HDL-64E-S3", false);
  return {std::get<Spinning>(sensor.optics), mode, true};
}

TEST(Hdl64Status, GroupsOf16PacketsHaveTheDateTheTimeAndSevenValues) {
  const Hdl64Status status = status_of(PacketReturnMode::strongest);
  std::string types;
  std::string values;
  for (std::uint64_t packet = 0; packet < 16; ++packet) {
    const Hdl64Status::Entry entry = status.at(packet, kPacketEpoch_ns);
    types += static_cast<char>(entry.type);
    values += static_cast<char>(entry.value);
  }
  EXPECT_EQ(types, "HMSDNYGTV1234567");
  EXPECT_EQ(values.substr(0, 7), "\x16\x21\x36\x0E\x0B\x17P");  // 2023-11-14 22:33:54
  EXPECT_EQ(values.substr(9, 5), "UNIT#");
}

TEST(Hdl64Status, LasersHave28ValuesAndAWarning) {
  const Hdl64Status status = status_of(PacketReturnMode::strongest);
  for (std::uint64_t laser = 0; laser < 63; ++laser) {
    const std::uint64_t group = 1 + 4 * laser;
    EXPECT_EQ(status.at(16 * group + 9, 0).value, laser);
    EXPECT_EQ(status.at(16 * (group + 3) + 9, 0).type, 'W');
  }
  // laser 0: -6.29 degrees, two's complement
  EXPECT_EQ(status.at(16 + 10, 0).value + 256 * status.at(16 + 11, 0).value, 65'536 - 629);
}

TEST(Hdl64Status, CorrectsDistancesByTheSameFarAndNear) {
  Sensor sensor = packet_sensor("HDL-64E-S3", false);
  std::get<Spinning>(sensor.optics).channels[0].distance_correction_m = 0.3;
  const Hdl64Status status(std::get<Spinning>(sensor.optics), PacketReturnMode::strongest, true);
  // values of the laser: seven per group, from the second group on
  const auto value = [&](std::uint64_t i) {
    return int{status.at(16 * (1 + i / 7) + 9 + i % 7, 0).value};
  };
  for (const std::uint64_t at : {5, 7, 9}) EXPECT_EQ(value(at) + 256 * value(at + 1), 300) << at;
}

TEST(Hdl64Status, StatesTheReturnsAndRepeats) {
  for (const auto& [mode, code] :
       {std::pair{PacketReturnMode::strongest, 0}, std::pair{PacketReturnMode::last, 1},
        std::pair{PacketReturnMode::dual, 2}}) {
    const Hdl64Status status = status_of(mode);
    const Hdl64Status::Entry entry = status.at(16 * 259 + 9 + 2, 0);
    EXPECT_EQ(entry.type, 0xF9);
    EXPECT_EQ(entry.value, code);
    EXPECT_EQ(status.at(Hdl64Status::kCycle + 13, 0).value, status.at(13, 0).value);
  }
}

}  // namespace
}  // namespace glidar::testing
