// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/link/foxglove/http_routes.hpp>
#include <glidar/link/foxglove/hub.hpp>
#include <glidar/link/foxglove/reply_gate.hpp>
#include <glidar/link/http_parser.hpp>

#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>

#include <memory>
#include <optional>
#include <string>

namespace glidar::foxglove {

/// A new connection: answers one HTTP request, or becomes a ClientSession. Keeps itself alive while
/// an operation is in progress.
class HttpSession : public std::enable_shared_from_this<HttpSession> {
 public:
  HttpSession(boost::asio::ip::tcp::socket&& socket, Hub& hub, std::shared_ptr<ReplyGate> gate);
  void start();
  /// Makes room for others.
  void close();
  /// Whether its request is not complete yet.
  [[nodiscard]] bool is_waiting() const { return is_waiting_; }

 private:
  using Failure = boost::beast::error_code;
  using Request = link::HttpParser::value_type;

  void on_read(Failure failure);
  void upgrade(const Request& request);
  void answer(const Request& request);
  void explain(const Pick& pick);
  void finish(const std::optional<std::string>& text);
  void respond(const HttpReply& reply);
  void on_written();

  boost::beast::tcp_stream stream_;
  boost::beast::flat_buffer received_;
  link::HttpParser parser_;
  boost::beast::http::response<boost::beast::http::string_body> response_;
  Hub& hub_;
  std::shared_ptr<ReplyGate> gate_;
  bool is_waiting_ = true;
  bool is_head_ = false;
};

}  // namespace glidar::foxglove
