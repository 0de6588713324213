// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/foxglove/hub.hpp>

#include <glidar/link/foxglove/client_session.hpp>

#include <boost/asio/post.hpp>

#include <algorithm>
#include <chrono>
#include <utility>

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

}  // namespace glidar::foxglove
