// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/foxglove/hub.hpp>

#include <glidar/core/error.hpp>

#include <boost/asio/buffer.hpp>
#include <boost/asio/post.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/http/field.hpp>
#include <boost/beast/websocket/option.hpp>

#include <algorithm>
#include <chrono>
#include <utility>
#include <variant>

namespace glidar::foxglove {

Hub::Hub(boost::asio::io_context& io, const ServerOptions& options, link::ErrorLog& errors)
    : io_(io),
      options_(options),
      guard_(options.access, link::HttpClients::own_pages, options.limits.http),
      errors_(errors),
      session_id_(std::to_string(std::chrono::system_clock::now().time_since_epoch().count())) {}

ChannelId Hub::add_channel(const ChannelOptions& options) {
  Entry entry{.channel = {.topic = options.topic,
                          .encoding = options.encoding,
                          .schema_name = options.schema_name,
                          .schema = options.schema,
                          .schema_encoding = options.schema_encoding},
              .depth = std::max<std::size_t>(options.depth, 1)};
  Channel channel;
  {
    const std::lock_guard lock(mutex_);
    entry.channel.id = static_cast<ChannelId>(entries_.size()) + 1;
    channel = entry.channel;
    entries_.emplace(channel.id, std::move(entry));
  }
  boost::asio::post(io_, [this, channel] {
    const auto clients = clients_;  // a client that is disconnected leaves
    for (const auto& client : clients) client->advertise({&channel, 1});
  });
  return channel.id;
}

void Hub::publish(ChannelMessage message) {
  const std::lock_guard lock(mutex_);
  const auto entry = entries_.find(message.channel);
  if (entry != entries_.end()) {
    entry->second.newest = message;
  } else if (message.channel != kTime) {
    return;
  }
  dropped_ += inbox_.push(std::move(message), entry == entries_.end() ? 1 : entry->second.depth);
  if (std::exchange(is_scheduled_, true)) return;
  boost::asio::post(io_, [this] { distribute(); });
}

void Hub::distribute() {
  MessageQueue messages;
  {
    const std::lock_guard lock(mutex_);
    messages = std::exchange(inbox_, {});
    is_scheduled_ = false;
  }
  while (const auto message = messages.pop()) {
    const std::size_t depth = depth_of(message->channel);
    for (const auto& client : clients_) dropped_ += client->deliver(*message, depth);
  }
}

std::size_t Hub::depth_of(ChannelId id) const {
  const std::lock_guard lock(mutex_);
  const auto entry = entries_.find(id);
  return entry == entries_.end() ? 1 : entry->second.depth;
}

bool Hub::is_subscribed(ChannelId id) const {
  const std::lock_guard lock(mutex_);
  const auto entry = entries_.find(id);
  return entry != entries_.end() && entry->second.subscriptions > 0;
}

ServerCounts Hub::counts() const {
  return {
      .clients = client_count_, .connections = connections_, .sent = sent_, .dropped = dropped_};
}

bool Hub::join(const std::shared_ptr<ClientSession>& client) {
  if (clients_.size() >= options_.limits.clients) return false;
  clients_.insert(client);
  client_count_ = clients_.size();
  return true;
}

void Hub::leave(const std::shared_ptr<ClientSession>& client) {
  clients_.erase(client);
  client_count_ = clients_.size();
}

std::vector<Channel> Hub::channels() const {
  const std::lock_guard lock(mutex_);
  std::vector<Channel> all;
  for (const auto& [id, entry] : entries_) all.push_back(entry.channel);
  return all;
}

bool Hub::has_channel(ChannelId id) const {
  const std::lock_guard lock(mutex_);
  return entries_.contains(id);
}

void Hub::count_subscription(ChannelId id, bool begins) {
  const std::lock_guard lock(mutex_);
  const auto entry = entries_.find(id);
  if (entry == entries_.end()) return;
  entry->second.subscriptions += begins ? 1 : static_cast<std::size_t>(-1);
}

void Hub::send_newest(ChannelId id, ClientSession& client) {
  ChannelMessage message;
  {
    const std::lock_guard lock(mutex_);
    message = entries_.at(id).newest;
  }
  if (message.payload.memory != nullptr) client.deliver(message, depth_of(id));
}

namespace {

namespace asio = boost::asio;
namespace websocket = boost::beast::websocket;

constexpr std::size_t kMaxComplaints = 16;  ///< of one client
constexpr std::size_t kMaxTexts = 64;       ///< that wait for one client

}  // namespace

ClientSession::ClientSession(boost::beast::tcp_stream&& stream, Hub& hub)
    : socket_(std::move(stream)), hub_(hub) {}

void ClientSession::start(const Request& request, std::string_view subprotocol) {
  socket_.next_layer().expires_never();  // the WebSocket layer has times of its own
  const ServerLimits& limits = hub_.options().limits;
  socket_.set_option(websocket::stream_base::timeout{.handshake_timeout = limits.http.request,
                                                     .idle_timeout = limits.idle,
                                                     .keep_alive_pings = true});
  socket_.set_option(websocket::stream_base::decorator(
      [name = std::string(subprotocol)](websocket::response_type& response) {
        response.set(boost::beast::http::field::sec_websocket_protocol, name);
      }));
  socket_.read_message_max(limits.received_bytes);
  socket_.auto_fragment(false);
  socket_.async_accept(
      request, [self = shared_from_this()](Failure failure) { self->on_accepted(failure); });
}

void ClientSession::on_accepted(Failure failure) {
  if (failure) return close();
  is_open_ = true;
  ServerInfo info{.name = hub_.options().name, .session_id = hub_.session_id()};
  if (hub_.options().on_playback) info.metadata["glidar.playback"] = "true";
  if (hub_.options().on_pick) info.metadata["glidar.pick"] = "true";
  send_text(server_info_text(info));
  advertise(hub_.channels());
  read();
}

void ClientSession::advertise(std::span<const Channel> channels) {
  if (is_open_ && !channels.empty()) send_text(advertise_text(channels));
}

void ClientSession::read() {
  socket_.async_read(received_, [self = shared_from_this()](Failure failure, std::size_t) {
    self->on_read(failure);
  });
}

void ClientSession::on_read(Failure failure) {
  if (failure) return close();
  if (socket_.got_text()) {
    handle(boost::beast::buffers_to_string(received_.data()));
  } else {
    complain("binary messages are not supported");
  }
  received_.consume(received_.size());
  if (is_open_) read();
}

void ClientSession::handle(std::string_view text) {
  try {
    const ClientMessage message = decode_client_message(text);
    if (const auto* begin = std::get_if<Subscribe>(&message)) {
      for (const Subscription& subscription : begin->subscriptions) subscribe(subscription);
    } else if (const auto* end = std::get_if<Unsubscribe>(&message)) {
      for (const SubscriptionId id : end->subscriptions) unsubscribe(id);
    } else {
      complain("operation '" + std::get<Unsupported>(message).operation + "' is not supported");
    }
  } catch (const Error& error) {
    complain(error.what());
  }
}

void ClientSession::subscribe(const Subscription& subscription) {
  const auto uses = [&](const auto& entry) { return entry.second == subscription.id; };
  if (!hub_.has_channel(subscription.channel)) {
    return complain("there is no channel " + std::to_string(subscription.channel));
  }
  if (subscriptions_.contains(subscription.channel) ||
      std::any_of(subscriptions_.begin(), subscriptions_.end(), uses)) {
    return complain("the subscription or the channel is already subscribed");
  }
  if (subscriptions_.size() >= kMaxSubscriptions) return complain("too many subscriptions");
  subscriptions_.emplace(subscription.channel, subscription.id);
  hub_.count_subscription(subscription.channel, true);
  hub_.send_newest(subscription.channel, *this);
}

void ClientSession::unsubscribe(SubscriptionId id) {
  const auto found = std::find_if(subscriptions_.begin(), subscriptions_.end(),
                                  [&](const auto& entry) { return entry.second == id; });
  if (found == subscriptions_.end()) return complain("there is no such subscription");
  messages_.remove(found->first);
  hub_.count_subscription(found->first, false);
  subscriptions_.erase(found);
}

void ClientSession::complain(const std::string& message) {
  if (!is_open_) return;
  hub_.errors().report("message of a Foxglove client", message);
  if (++complaints_ > kMaxComplaints) return close();
  send_text(status_text(StatusLevel::error, message));
}

void ClientSession::send_text(std::string text) {
  if (texts_.size() >= kMaxTexts) return close();
  texts_.push_back(std::move(text));
  write();
}

std::size_t ClientSession::deliver(const ChannelMessage& message, std::size_t depth) {
  if (!is_open_) return 0;
  if (message.channel != Hub::kTime && !subscriptions_.contains(message.channel)) return 0;
  const std::size_t dropped = messages_.push(message, depth);
  write();
  return message.channel == Hub::kTime ? 0 : dropped;
}

void ClientSession::write() {
  if (is_writing_ || !is_open_) return;
  if (!texts_.empty()) return write_text();
  if (auto message = messages_.pop()) write_message(std::move(*message));
}

void ClientSession::write_text() {
  is_writing_ = true;
  sends_text_ = true;
  socket_.text(true);
  socket_.async_write(
      asio::buffer(texts_.front()),
      [self = shared_from_this()](Failure failure, std::size_t) { self->on_written(failure); });
}

void ClientSession::write_message(ChannelMessage message) {
  is_writing_ = true;
  sends_text_ = false;
  current_ = std::move(message);
  std::size_t head_size = head_.size();
  if (current_.channel == Hub::kTime) {
    const auto head = time_message(current_.time_ns);
    std::copy(head.begin(), head.end(), head_.begin());
    head_size = head.size();
  } else {
    head_ = message_head(subscriptions_.at(current_.channel), current_.time_ns);
  }
  const std::array<asio::const_buffer, 2> parts = {
      asio::buffer(head_.data(), head_size),
      asio::buffer(static_cast<const void*>(current_.payload.memory.get()), current_.payload.size)};
  socket_.binary(true);
  socket_.async_write(parts, [self = shared_from_this()](Failure failure, std::size_t) {
    self->on_written(failure);
  });
}

void ClientSession::on_written(Failure failure) {
  is_writing_ = false;
  if (sends_text_ && !texts_.empty()) texts_.pop_front();
  if (!sends_text_ && current_.channel != Hub::kTime && !failure) hub_.count_sent();
  current_ = {};
  if (failure) return close();
  write();
}

void ClientSession::close() {
  const auto self = shared_from_this();
  const bool was_open = std::exchange(is_open_, false);
  for (const auto& [channel, id] : subscriptions_) hub_.count_subscription(channel, false);
  subscriptions_.clear();
  if (was_open) socket_.next_layer().close();  // the operations in progress end
  hub_.leave(self);
}

}  // namespace glidar::foxglove
