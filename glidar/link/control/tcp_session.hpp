// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/link/control.

#include <glidar/link/control/conversation.hpp>
#include <glidar/link/control/tcp_service.hpp>

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>

#include <array>
#include <chrono>
#include <cstddef>
#include <memory>
#include <string>

namespace glidar::control {

/// One connection. Keeps itself alive while an operation is in progress.
class TcpSession : public std::enable_shared_from_this<TcpSession> {
 public:
  using Clock = std::chrono::steady_clock;

  TcpSession(boost::asio::ip::tcp::socket&& socket, std::unique_ptr<Conversation> conversation,
             const TcpServiceOptions& options, link::ErrorLog& errors);
  void start();
  void close();
  [[nodiscard]] bool is_open() const { return socket_.is_open(); }
  /// When it began or sent its last complete request.
  [[nodiscard]] Clock::time_point last_request() const { return last_request_; }

 private:
  using Failure = boost::system::error_code;

  void read();
  void on_read(Failure failure, std::size_t size);
  void converse();
  void send(Step step);
  void on_sent(Failure failure);
  void drain();
  void expire_after(std::chrono::milliseconds wait);

  boost::asio::ip::tcp::socket socket_;
  boost::asio::steady_timer timer_;
  std::unique_ptr<Conversation> conversation_;
  const TcpServiceOptions& options_;
  link::ErrorLog& errors_;
  std::array<char, 4096> chunk_{};
  std::string pending_;  ///< received, not consumed
  std::string answer_;
  bool is_in_request_ = false;
  bool ends_ = false;
  Clock::time_point last_request_ = Clock::now();
};

}  // namespace glidar::control
