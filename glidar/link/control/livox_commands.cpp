// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/control/livox_commands.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/packets/livox.hpp>
#include <glidar/io/packets/packet_bytes.hpp>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

namespace glidar::control {
namespace {

constexpr std::size_t kCommandHead = 24;
constexpr std::size_t kHeadChecksumAt = 18;
constexpr std::uint8_t kCommandMark = 0xAA;
constexpr std::uint8_t kMid360 = 9;                            // kLivoxLidarTypeMid360
constexpr std::string_view kSerialNumber = "GLIDAR000000001";  // 15 letters: text ends with a zero
constexpr std::size_t kMaxKeys = 64;

// Ids of commands and keys of parameters (livox_lidar_def.h).
constexpr std::uint16_t kSearch = 0x0000;
constexpr std::uint16_t kConfigure = 0x0100;
constexpr std::uint16_t kQuery = 0x0101;
constexpr std::uint16_t kStateDestination = 0x0005;
constexpr std::uint16_t kPointDestination = 0x0006;
constexpr std::uint16_t kImuDestination = 0x0007;
constexpr std::uint16_t kFirstReadOnly = 0x8000;

// Results of commands (Livox SDK 2 wiki, "Return Code Description").
constexpr std::uint8_t kLivoxSuccess = 0x00;
constexpr std::uint8_t kLivoxFailure = 0x01;
constexpr std::uint8_t kOutOfRange = 0x03;
constexpr std::uint8_t kUnknownKey = 0x20;
constexpr std::uint8_t kReadOnlyKey = 0x22;
constexpr std::uint8_t kWrongLength = 0x23;
constexpr std::uint8_t kWrongNumberOfKeys = 0x24;

/// CRC-16/CCITT-FALSE.
std::uint16_t crc16(ByteView bytes) {
  std::uint32_t crc = 0xFFFF;
  for (const std::byte byte : bytes) {
    crc ^= std::to_integer<std::uint32_t>(byte) << 8U;
    for (int bit = 0; bit < 8; ++bit)
      crc = ((crc << 1U) ^ ((crc & 0x8000U) != 0 ? 0x1021U : 0U)) & 0xFFFFU;
  }
  return static_cast<std::uint16_t>(crc);
}

std::uint32_t data_checksum(ByteView data) {
  return data.empty() ? 0 : livox_crc32(data);
}

Bytes address_bytes(const std::string& address) {
  const std::array<std::byte, 4> parts = ipv4_bytes(address);
  return {parts.begin(), parts.end()};
}

Bytes number_value(std::uint64_t value, std::size_t size) {
  Bytes bytes;
  put_little(bytes, value, size);
  return bytes;
}

Bytes text_value(std::string_view text, std::size_t size) {
  Bytes bytes;
  for (const char letter : text) bytes.push_back(static_cast<std::byte>(letter));
  bytes.resize(size);
  return bytes;
}

/// Address, port of the host, port of the sensor.
Bytes destination_value(const std::string& address, std::uint16_t port, std::uint16_t sensor_port) {
  Bytes bytes = address_bytes(address);
  put_little(bytes, port, 2);
  put_little(bytes, sensor_port, 2);
  return bytes;
}

/// The keys of the Mid-360 (general_command_handler.cpp, GetQueryLidarInternalInfoKeys).
std::map<std::uint16_t, Bytes> mid360_values(const LivoxSensor& sensor) {
  Bytes network = address_bytes(sensor.address);
  for (const char* part : {"255.0.0.0", "0.0.0.0"}) {
    const Bytes bytes = address_bytes(part);
    network.insert(network.end(), bytes.begin(), bytes.end());
  }
  return {
      {0x0000, number_value(sensor.data_type, 1)},
      {0x0001, number_value(0, 1)},  // the pattern does not repeat
      {0x0004, network},
      {kStateDestination, destination_value(sensor.destination, 56201, 56200)},
      {kPointDestination,
       destination_value(sensor.destination, sensor.point_port, kLivoxPointSourcePort)},
      {kImuDestination,
       destination_value(sensor.destination, sensor.imu_port, kLivoxImuSourcePort)},
      {0x0012, number_value(0, 24)},  // installed without rotation
      {0x0015, number_value(0, 20)},  // fields of view, unused
      {0x0016, number_value(0, 20)},
      {0x0017, number_value(0, 1)},
      {0x0018, number_value(0, 1)},  // detection: normal
      {0x0019, number_value(0, 4)},  // inputs and outputs
      {0x001A, number_value(1, 1)},  // samples
      {0x001C, number_value(1, 1)},  // sends the IMU
      {0x8000, text_value(kSerialNumber, 16)},
      {0x8001, text_value("GLIDAR, simulated", 64)},
      {0x8002, number_value(1, 4)},  // versions
      {0x8003, number_value(1, 4)},
      {0x8004, number_value(1, 4)},
      {0x8005, number_value(0x02, 6)},  // MAC, locally administered
      {0x8006, number_value(1, 1)},     // samples
      {0x8007, number_value(2500, 4)},  // 25 degrees Celsius
      {0x8008, number_value(1, 4)},     // starts
      {0x8009, number_value(0, 8)},     // times
      {0x800A, number_value(0, 8)},
      {0x800B, number_value(0, 8)},
      {0x800C, number_value(1, 1)},  // synchronised by PTP
      {0x800E, number_value(0, 2)},  // no error
      {0x8010, number_value(1, 1)},  // the application runs, not the loader
      {0x8011, number_value(0, 32)},
  };
}

/// Puts together what configures and queries answer with.
Bytes result_of(std::uint8_t code, std::uint16_t key) {
  Bytes bytes = number_value(code, 1);
  put_little(bytes, key, 2);
  return bytes;
}

}  // namespace

std::vector<std::byte> encode(const LivoxCommand& command) {
  Bytes bytes = {std::byte{kCommandMark}, std::byte{0}};
  put_little(bytes, kCommandHead + command.data.size(), 2);
  put_little(bytes, command.sequence, 4);
  put_little(bytes, command.id, 2);
  put_little(bytes, command.is_answer ? 1 : 0, 1);
  put_little(bytes, command.is_from_sensor ? 1 : 0, 1);
  put_zeros(bytes, 6);
  put_little(bytes, crc16(bytes), 2);
  put_little(bytes, data_checksum(command.data), 4);
  bytes.insert(bytes.end(), command.data.begin(), command.data.end());
  return bytes;
}

LivoxCommand decode_livox_command(std::span<const std::byte> payload) {
  const auto fail = [](const char* found, const char* allowed) {
    throw Error({"Livox command", found, allowed});
  };
  if (payload.size() < kCommandHead || payload.size() > kMaxLivoxCommand)
    fail("another length", "24 to 1400 bytes");
  if (get<std::uint8_t>(payload, 0) != kCommandMark || get<std::uint8_t>(payload, 1) != 0)
    fail("another start", "AA 00");
  if (get<std::uint16_t>(payload, 2) != payload.size())
    fail("a length that is not that of the packet", "");
  const ByteView data = payload.subspan(kCommandHead);
  if (get<std::uint16_t>(payload, kHeadChecksumAt) != crc16(payload.first(kHeadChecksumAt)) ||
      get<std::uint32_t>(payload, kHeadChecksumAt + 2) != data_checksum(data))
    fail("a wrong checksum", "");
  return {get<std::uint32_t>(payload, 4), get<std::uint16_t>(payload, 8),
          get<std::uint8_t>(payload, 10) != 0, get<std::uint8_t>(payload, 11) != 0,
          Bytes(data.begin(), data.end())};
}

LivoxCommands::LivoxCommands(const LivoxSensor& sensor)
    : sensor_(sensor), values_(mid360_values(sensor)) {}

std::optional<std::vector<std::byte>> LivoxCommands::answer_search(
    std::span<const std::byte> payload) const {
  const LivoxCommand command = decode_livox_command(payload);
  if (command.is_answer || command.is_from_sensor || command.id != kSearch) return std::nullopt;
  Bytes data = {std::byte{kLivoxSuccess}, std::byte{kMid360}};
  for (const Bytes& part : {text_value(kSerialNumber, 16), address_bytes(sensor_.address)})
    data.insert(data.end(), part.begin(), part.end());
  put_little(data, sensor_.command_port, 2);
  return encode(LivoxCommand{command.sequence, kSearch, true, true, data});
}

std::optional<std::vector<std::byte>> LivoxCommands::answer(std::span<const std::byte> payload,
                                                            const std::string& client) {
  const LivoxCommand command = decode_livox_command(payload);
  if (command.is_answer || command.is_from_sensor) return std::nullopt;
  LivoxCommand answer{command.sequence, command.id, true, true, {std::byte{kLivoxFailure}}};
  if (command.id == kConfigure) answer.data = configure(command.data, client);
  if (command.id == kQuery) answer.data = query(command.data);
  return encode(answer);
}

/// Number of keys, 2 bytes, keys; the answer has the values.
std::vector<std::byte> LivoxCommands::query(std::span<const std::byte> data) const {
  const std::size_t count = data.size() < 4 ? 0 : get<std::uint16_t>(data, 0);
  if (count == 0 || count > kMaxKeys || data.size() < 4 + 2 * count)
    return result_of(kWrongNumberOfKeys, 0);
  Bytes bytes = result_of(kLivoxSuccess, static_cast<std::uint16_t>(count));
  for (std::size_t i = 0; i < count; ++i) {
    const auto key = get<std::uint16_t>(data, 4 + 2 * i);
    const auto value = values_.find(key);
    if (value == values_.end()) return result_of(kUnknownKey, 0);
    put_little(bytes, key, 2);
    put_little(bytes, value->second.size(), 2);
    bytes.insert(bytes.end(), value->second.begin(), value->second.end());
  }
  if (bytes.size() + kCommandHead > kMaxLivoxCommand) return result_of(kWrongNumberOfKeys, 0);
  return bytes;
}

/// Number of keys, 2 bytes; for each: key, length, value. Nothing changes unless all are valid.
std::vector<std::byte> LivoxCommands::configure(std::span<const std::byte> data,
                                                const std::string& client) {
  const std::size_t count = data.size() < 4 ? 0 : get<std::uint16_t>(data, 0);
  if (count == 0 || count > kMaxKeys) return result_of(kWrongNumberOfKeys, 0);
  std::vector<std::pair<std::uint16_t, ByteView>> changes;
  std::size_t at = 4;
  for (std::size_t i = 0; i < count; ++i) {
    if (data.size() < at + 4) return result_of(kWrongNumberOfKeys, 0);
    const auto key = get<std::uint16_t>(data, at);
    const std::size_t size = get<std::uint16_t>(data, at + 2);
    if (data.size() < at + 4 + size) return result_of(kWrongLength, key);
    changes.emplace_back(key, data.subspan(at + 4, size));
    if (const std::uint8_t code = check(key, changes.back().second, client); code != kLivoxSuccess)
      return result_of(code, key);
    at += 4 + size;
  }
  for (const auto& [key, value] : changes) apply(key, value);
  return result_of(kLivoxSuccess, 0);
}

std::uint8_t LivoxCommands::check(std::uint16_t key, std::span<const std::byte> value,
                                  const std::string& client) const {
  const auto known = values_.find(key);
  if (known == values_.end()) return kUnknownKey;
  if (key >= kFirstReadOnly) return kReadOnlyKey;
  if (value.size() != known->second.size()) return kWrongLength;
  if (std::equal(value.begin(), value.end(), known->second.begin())) return kLivoxSuccess;
  if (key < kStateDestination || key > kImuDestination) return kOutOfRange;
  const bool has_port = get<std::uint16_t>(value, 4) != 0;
  const bool may_go = sensor_.destinations.allows(ipv4_text(value), client);
  const bool is_source = get<std::uint16_t>(value, 6) == get<std::uint16_t>(known->second, 6);
  return has_port && may_go && is_source ? kLivoxSuccess : kOutOfRange;
}

void LivoxCommands::apply(std::uint16_t key, std::span<const std::byte> value) {
  values_[key].assign(value.begin(), value.end());
  const bool is_points = key == kPointDestination;
  if ((!is_points && key != kImuDestination) || !sensor_.on_destination) return;
  sensor_.on_destination({is_points ? kLivoxPointPort : kLivoxImuPort, ipv4_text(value),
                          get<std::uint16_t>(value, 4)});
}

}  // namespace glidar::control
