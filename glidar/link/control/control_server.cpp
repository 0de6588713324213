// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/control/control_server.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/files/unique_fd.hpp>
#include <glidar/io/packets/packet_bytes.hpp>
#include <glidar/link/control/livox_commands.hpp>
#include <glidar/link/control/tcp_service.hpp>
#include <glidar/link/udp/packet_sender.hpp>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

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

namespace {

/// Answers the commands of Livox SDK 2, see serve_livox().
class UdpResponder final : public ControlServer {
 public:
  /// Throws Error if a port is in use.
  UdpResponder(const LivoxSensor& sensor, std::uint16_t command_port, std::uint16_t search_port,
               link::ErrorLog& errors);
  ~UdpResponder() override;
  UdpResponder(const UdpResponder&) = delete;
  UdpResponder& operator=(const UdpResponder&) = delete;

  [[nodiscard]] std::uint16_t port() const override { return port_; }

 private:
  void run();
  void receive(const UniqueFd& from);
  [[nodiscard]] bool may_answer();
  [[nodiscard]] bool is_heard(const std::string& client) const;

  link::ErrorLog& errors_;
  bool is_loopback_;
  UniqueFd commands_socket_;
  UniqueFd search_;     ///< answers to searches are sent from here
  UniqueFd broadcast_;  ///< searches that are broadcast
  UniqueFd stop_;
  std::uint16_t port_;
  LivoxCommands commands_;
  std::chrono::steady_clock::time_point second_;
  int answers_ = 0;  ///< in this second
  std::thread thread_;
};

constexpr const char* kResponder = "commands of the sensor";
constexpr int kMaxAnswersPerSecond = 500;  // senders of UDP can be forged

/// A socket at this address and port. Throws Error.
UniqueFd bound_socket(const std::string& address, std::uint16_t port, bool is_shared) {
  UniqueFd made(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  const int on = is_shared ? 1 : 0;
  sockaddr_in at{};
  at.sin_family = AF_INET;
  at.sin_port = htons(port);
  at.sin_addr.s_addr = ::inet_addr(address.c_str());
  if (made.get() < 0 || ::setsockopt(made.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on) != 0 ||
      ::bind(made.get(), reinterpret_cast<const sockaddr*>(&at), sizeof at) != 0) {
    link::fail_at({.host = address, .port = port}, errno, "listen");
  }
  return made;
}

std::uint16_t port_of(const UniqueFd& descriptor) {
  sockaddr_in at{};
  socklen_t size = sizeof at;
  ::getsockname(descriptor.get(), reinterpret_cast<sockaddr*>(&at), &size);
  return ntohs(at.sin_port);
}

std::string client_text(const sockaddr_in& from) {
  std::array<char, INET_ADDRSTRLEN> text{};
  return ::inet_ntop(AF_INET, &from.sin_addr, text.data(), text.size());
}

LivoxSensor with_port(LivoxSensor sensor, std::uint16_t port) {
  sensor.command_port = port;
  return sensor;
}

UdpResponder::UdpResponder(const LivoxSensor& sensor, std::uint16_t command_port,
                           std::uint16_t search_port, link::ErrorLog& errors)
    : errors_(errors),
      is_loopback_(sensor.address.starts_with("127.")),
      commands_socket_(bound_socket(sensor.address, command_port, false)),
      search_(bound_socket(sensor.address, search_port, false)),
      broadcast_(bound_socket("255.255.255.255", port_of(search_), true)),
      stop_(::eventfd(0, EFD_CLOEXEC)),
      port_(port_of(commands_socket_)),
      commands_(with_port(sensor, port_)),
      second_(std::chrono::steady_clock::now()),
      thread_([this] { run(); }) {}

UdpResponder::~UdpResponder() {
  ::eventfd_write(stop_.get(), 1);
  thread_.join();
}

void UdpResponder::run() {
  for (;;) {
    std::array<pollfd, 4> waiting = {{{stop_.get(), POLLIN, 0},
                                      {commands_socket_.get(), POLLIN, 0},
                                      {search_.get(), POLLIN, 0},
                                      {broadcast_.get(), POLLIN, 0}}};
    if (::poll(waiting.data(), waiting.size(), -1) < 0 && errno != EINTR) return;
    if ((waiting[0].revents & POLLIN) != 0) return;
    if ((waiting[1].revents & POLLIN) != 0) receive(commands_socket_);
    if ((waiting[2].revents & POLLIN) != 0) receive(search_);
    if ((waiting[3].revents & POLLIN) != 0) receive(broadcast_);
  }
}

/// One datagram, which is answered from the sensor's address.
void UdpResponder::receive(const UniqueFd& from) {
  std::vector<std::byte> bytes(kMaxLivoxCommand + 1);
  sockaddr_in sender{};
  socklen_t size = sizeof sender;
  const ssize_t got = ::recvfrom(from.get(), bytes.data(), bytes.size(), MSG_DONTWAIT,
                                 reinterpret_cast<sockaddr*>(&sender), &size);
  if (got < 0) return;  // an earlier answer could not be delivered
  bytes.resize(static_cast<std::size_t>(got));
  const std::string client = client_text(sender);
  if (!is_heard(client)) return;
  const bool is_command = &from == &commands_socket_;
  try {
    const std::optional<std::vector<std::byte>> answer =
        is_command ? commands_.answer(bytes, client) : commands_.answer_search(bytes);
    if (!answer || !may_answer()) return;
    const int out = is_command ? commands_socket_.get() : search_.get();
    if (::sendto(out, answer->data(), answer->size(), MSG_DONTWAIT,
                 reinterpret_cast<const sockaddr*>(&sender), size) < 0)
      errors_.report(kResponder, "an answer could not be sent");
  } catch (const std::exception& error) {
    errors_.report(kResponder, error.what());
  }
}

bool UdpResponder::is_heard(const std::string& client) const {
  return !is_loopback_ || client.starts_with("127.");
}

bool UdpResponder::may_answer() {
  const auto now = std::chrono::steady_clock::now();
  if (now - second_ >= std::chrono::seconds(1)) {
    second_ = now;
    answers_ = 0;
  }
  if (++answers_ <= kMaxAnswersPerSecond) return true;
  errors_.report(kResponder, "more than 500 commands in a second");
  return false;
}

class OusterServer final : public ControlServer {
 public:
  OusterServer(const OusterApiOptions& sensor, const link::Endpoint& at, link::ErrorLog& errors)
      : api_(sensor),
        guard_(access_rules(at), link::HttpClients::programs, sensor_http_limits()),
        service_(
            {.at = at,
             .what = "HTTP of the sensor",
             .connections = guard_.limits().connections,
             .request = guard_.limits().request,
             .idle = guard_.limits().request},
            [this](const std::string& client) {
              return make_http_conversation(api_, guard_, client);
            },
            errors) {}
  [[nodiscard]] std::uint16_t port() const override { return service_.port(); }

 private:
  /// Requests may address the server by the host name that --control specifies.
  static link::AccessRules access_rules(const link::Endpoint& at) {
    link::AccessRules rules{.origins = {}, .hosts = {}};
    if (at.host != "*") rules.hosts.push_back(at.host);
    return rules;
  }

  OusterApi api_;
  link::HttpGuard guard_;  // used in the service's thread
  TcpService service_;
};

class HesaiServer final : public ControlServer {
 public:
  HesaiServer(const PtcSensor& sensor, const link::Endpoint& at, link::ErrorLog& errors)
      : commands_(sensor),
        service_(
            {.at = at, .what = "PTC of the sensor"},
            [this](const std::string& client) { return make_ptc_conversation(commands_, client); },
            errors) {}
  [[nodiscard]] std::uint16_t port() const override { return service_.port(); }

 private:
  PtcCommands commands_;
  TcpService service_;
};

}  // namespace

std::unique_ptr<ControlServer> serve_ouster(const OusterApiOptions& sensor,
                                            const link::Endpoint& at, link::ErrorLog& errors) {
  return std::make_unique<OusterServer>(sensor, at, errors);
}

std::unique_ptr<ControlServer> serve_hesai(const PtcSensor& sensor, const link::Endpoint& at,
                                           link::ErrorLog& errors) {
  return std::make_unique<HesaiServer>(sensor, at, errors);
}

std::unique_ptr<ControlServer> serve_livox(LivoxSensor sensor, const link::Endpoint& at,
                                           link::ErrorLog& errors, std::uint16_t search_port) {
  sensor.address = link::ipv4_text(link::resolve_udp_address(at.host, at.port));
  if (sensor.address == "0.0.0.0")
    throw Error({"address of the sensor", "all addresses of this machine", "one address",
                 "give the one that clients use"});
  return std::make_unique<UdpResponder>(sensor, at.port, search_port, errors);
}

}  // namespace glidar::control
