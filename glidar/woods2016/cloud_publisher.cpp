// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/woods2016/cloud_publisher.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <sstream>
#include <string>
#include <thread>
#include <utility>

namespace glidar::woods2016 {
namespace {

using std::chrono_literals::operator""ms;

/// With keeps_newest ZeroMQ reports connections but not subscriptions, which follow immediately.
constexpr auto kSubscriptionDelay = 1000ms;
constexpr auto kPollInterval = 10ms;
/// Time for ZeroMQ's thread to take the last message of a conflating pipe.
constexpr auto kLastMessageTaken = 250ms;
constexpr std::int64_t kMaxHandshakeBytes = 1024;
/// So that a flood of handshakes does not stop the clouds.
constexpr int kMaxHandshakesAtOnce = 64;

const std::array<link::Part, 1> kEmpty;

/// Maximum size of a message from a subscriber, ZeroMQ's handshake included.
constexpr std::int64_t kMaxSubscription_bytes = 1024;

/// Subscriptions that ZeroMQ reads from a peer before it serves others.
constexpr int kSubscriptionsAtOnce = 32;

/// For handshakes, which are empty messages.
link::Protection handshake_protection(const CloudPublisherOptions& options,
                                      link::ErrorLog& errors) {
  constexpr std::uint64_t kUnread_bytes = std::uint64_t{64} << 10;
  constexpr std::uint64_t kAllUnread_bytes = std::uint64_t{1} << 20;
  return {.limits = link::connection_limits(options.limits, kUnread_bytes, kAllUnread_bytes),
          .errors = errors};
}

/// For subscribers, which send subscriptions only. ZeroMQ stores each letter of each topic in a
/// tree before a message can be refused, and traverses the tree whenever a subscriber leaves.
link::Protection subscriber_protection(const CloudPublisherOptions& options,
                                       link::ErrorLog& errors) {
  constexpr std::int64_t kHead_bytes = 16;     // header of a subscription message, rounded up
  constexpr double kFreeBytes_per_s = 1024.0;  // ten changes and a hundred heartbeats
  const link::Limits& limits = options.limits;
  const auto bytes =
      static_cast<std::uint64_t>(limits.subscriptions * (limits.topic_bytes + kHead_bytes));
  const auto all_bytes = bytes * static_cast<std::uint64_t>(limits.connections);
  link::ConnectionLimits of_connections = link::connection_limits(limits, bytes, all_bytes);
  of_connections.free_bytes_per_s = kFreeBytes_per_s;
  of_connections.counts_delivered = true;
  return {.limits = of_connections, .errors = errors};
}

link::SocketOptions cloud_socket(const CloudPublisherOptions& options, link::ErrorLog& errors) {
  const link::Limits& limits = options.limits;
  return {.kind = link::SocketKind::publish,
          .send_queue = options.queue,
          .receive_queue = kSubscriptionsAtOnce,
          .keeps_newest = options.keeps_newest,
          .max_message_bytes = kMaxSubscription_bytes,
          .reports_events = true,
          .protection = subscriber_protection(options, errors),
          .subscriptions = {.subscriptions = static_cast<std::size_t>(limits.subscriptions),
                            .topic_bytes = static_cast<std::size_t>(limits.topic_bytes)}};
}

link::SocketOptions handshakes_socket(const CloudPublisherOptions& options,
                                      link::ErrorLog& errors) {
  return {.send_queue = kMaxHandshakesAtOnce,
          .receive_queue = kMaxHandshakesAtOnce,
          .max_message_bytes = kMaxHandshakeBytes,
          .reports_events = true,
          .protection = handshake_protection(options, errors)};
}

}  // namespace

std::string rig_topic(std::string_view name) {
  return "/" + std::string(name) + '\0';
}

CloudPublisher::CloudPublisher(link::Context& context, const CloudPublisherOptions& options,
                               link::ErrorLog& errors)
    : options_(options),
      errors_(errors),
      clouds_(context, cloud_socket(options, errors)),
      handshakes_(context, handshakes_socket(options, errors), errors) {
  clouds_.bind(options.endpoint);
  handshakes_.bind({options.endpoint.host, static_cast<std::uint16_t>(options.endpoint.port + 1)});
}

void CloudPublisher::write(const PointCloud& cloud, const Frame& frame) {
  const std::uint64_t timestamp = timestamp_of(frame);
  if (is_repeated(frame, timestamp)) {
    ++counts_.repeated;
    return;
  }
  const auto found = topics_.find(frame.sensor_id);
  const std::string topic = found == topics_.end() ? std::string(1, kCloudTopic) : found->second;
  const std::size_t ahead = topic.size() - 1;  // the codec writes a topic of one byte
  link::Payload payload = pool_.take(ahead + cloud_bytes(cloud.size()));
  const std::size_t size = encode_cloud(cloud, timestamp, payload.bytes().subspan(ahead));
  std::memcpy(payload.bytes().data(), topic.data(), topic.size());
  payload.size = ahead + size;
  ++counts_.sent;
  counts_.bytes += ahead + size;
  counts_.points += (size - cloud_bytes(0)) / sizeof(CloudPoint);
  if (clouds_.publish(std::move(payload))) return;
  ++counts_.missed;
  errors_.report("clouds missed", "a subscriber reads more slowly than clouds are published");
}

bool CloudPublisher::has(std::uint64_t subscribers) {
  if (counts_.handshakes < subscribers) return false;
  if (subscribers == 0 || all_subscribed()) return true;
  const auto waited = std::chrono::steady_clock::now() - last_handshake_;
  if (waited < options_.subscription_timeout || match_.pending() == 0) return false;
  stop_waiting_for_subscriptions(options_.subscription_timeout);
  return all_subscribed();
}

/// True if all peers that have shaken hands are subscribed.
bool CloudPublisher::all_subscribed() const {
  if (match_.pending() > 0) return false;
  return knows_subscribers_ ||
         std::chrono::steady_clock::now() - last_change_ >= kSubscriptionDelay;
}

void CloudPublisher::stop_waiting_for_subscriptions(std::chrono::milliseconds waited) {
  const std::uint64_t missing = match_.pending();
  match_.stop_waiting();
  std::ostringstream text;
  text << missing << (missing == 1 ? " peer has" : " peers have")
       << " shaken hands but not subscribed to clouds within "
       << std::chrono::duration<double>(waited).count()
       << " s; not waiting any longer. Clients subscribe to "
       << (topics_.empty() ? "'c'" : "'/NAME' and a zero byte, where NAME is that of a sensor")
       << ", preferably before they shake hands";
  errors_.report("subscription missing", text.str());
}

void CloudPublisher::serve() {
  answer_handshakes();
  process_peer_events();
}

void CloudPublisher::shut_down(std::chrono::milliseconds timeout) {
  serve();
  clouds_.set_linger(timeout);
  handshakes_.socket().set_linger(timeout);
  const auto until = std::chrono::steady_clock::now() + timeout;
  while (!all_subscribed() && std::chrono::steady_clock::now() < until) {
    link::wait_for({&clouds_}, -1, kPollInterval);
    serve();
  }
  if (match_.pending() > 0) stop_waiting_for_subscriptions(timeout);
  // Cloud topics last: with keeps_newest only the last message is certain to arrive.
  std::vector<std::string> ending = {"p", "P"};
  for (const auto& [sensor, topic] : topics_) ending.push_back(topic);
  ending.emplace_back(1, kCloudTopic);
  const auto queues_until = std::chrono::steady_clock::now() + timeout;
  for (const std::string& topic : ending) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(
        queues_until - std::chrono::steady_clock::now());
    if (clouds_.publish(encode_shutdown(topic), std::max(left, 0ms))) continue;
    errors_.report("shutdown missed", "a subscriber does not read; it may wait for more clouds");
  }
  // The end of a conflating pipe replaces a message that libzmq has not yet taken from it.
  if (options_.keeps_newest)
    std::this_thread::sleep_for(std::min<std::chrono::milliseconds>(timeout, kLastMessageTaken));
}

/// All topics of clouds, and 'c', which also ends the stream of a rig.
std::vector<std::string> CloudPublisher::topics() const {
  std::vector<std::string> all = {std::string(1, kCloudTopic)};
  for (const auto& [sensor, topic] : topics_) all.push_back(topic);
  return all;
}

bool CloudPublisher::is_repeated(const Frame& frame, std::uint64_t timestamp) {
  const auto [last, is_first] = last_timestamps_.try_emplace(frame.sensor_id, timestamp);
  return std::exchange(last->second, timestamp) == timestamp && !is_first;
}

std::uint64_t CloudPublisher::timestamp_of(const Frame& frame) {
  if (options_.timestamps == Timestamps::of_poses)
    return static_cast<std::uint64_t>(frame.stamp_ns);
  return ++counted_[frame.sensor_id];
}

void CloudPublisher::answer_handshakes() {
  for (int i = 0; i < kMaxHandshakesAtOnce; ++i) {
    const std::optional<link::Delivered> request = handshakes_.receive();
    if (!request) return;
    if (!request->body.bytes().empty() || !request->is_single) {
      errors_.report(
          "unexpected handshake",
          "a subscriber sent more than the empty message of the protocol; it is answered");
    }
    if (handshakes_.reply(request->from, kEmpty) != link::Sending::sent) {
      errors_.report("handshake not answered", "the peer has left, or reads no replies");
    }
    ++counts_.handshakes;
    match_.add_handshake();
    last_handshake_ = last_change_ = std::chrono::steady_clock::now();
  }
}

/// Where subscriptions are not reported, every connection counts as a subscriber.
void CloudPublisher::set_subscribers(std::uint64_t count) {
  if (count > counts_.subscribers) last_change_ = std::chrono::steady_clock::now();
  counts_.subscribers = count;
  match_.set_subscribers(count);
}

void CloudPublisher::process_peer_events() {
  const link::SubscriptionCount known = clouds_.subscriptions(topics());
  knows_subscribers_ = known.is_known;
  if (known.is_known) set_subscribers(known.subscribers);
  for (const link::PeerEvent event : clouds_.events()) {
    const std::uint64_t connected = counts_.subscribers;
    if (event == link::PeerEvent::joined && !known.is_known) set_subscribers(connected + 1);
    if (event == link::PeerEvent::left && !known.is_known && connected > 0) {
      set_subscribers(connected - 1);
    }
    if (event == link::PeerEvent::refused) {
      errors_.report("peer refused", "a peer that is not a subscriber connected to the cloud port");
    }
  }
  for (const link::PeerEvent event : handshakes_.socket().events()) {
    if (event != link::PeerEvent::refused) continue;
    errors_.report("peer refused",
                   "a peer of an incompatible socket type connected to the handshake port");
  }
}

}  // namespace glidar::woods2016
