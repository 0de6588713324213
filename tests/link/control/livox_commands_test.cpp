// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/control/livox_commands.hpp>

#include "control_fixture.hpp"

#include <glidar/core/error.hpp>
#include <glidar/io/packets/packet_bytes.hpp>

#include <gmock/gmock.h>

#include <algorithm>
#include <stdexcept>
#include <string>

namespace glidar::control {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

Bytes bytes_from(std::initializer_list<int> values) {
  Bytes bytes;
  for (const int value : values) bytes.push_back(static_cast<std::byte>(value));
  return bytes;
}

/// The letters before the first zero, which C programs print; fails without a zero.
std::string text_of(const Bytes& bytes) {
  const auto end = std::find(bytes.begin(), bytes.end(), std::byte{0});
  EXPECT_NE(end, bytes.end());
  std::string text;
  for (auto letter = bytes.begin(); letter != end; ++letter) text += static_cast<char>(*letter);
  return text;
}

struct Livox {
  testing::Destinations destinations;
  LivoxCommands commands{testing::livox_sensor(destinations)};

  Bytes ask(std::uint16_t id, const Bytes& data) {
    const auto answer =
        commands.answer(encode(LivoxCommand{7, id, false, false, data}), "127.0.0.1");
    if (!answer) throw std::runtime_error("no answer");
    const LivoxCommand read = decode_livox_command(*answer);
    EXPECT_EQ(read.sequence, 7U);
    EXPECT_EQ(read.id, id);
    EXPECT_TRUE(read.is_answer && read.is_from_sensor);
    return read.data;
  }
  /// Code and key of the answer to setting one parameter.
  std::pair<int, int> set(std::uint16_t key, const Bytes& value) {
    Bytes data = bytes_from({1, 0, 0, 0});
    put_little(data, key, 2);
    put_little(data, value.size(), 2);
    data.insert(data.end(), value.begin(), value.end());
    const Bytes answer = ask(0x0100, data);
    EXPECT_EQ(answer.size(), 3U);
    return {get<std::uint8_t>(answer, 0), get<std::uint16_t>(answer, 1)};
  }
};

TEST(LivoxCommand, HasTheBytesOfTheProtocol) {
  // a search as Livox SDK 2 broadcasts it
  const Bytes search = encode(LivoxCommand{1, 0, false, false, {}});
  EXPECT_EQ(search, bytes_from({0xAA, 0, 24, 0, 1, 0, 0,    0,    0, 0, 0, 0,
                                0,    0, 0,  0, 0, 0, 0xa9, 0x1f, 0, 0, 0, 0}));
}

TEST(LivoxCommand, RejectsEveryDamagedByte) {
  const Bytes good = encode(LivoxCommand{1, 0x0100, false, false, bytes_from({1, 2, 3})});
  EXPECT_NO_THROW(decode_livox_command(good));
  for (std::size_t i = 0; i < good.size(); ++i) {
    Bytes bad = good;
    bad[i] ^= std::byte{1};
    EXPECT_THROW(decode_livox_command(bad), Error) << i;
    EXPECT_THROW(decode_livox_command(std::span(good).first(i)), Error) << i;
  }
  EXPECT_THROW(decode_livox_command(Bytes(1401)), Error);
}

TEST(LivoxCommands, AnswerSearchesWithTypeSerialNumberAddressAndPort) {
  Livox livox;
  const auto answer = livox.commands.answer_search(encode(LivoxCommand{9, 0, false, false, {}}));
  if (!answer) FAIL() << "no answer";
  const LivoxCommand read = decode_livox_command(*answer);
  EXPECT_EQ(read.data.size(), 24U);
  EXPECT_EQ(Bytes(read.data.begin(), read.data.begin() + 2), bytes_from({0, 9}));
  const Bytes serial(read.data.begin() + 2, read.data.begin() + 18);
  EXPECT_EQ(text_of(serial), "GLIDAR000000001");
  EXPECT_EQ(Bytes(read.data.begin() + 18, read.data.end()), bytes_from({127, 0, 0, 2, 0x24, 0xdb}));
  EXPECT_FALSE(livox.commands.answer_search(*answer).has_value());
  EXPECT_FALSE(livox.commands.answer(*answer, "127.0.0.1").has_value());
}

TEST(LivoxCommands, TheSerialNumberEndsWithAZero) {
  Livox livox;
  const Bytes answer = livox.ask(0x0101, bytes_from({1, 0, 0, 0, 0, 0x80}));
  ASSERT_EQ(answer.size(), 3U + 4U + 16U);
  EXPECT_EQ(get<std::uint16_t>(answer, 3), 0x8000);
  EXPECT_EQ(text_of(Bytes(answer.begin() + 7, answer.end())), "GLIDAR000000001");
}

TEST(LivoxCommands, AnswerQueriesOfAllKeysOfTheMid360) {
  Livox livox;
  const std::vector<int> keys = {0x0000, 0x0001, 0x0004, 0x0005, 0x0006, 0x0007, 0x0012, 0x0015,
                                 0x0016, 0x0017, 0x0018, 0x0019, 0x001A, 0x001C, 0x8000, 0x8001,
                                 0x8002, 0x8003, 0x8004, 0x8005, 0x8006, 0x8007, 0x8008, 0x8009,
                                 0x800A, 0x800B, 0x800C, 0x800E, 0x8010, 0x8011};
  Bytes data;
  put_little(data, keys.size(), 2);
  put_little(data, 0, 2);
  for (const int key : keys) put_little(data, static_cast<std::uint64_t>(key), 2);
  const Bytes answer = livox.ask(0x0101, data);
  EXPECT_EQ(Bytes(answer.begin(), answer.begin() + 3), bytes_from({0, 30, 0}));
  std::size_t at = 3;
  for (const int key : keys) {
    EXPECT_EQ(get<std::uint16_t>(answer, at), key);
    const bool is_loader = key == 0x8010 && get<std::uint8_t>(answer, at + 4) != 1;
    EXPECT_FALSE(is_loader);
    at += 4U + get<std::uint16_t>(answer, at + 2);
  }
  EXPECT_EQ(at, answer.size());
  EXPECT_EQ(livox.ask(0x0101, bytes_from({1, 0, 0, 0, 0x34, 0x12}))[0], std::byte{0x20});
  EXPECT_EQ(livox.ask(0x0101, bytes_from({2, 0, 0, 0, 0, 0}))[0], std::byte{0x24});
  EXPECT_EQ(livox.ask(0x0101, {})[0], std::byte{0x24});
  EXPECT_EQ(livox.ask(0x0400, {}), bytes_from({1}));
}

TEST(LivoxCommands, ClientsChooseTheDestinationsOfPacketsButNotOthers) {
  Livox livox;
  const auto host = [](int last, int port_low) {
    return bytes_from({127, 0, 0, last, port_low, 0x10, 0xec, 0xdb});
  };
  EXPECT_EQ(livox.set(0x0006, host(1, 5)), std::pair(0, 0));
  Bytes imu = host(1, 6);
  imu[6] = std::byte{0x50};
  imu[7] = std::byte{0xdc};
  EXPECT_EQ(livox.set(0x0007, imu), std::pair(0, 0));
  EXPECT_THAT(livox.destinations.all(),
              ElementsAre("56301 to 127.0.0.1:4101", "56401 to 127.0.0.1:4102"));
  EXPECT_EQ(livox.set(0x0006, host(9, 5)), std::pair(3, 6));
  EXPECT_EQ(livox.set(0x0006, bytes_from({127, 0, 0, 1, 0, 0, 0xec, 0xdb})), std::pair(3, 6));
  EXPECT_EQ(livox.set(0x0006, bytes_from({127, 0, 0, 1, 5, 0x10, 1, 0})), std::pair(3, 6));
  EXPECT_EQ(livox.set(0x0006, bytes_from({127})), std::pair(0x23, 6));
  EXPECT_EQ(livox.destinations.all().size(), 2U);
}

TEST(LivoxCommands, AcceptTheSimulatedConfigurationOnly) {
  Livox livox;
  EXPECT_EQ(livox.set(0x001A, bytes_from({1})), std::pair(0, 0));
  EXPECT_EQ(livox.set(0x001A, bytes_from({2})), std::pair(3, 0x1A));
  EXPECT_EQ(livox.set(0x0000, bytes_from({1})), std::pair(0, 0));
  EXPECT_EQ(livox.set(0x0000, bytes_from({3})), std::pair(3, 0));
  EXPECT_EQ(livox.set(0x0012, Bytes(24)), std::pair(0, 0));
  EXPECT_EQ(livox.set(0x8000, Bytes(16)), std::pair(0x22, 0x8000));
  EXPECT_EQ(livox.set(0x1234, bytes_from({1})), std::pair(0x20, 0x1234));
  // a valid change is undone by an invalid one in the same command
  const Bytes both =
      bytes_from({2, 0, 0, 0, 6, 0, 8, 0, 127, 0, 0, 1, 5, 0x10, 0xec, 0xdb, 0x1A, 0, 1, 0, 2});
  EXPECT_EQ(livox.ask(0x0100, both), bytes_from({3, 0x1A, 0}));
  EXPECT_THAT(livox.destinations.all(), IsEmpty());
  EXPECT_EQ(livox.ask(0x0100, bytes_from({2, 0, 0, 0, 0x1A, 0, 1, 0, 1})),
            bytes_from({0x24, 0, 0}));
}

}  // namespace
}  // namespace glidar::control
