// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/link/foxglove/hub.hpp>
#include <glidar/link/foxglove/reply_gate.hpp>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>

#include <cstdint>
#include <deque>
#include <memory>

namespace glidar::foxglove {

class HttpSession;

/// Accepts connections. When too many have not sent a request, the oldest one is closed.
class Acceptor {
 public:
  /// Throws Error if it cannot listen at the endpoint.
  Acceptor(Hub& hub, std::shared_ptr<ReplyGate> gate);
  void start() { accept(); }
  [[nodiscard]] std::uint16_t port() const { return port_; }

 private:
  void accept();
  void begin(boost::asio::ip::tcp::socket&& socket);
  void pause();
  void make_room();

  Hub& hub_;
  std::shared_ptr<ReplyGate> gate_;
  boost::asio::ip::tcp::acceptor acceptor_;
  boost::asio::steady_timer timer_;
  std::uint16_t port_ = 0;
  std::deque<std::weak_ptr<HttpSession>> waiting_;  ///< oldest first
};

}  // namespace glidar::foxglove
