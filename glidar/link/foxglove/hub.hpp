// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/link/foxglove/protocol.hpp>
#include <glidar/link/foxglove/server.hpp>

#include <boost/asio/io_context.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/websocket/stream.hpp>

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace glidar::foxglove {

class ClientSession;

/// Passes messages from the publisher's thread to the clients' sessions. Functions may be called in
/// the server's thread only, except for those marked with "any thread".
class Hub {
 public:
  Hub(boost::asio::io_context& io, const ServerOptions& options, link::ErrorLog& errors);

  ChannelId add_channel(const ChannelOptions& options);  ///< any thread
  void publish(ChannelMessage message);                  ///< any thread
  [[nodiscard]] bool is_subscribed(ChannelId id) const;  ///< any thread
  [[nodiscard]] ServerCounts counts() const;             ///< any thread

  /// False: there are too many clients.
  bool join(const std::shared_ptr<ClientSession>& client);
  void leave(const std::shared_ptr<ClientSession>& client);
  /// Copies of all channels for a new client.
  [[nodiscard]] std::vector<Channel> channels() const;
  [[nodiscard]] bool has_channel(ChannelId id) const;
  /// Counts a subscription that begins or ends.
  void count_subscription(ChannelId id, bool begins);
  /// The newest message of a channel is sent to a client that has just subscribed.
  void send_newest(ChannelId id, ClientSession& client);

  void count_connection() { ++connections_; }
  void count_sent() { ++sent_; }
  [[nodiscard]] const ServerOptions& options() const { return options_; }
  [[nodiscard]] link::HttpGuard& guard() { return guard_; }
  [[nodiscard]] link::ErrorLog& errors() { return errors_; }
  [[nodiscard]] const std::string& session_id() const { return session_id_; }
  [[nodiscard]] boost::asio::io_context& io() { return io_; }
  std::set<std::shared_ptr<void>> picking;  ///< sessions that wait for an explanation

  /// Of messages with the time, which need no subscription.
  static constexpr ChannelId kTime = 0;

 private:
  struct Entry {
    Channel channel;
    std::size_t depth = 1;
    std::size_t subscriptions = 0;
    ChannelMessage newest = {};  ///< without payload: none yet
  };
  void distribute();
  std::size_t depth_of(ChannelId id) const;

  boost::asio::io_context& io_;
  const ServerOptions& options_;
  link::HttpGuard guard_;
  link::ErrorLog& errors_;
  std::string session_id_;
  std::set<std::shared_ptr<ClientSession>> clients_;

  mutable std::mutex mutex_;  ///< of what follows
  std::map<ChannelId, Entry> entries_;
  MessageQueue inbox_;
  bool is_scheduled_ = false;

  std::atomic<std::uint64_t> client_count_ = 0;
  std::atomic<std::uint64_t> connections_ = 0;
  std::atomic<std::uint64_t> sent_ = 0;
  std::atomic<std::uint64_t> dropped_ = 0;
};

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
