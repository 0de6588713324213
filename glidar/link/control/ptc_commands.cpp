// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/control/ptc_commands.hpp>

#include <glidar/io/packets/packet_bytes.hpp>

#include <algorithm>
#include <array>
#include <utility>

namespace glidar::control {
namespace {

constexpr std::uint8_t kPtcFirst = 0x47;
constexpr std::uint8_t kPtcSecond = 0x74;
constexpr std::size_t kPtcHead = 8;
constexpr std::size_t kMaxPtcPayload = 1024;
constexpr std::uint16_t kWholeRange = 3600;  // 0.1 degrees

// Commands (tier4/nebula, hesai_hw_interface.hpp).
enum PtcCommand : std::uint8_t {
  kGetCalibration = 0x05,
  kGetInventory = 0x07,
  kGetConfig = 0x08,
  kGetStatus = 0x09,
  kSetSpinRate = 0x17,
  kSetReturnMode = 0x1e,
  kSetDestination = 0x20,
  kSetRange = 0x22,
  kGetRange = 0x23,
};

/// A text in a field of this size, filled with zeros.
void put_text(Bytes& bytes, std::string_view text, std::size_t size) {
  const std::size_t shown = std::min(text.size(), size);
  for (std::size_t i = 0; i < size; ++i)
    bytes.push_back(i < shown ? static_cast<std::byte>(text[i]) : std::byte{0});
}

void put_ipv4(Bytes& bytes, const std::string& address) {
  const std::array<std::byte, 4> parts = ipv4_bytes(address);
  bytes.insert(bytes.end(), parts.begin(), parts.end());
}

Bytes bytes_of(std::string_view text) {
  const auto* begin = reinterpret_cast<const std::byte*>(text.data());
  return {begin, begin + text.size()};
}

Bytes whole_range() {
  Bytes bytes;
  put_big(bytes, 0, 3);  // one range, from 0
  put_big(bytes, kWholeRange, 2);
  return bytes;
}

/// Success if a value is the one that is simulated.
PtcReply accept_if(bool is_simulated) {
  return {is_simulated ? PtcResult::success : PtcResult::invalid_parameter, {}};
}

std::string ptc_text(std::uint8_t command, const PtcReply& reply) {
  Bytes bytes = {std::byte{kPtcFirst}, std::byte{kPtcSecond}, std::byte{command},
                 static_cast<std::byte>(reply.result)};
  put_big(bytes, reply.payload.size(), 4);
  bytes.insert(bytes.end(), reply.payload.begin(), reply.payload.end());
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

class PtcConversation final : public Conversation {
 public:
  PtcConversation(PtcCommands& commands, std::string client)
      : commands_(commands), client_(std::move(client)) {}

  Step receive(std::string_view text) override {
    const ByteView bytes = std::as_bytes(std::span(text));
    constexpr std::array<std::uint8_t, 2> kStart = {kPtcFirst, kPtcSecond};
    for (std::size_t i = 0; i < std::min(bytes.size(), kStart.size()); ++i) {
      if (get<std::uint8_t>(bytes, i) != kStart[i])
        return {.consumed = bytes.size(), .ends = true, .error = "no PTC request: 47 74"};
    }
    if (bytes.size() < kPtcHead) return {};
    const auto command = get<std::uint8_t>(bytes, 2);
    const std::size_t size = get_big(bytes, 4, 4);
    if (size > kMaxPtcPayload)
      return {.consumed = bytes.size(),
              .answer = ptc_text(command, {PtcResult::invalid_data, {}}),
              .ends = true,
              .error = "a payload above 1024 bytes"};
    if (bytes.size() < kPtcHead + size) return {};
    const PtcReply reply = commands_.answer(command, bytes.subspan(kPtcHead, size), client_);
    return {.consumed = kPtcHead + size, .answer = ptc_text(command, reply)};
  }

 private:
  PtcCommands& commands_;
  std::string client_;
};

}  // namespace

PtcCommands::PtcCommands(const PtcSensor& sensor) : sensor_(sensor) {}

PtcReply PtcCommands::answer(std::uint8_t command, std::span<const std::byte> payload,
                             const std::string& client) {
  switch (command) {
    case kGetCalibration:
      return {PtcResult::success, bytes_of(sensor_.calibration)};
    case kGetInventory:
      return {PtcResult::success, inventory()};
    case kGetConfig:
      return {PtcResult::success, config()};
    case kGetStatus:
      return {PtcResult::success, status()};
    case kGetRange:
      return {PtcResult::success, whole_range()};
    case kSetSpinRate:
      return accept_if(payload.size() == 2 && get_big(payload, 0, 2) == sensor_.spin_rate_rpm);
    case kSetReturnMode:
      return accept_if(payload.size() == 1 && get<std::uint8_t>(payload, 0) == sensor_.return_mode);
    case kSetRange: {
      const Bytes whole = whole_range();
      return accept_if(std::equal(payload.begin(), payload.end(), whole.begin(), whole.end()));
    }
    case kSetDestination:
      return set_destination(payload, client);
    default:
      return {PtcResult::unsupported, {}};
  }
}

/// 120 bytes: HesaiInventory_XT16_32_40P of tier4/nebula, hesai_cmd_response.hpp.
std::vector<std::byte> PtcCommands::inventory() const {
  Bytes bytes;
  put_text(bytes, "GLIDAR", 18);      // serial number
  put_text(bytes, "2024-01-01", 16);  // of manufacture
  put_big(bytes, 0x020000000002, 6);  // MAC, locally administered
  for (int version = 0; version < 4; ++version) put_text(bytes, "1.0.0", 16);
  put_big(bytes, 0, 2);  // angle offset
  put_big(bytes, sensor_.model, 1);
  put_big(bytes, 0, 1);  // motor: one direction
  put_big(bytes, sensor_.channels, 1);
  put_zeros(bytes, 11);
  return bytes;
}

/// 47 bytes: HesaiConfig_XT_40P_64_QT128 of tier4/nebula, hesai_cmd_response.hpp.
std::vector<std::byte> PtcCommands::config() const {
  Bytes bytes;
  put_ipv4(bytes, sensor_.address);
  put_ipv4(bytes, "255.0.0.0");
  put_ipv4(bytes, "0.0.0.0");
  put_ipv4(bytes, sensor_.destination);
  put_big(bytes, sensor_.destination_port, 2);
  put_big(bytes, 10'110, 2);  // port of GPS, unused
  put_big(bytes, sensor_.spin_rate_rpm, 2);
  put_big(bytes, 0, 1);  // no synchronised angle
  put_big(bytes, 0, 2);
  put_big(bytes, 0, 2);  // start angle
  put_big(bytes, kWholeRange, 2);
  put_big(bytes, 1, 1);  // clock: PTP
  put_big(bytes, 1, 1);  // packets have sequence numbers
  put_big(bytes, 0, 1);  // triggered by angle
  put_big(bytes, sensor_.return_mode, 1);
  put_big(bytes, 0, 1);  // in operation
  put_big(bytes, 0, 1);  // motor
  put_big(bytes, 0, 3);  // no VLAN
  put_zeros(bytes, 9);
  return bytes;
}

/// 54 bytes: HesaiLidarStatus_XT_40p of tier4/nebula, hesai_cmd_response.hpp.
std::vector<std::byte> PtcCommands::status() const {
  const auto uptime =
      std::chrono::duration_cast<std::chrono::seconds>(std::chrono::steady_clock::now() - start_);
  Bytes bytes;
  put_big(bytes, static_cast<std::uint64_t>(uptime.count()), 4);
  put_big(bytes, sensor_.spin_rate_rpm, 2);
  for (int i = 0; i < 8; ++i) put_big(bytes, 2500, 4);  // temperatures: 25 degrees Celsius
  put_big(bytes, 0, 2);                                 // no PPS, no GPRMC
  put_big(bytes, 1, 4);                                 // starts
  put_big(bytes, static_cast<std::uint64_t>(uptime.count() / 60), 4);
  put_big(bytes, 2, 1);  // PTP is locked
  put_zeros(bytes, 5);
  return bytes;
}

/// IPv4 address, port of data and port of GPS.
PtcReply PtcCommands::set_destination(std::span<const std::byte> payload,
                                      const std::string& client) {
  if (payload.size() != 8) return {PtcResult::invalid_data, {}};
  const std::string address = ipv4_text(payload);
  const auto port = static_cast<std::uint16_t>(get_big(payload, 4, 2));
  if (port == 0 || !sensor_.destinations.allows(address, client)) return accept_if(false);
  sensor_.destination = address;
  sensor_.destination_port = port;
  if (sensor_.on_destination) sensor_.on_destination({sensor_.packet_port, address, port});
  return {};
}

std::unique_ptr<Conversation> make_ptc_conversation(PtcCommands& commands,
                                                    const std::string& client) {
  return std::make_unique<PtcConversation>(commands, client);
}

}  // namespace glidar::control
