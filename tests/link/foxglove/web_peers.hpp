// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include "support/waiting.hpp"

#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace glidar::testing {

/// A blocking TCP connection to a port of this machine, which shares no code with the server.
/// Throws when the other side has closed it.
class TcpPeer {
 public:
  explicit TcpPeer(std::uint16_t port, int receive_buffer_bytes = 0)
      : descriptor_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    const timeval wait{.tv_sec = std::chrono::seconds(kMaxWait).count(), .tv_usec = 0};
    ::setsockopt(descriptor_, SOL_SOCKET, SO_RCVTIMEO, &wait, sizeof(wait));
    ::setsockopt(descriptor_, SOL_SOCKET, SO_SNDTIMEO, &wait, sizeof(wait));
    if (receive_buffer_bytes > 0) {
      ::setsockopt(descriptor_, SOL_SOCKET, SO_RCVBUF, &receive_buffer_bytes, sizeof(int));
    }
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (::connect(descriptor_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0) {
      throw std::runtime_error("cannot connect");
    }
  }
  TcpPeer(TcpPeer&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
  TcpPeer& operator=(TcpPeer&&) = delete;
  ~TcpPeer() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }

  /// False once the other side has closed the connection.
  bool send(std::string_view bytes) const {
    while (!bytes.empty()) {
      const ssize_t sent = ::send(descriptor_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (sent <= 0) return false;
      bytes.remove_prefix(static_cast<std::size_t>(sent));
    }
    return true;
  }
  void finish() const { ::shutdown(descriptor_, SHUT_WR); }
  std::string receive(std::size_t size) const {
    std::string bytes(size, '\0');
    for (std::size_t done = 0; done < size;) {
      const ssize_t got = ::recv(descriptor_, bytes.data() + done, size - done, 0);
      if (got <= 0) throw std::runtime_error("closed");
      done += static_cast<std::size_t>(got);
    }
    return bytes;
  }
  /// Everything until the other side closes the connection.
  std::string receive_all() const {
    std::string bytes;
    char buffer[4096];
    for (ssize_t got = 0; (got = ::recv(descriptor_, buffer, sizeof(buffer), 0)) > 0;) {
      bytes.append(buffer, static_cast<std::size_t>(got));
    }
    return bytes;
  }

 private:
  int descriptor_;
};

/// The answer to an HTTP request, with its head.
inline std::string http_answer(std::uint16_t port, const std::string& request) {
  const TcpPeer peer(port);
  peer.send(request);
  return peer.receive_all();
}

inline std::string get_request(const std::string& target, const std::string& host = "localhost") {
  return "GET " + target + " HTTP/1.1\r\nHost: " + host + "\r\n\r\n";
}

inline std::string post_request(const std::string& target, const std::string& body,
                                const std::string& origin, const std::string& host) {
  return "POST " + target + " HTTP/1.1\r\nHost: " + host + "\r\nOrigin: " + origin +
         "\r\nContent-Type: application/json\r\nContent-Length: " + std::to_string(body.size()) +
         "\r\n\r\n" + body;
}

/// The handshake of RFC 6455, section 1.3, with its example key.
inline std::string upgrade_request(const std::string& more_headers = {},
                                   const std::string& protocols = "foxglove.websocket.v1",
                                   const std::string& host = "127.0.0.1") {
  return "GET / HTTP/1.1\r\nHost: " + host +
         "\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
         "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n"
         "Sec-WebSocket-Protocol: " +
         protocols + "\r\n" + more_headers + "\r\n";
}

/// A frame of a client (RFC 6455, section 5.2), masked with zeros.
inline std::string client_frame(int opcode, const std::string& body) {
  std::string frame(1, static_cast<char>(0x80 | opcode));
  const std::size_t size = body.size();
  if (size < 126) {
    frame += static_cast<char>(0x80 | size);
  } else {
    frame += static_cast<char>(0x80 | 126);
    frame += static_cast<char>(size >> 8);
    frame += static_cast<char>(size & 0xff);
  }
  return frame + std::string(4, '\0') + body;
}

/// A WebSocket client.
class WebSocketPeer {
 public:
  explicit WebSocketPeer(std::uint16_t port, int receive_buffer_bytes = 0,
                         const std::string& request = upgrade_request())
      : peer_(port, receive_buffer_bytes) {
    peer_.send(request);
    while (!head_.ends_with("\r\n\r\n")) head_ += peer_.receive(1);
  }
  [[nodiscard]] const std::string& head() const { return head_; }
  [[nodiscard]] const TcpPeer& tcp() const { return peer_; }

  void send(const std::string& text) const { peer_.send(client_frame(1, text)); }
  void subscribe(unsigned id, unsigned channel) const {
    send(R"({"op":"subscribe","subscriptions":[{"id":)" + std::to_string(id) + R"(,"channelId":)" +
         std::to_string(channel) + "}]}");
  }
  struct Frame {
    int opcode = 0;
    std::string body;
  };
  Frame receive() const {
    const std::string start = peer_.receive(2);
    std::uint64_t size = static_cast<unsigned char>(start[1]);
    const std::size_t extended = size == 126 ? 2 : size == 127 ? 8 : 0;
    if (extended > 0) size = 0;
    for (const char byte : peer_.receive(extended)) {
      size = (size << 8) | static_cast<unsigned char>(byte);
    }
    return {static_cast<unsigned char>(start[0]) & 0x0f, peer_.receive(size)};
  }
  /// The body of the next text.
  std::string text() const {
    for (;;) {
      const Frame frame = receive();
      if (frame.opcode == 1) return frame.body;
    }
  }
  /// The payload of the next message of a subscription.
  std::string message(unsigned subscription) const {
    for (;;) {
      const Frame frame = receive();
      if (frame.opcode != 2 || frame.body[0] != 1) continue;
      constexpr std::size_t kHead = 13;
      if (static_cast<unsigned char>(frame.body[1]) == subscription)
        return frame.body.substr(kHead);
    }
  }

 private:
  TcpPeer peer_;
  std::string head_;
};

}  // namespace glidar::testing
