// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/link/socket.hpp>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "support/waiting.hpp"

#include <cerrno>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace glidar::testing {

/// What a peer of ZMTP 3.1 without encryption sends first (https://rfc.zeromq.org/spec/37).
inline std::string zmtp_greeting() {
  std::string text("\xff\0\0\0\0\0\0\0\0\x7f\3\1NULL", 16);
  text.resize(64, '\0');
  return text;
}

/// The command that completes its handshake.
inline std::string zmtp_ready(const std::string& socket_type) {
  const std::string body = std::string("\5READY\13Socket-Type\0\0\0", 21) +
                           static_cast<char>(socket_type.size()) + socket_type;
  return std::string("\4", 1) + static_cast<char>(body.size()) + body;
}

/// A TCP connection to a port of this machine that is not a ZeroMQ socket and sends arbitrary
/// bytes.
class RawPeer {
 public:
  explicit RawPeer(const link::Endpoint& at)
      : descriptor_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(at.port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    is_connected_ =
        ::connect(descriptor_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0;
  }
  RawPeer(RawPeer&& other) noexcept
      : descriptor_(std::exchange(other.descriptor_, -1)), is_connected_(other.is_connected_) {}
  RawPeer& operator=(RawPeer&&) = delete;
  ~RawPeer() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }

  [[nodiscard]] bool is_connected() const { return is_connected_; }
  /// False once the other side has closed the connection. Never blocks.
  bool send(const std::string& bytes) const {
    return ::send(descriptor_, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT) > 0;
  }
  /// Completes ZeroMQ's handshake. False when the other side closes the connection.
  bool shake(const std::string& socket_type) const {
    constexpr std::size_t kGreeting_bytes = 64;
    constexpr std::size_t kSizeAt = kGreeting_bytes + 1;  // of its READY, after the flags
    std::string received;
    const auto has = [&](std::size_t bytes) {
      return receive(received, bytes) && received.size() >= bytes;
    };
    if (!send(zmtp_greeting()) || !has(kGreeting_bytes)) return false;
    return send(zmtp_ready(socket_type)) && has(kSizeAt + 1) &&
           has(kSizeAt + 1 + static_cast<unsigned char>(received[kSizeAt]));
  }
  /// Whether the other side has closed the connection. What it sent is discarded. Never blocks.
  [[nodiscard]] bool is_closed() const {
    char bytes[4096];
    for (;;) {
      const ssize_t size = ::recv(descriptor_, bytes, sizeof(bytes), MSG_DONTWAIT);
      if (size == 0) return true;
      if (size < 0) return errno != EAGAIN && errno != EINTR;
    }
  }

 private:
  /// Waits until there are so many; false once the connection is closed.
  bool receive(std::string& received, std::size_t size) const {
    bool is_open = true;
    const auto is_done = [&] {
      char byte = 0;
      while (is_open && received.size() < size) {
        const ssize_t got = ::recv(descriptor_, &byte, 1, MSG_DONTWAIT);
        if (got < 0 && errno == EAGAIN) return false;
        is_open = got > 0;
        if (is_open) received += byte;
      }
      return true;
    };
    return soon(is_done) && is_open;
  }

  int descriptor_;
  bool is_connected_ = false;
};

/// A part of a message, of at most 255 bytes.
inline std::string zmtp_part(const std::string& body, bool has_more) {
  return std::string(1, has_more ? '\1' : '\0') + static_cast<char>(body.size()) + body;
}

/// Input of unknown peers and attackers: nothing, parts of handshakes and messages, other
/// protocols, random bytes.
struct Garbage {
  std::string socket_type;  ///< of the handshake; empty: none
  std::string bytes;
};

inline std::vector<Garbage> garbage() {
  std::vector<Garbage> all = {
      {"", ""},
      {"", std::string("\1\0\2\0a", 5)},  // ZMTP 1.0: no identity, a message without a delimiter
      {"", std::string("\1\0\1\1\2\0a", 7)},
      {"", std::string("\xff\0\0\0\0\0\0\0\0\x7f\1\3\0\0", 14)},  // ZMTP 2.0
      {"", zmtp_greeting().substr(0, 5)},
      {"", zmtp_greeting().substr(0, 32)},
      {"", zmtp_greeting() + zmtp_ready("REQ").substr(0, 7)},
      {"", zmtp_greeting() + zmtp_ready("PUB")},
      {"", "GET / HTTP/1.1\r\nHost: localhost\r\n\r\n"},
      {"", std::string(4096, '\xff')},
      {"REQ", ""},
      {"REQ", zmtp_part("", true)},
      {"REQ", zmtp_part("", true) + zmtp_part("GLDR", true)},
      {"REQ", zmtp_part("", true) + std::string("\2\x7f\xff\xff\xff\xff\xff\xff\xff", 9)},
      {"REQ", zmtp_part("x", false)},
      {"REQ", zmtp_part("", false)},
      {"DEALER", zmtp_part("no delimiter", false)},
      {"DEALER", std::string("\4\xff", 2)}};
  std::mt19937 chance(1);
  for (int k = 0; k < 8; ++k) {
    std::string bytes(std::size_t{1} << (k + 3), '\0');
    for (char& byte : bytes) byte = static_cast<char>(chance());
    all.push_back({k % 2 == 0 ? "" : "REQ", bytes});
  }
  return all;
}

/// A peer that has sent it.
inline RawPeer stranger(const link::Endpoint& at, const Garbage& garbage) {
  RawPeer peer(at);
  if (!garbage.socket_type.empty()) peer.shake(garbage.socket_type);
  peer.send(garbage.bytes);
  return peer;
}

}  // namespace glidar::testing
