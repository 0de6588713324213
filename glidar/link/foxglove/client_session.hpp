// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/link/foxglove/hub.hpp>
#include <glidar/link/foxglove/message_queue.hpp>

#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/websocket/stream.hpp>

#include <array>
#include <cstddef>
#include <deque>
#include <map>
#include <memory>
#include <span>
#include <string>

namespace glidar::foxglove {

/// A connection of a Foxglove client. Keeps itself alive while an operation is in progress.
class ClientSession : public std::enable_shared_from_this<ClientSession> {
 public:
  using Request = boost::beast::http::request<boost::beast::http::string_body>;

  ClientSession(boost::beast::tcp_stream&& stream, Hub& hub);
  /// Completes the handshake with this subprotocol.
  void start(const Request& request, std::string_view subprotocol);

  void advertise(std::span<const Channel> channels);
  /// Queues a message if the client is subscribed to its channel. Returns how many of its messages
  /// were dropped for it.
  std::size_t deliver(const ChannelMessage& message, std::size_t depth);

 private:
  using Failure = boost::beast::error_code;

  void on_accepted(Failure failure);
  void read();
  void on_read(Failure failure);
  void handle(std::string_view text);
  void subscribe(const Subscription& subscription);
  void unsubscribe(SubscriptionId id);
  void complain(const std::string& message);
  void send_text(std::string text);
  void write();
  void write_text();
  void write_message(ChannelMessage message);
  void on_written(Failure failure);
  void close();

  boost::beast::websocket::stream<boost::beast::tcp_stream> socket_;
  boost::beast::flat_buffer received_;
  Hub& hub_;
  std::map<ChannelId, SubscriptionId> subscriptions_;
  std::deque<std::string> texts_;  ///< that wait; the first one may be being sent
  MessageQueue messages_;
  ChannelMessage current_;               ///< being sent
  std::array<std::byte, 13> head_ = {};  ///< of the message being sent
  bool is_open_ = false;
  bool is_writing_ = false;
  bool sends_text_ = false;
  std::size_t complaints_ = 0;
};

}  // namespace glidar::foxglove
