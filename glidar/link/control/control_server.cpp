// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/control/control_server.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/files/unique_fd.hpp>
#include <glidar/link/control/http_conversation.hpp>
#include <glidar/link/control/livox_commands.hpp>
#include <glidar/link/control/tcp_service.hpp>
#include <glidar/link/udp/packet_sender.hpp>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>

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
