// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/link/control/conversation.hpp>

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace glidar::control {

/// A command or an answer of Livox SDK 2 (sdk_core/comm/sdk_protocol.cpp).
struct LivoxCommand {
  std::uint32_t sequence = 0;
  std::uint16_t id = 0;
  bool is_answer = false;
  bool is_from_sensor = false;
  std::vector<std::byte> data;
};

inline constexpr std::size_t kMaxLivoxCommand = 1400;  ///< bytes, kMaxCommandBufferSize

std::vector<std::byte> encode(const LivoxCommand& command);
/// Throws Error for another start, version or length, and wrong checksums.
LivoxCommand decode_livox_command(std::span<const std::byte> payload);

/// What a Livox sensor states of itself.
struct LivoxSensor {
  std::string address = "127.0.0.2";  ///< IPv4, of the sensor
  std::uint16_t command_port = 56100;
  std::uint8_t data_type = 1;             ///< of points
  std::string destination = "127.0.0.1";  ///< IPv4, of the receiver at the start
  std::uint16_t point_port = 56301;       ///< of the receiver at the start
  std::uint16_t imu_port = 56401;         ///< of the receiver at the start
  DestinationRule destinations = {};
  DestinationCallback on_destination = {};
};

/// The commands of Livox SDK 2 by which its clients find a Mid-360, read its parameters and set
/// them. Only the destinations of packets can be changed; other values must be those that are
/// simulated. Not thread-safe.
class LivoxCommands {
 public:
  explicit LivoxCommands(const LivoxSensor& sensor);

  /// The answer to a search, which is broadcast to port 56000; none to other commands. Throws Error
  /// when it is malformed.
  [[nodiscard]] std::optional<std::vector<std::byte>> answer_search(
      std::span<const std::byte> payload) const;
  /// The answer to a command to the port of commands; none to answers. Throws Error when it is
  /// malformed.
  std::optional<std::vector<std::byte>> answer(std::span<const std::byte> payload,
                                               const std::string& client);

 private:
  [[nodiscard]] std::vector<std::byte> query(std::span<const std::byte> data) const;
  std::vector<std::byte> configure(std::span<const std::byte> data, const std::string& client);
  [[nodiscard]] std::uint8_t check(std::uint16_t key, std::span<const std::byte> value,
                                   const std::string& client) const;
  void apply(std::uint16_t key, std::span<const std::byte> value);

  LivoxSensor sensor_;
  std::map<std::uint16_t, std::vector<std::byte>> values_;  ///< by key
};

}  // namespace glidar::control
