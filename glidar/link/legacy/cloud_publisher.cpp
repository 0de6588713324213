// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/legacy/cloud_publisher.hpp>

#include <chrono>
#include <cstring>
#include <sstream>
#include <string>
#include <utility>

namespace glidar::legacy {
namespace {

using std::chrono_literals::operator""ms;

/// For the last messages, when a subscriber is slow.
constexpr auto kPatience = 1000ms;
/// With keeps_newest ZeroMQ reports connections but no subscriptions, which come right after.
constexpr auto kSettling = 1000ms;
constexpr auto kLook = 10ms;
constexpr std::int64_t kLargestHandshakeBytes = 1024;

link::SocketOptions cloud_socket(const CloudPublisherOptions& options) {
  return {.kind = link::SocketKind::publish,
          .send_queue = options.queue,
          .keeps_newest = options.keeps_newest,
          .linger = kPatience,
          .is_watched = true};
}

link::SocketOptions handshake_socket_options() {
  return {.kind = link::SocketKind::reply,
          .largest_message_bytes = kLargestHandshakeBytes,
          .linger = kPatience,
          .is_watched = true};
}

}  // namespace

std::string rig_topic(std::string_view name) {
  return "/" + std::string(name) + '\0';
}

CloudPublisher::CloudPublisher(link::Context& context, const CloudPublisherOptions& options,
                               link::FaultLog& faults)
    : options_(options),
      faults_(faults),
      clouds_(context, cloud_socket(options)),
      handshakes_(context, handshake_socket_options()) {
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
  const std::size_t ahead = topic.size() - 1;  // of the codec's topic of one letter
  link::Payload payload(pool_, ahead + cloud_bytes(cloud.size()));
  const std::size_t size = encode_cloud(cloud, timestamp, payload.bytes().subspan(ahead));
  std::memcpy(payload.bytes().data(), topic.data(), topic.size());
  payload.shrink(ahead + size);
  ++counts_.sent;
  counts_.bytes += ahead + size;
  counts_.points += (size - cloud_bytes(0)) / sizeof(CloudPoint);
  if (clouds_.publish(std::move(payload))) return;
  ++counts_.missed;
  faults_.tell("clouds missed", "a subscriber reads more slowly than clouds come");
}

bool CloudPublisher::has(std::uint64_t subscribers) {
  if (counts_.handshakes < subscribers) return false;
  if (subscribers == 0 || is_settled()) return true;
  const auto waited = std::chrono::steady_clock::now() - last_handshake_;
  if (waited < options_.subscription_timeout || match_.pending() == 0) return false;
  give_up_subscriptions(options_.subscription_timeout);
  return is_settled();
}

/// Whether everybody who shook hands is subscribed.
bool CloudPublisher::is_settled() const {
  if (match_.pending() > 0) return false;
  return knows_subscribers_ || std::chrono::steady_clock::now() - last_change_ >= kSettling;
}

void CloudPublisher::give_up_subscriptions(std::chrono::milliseconds waited) {
  const std::uint64_t missing = match_.pending();
  match_.give_up();
  std::ostringstream text;
  text << missing << (missing == 1 ? " peer has" : " peers have")
       << " shaken hands but not subscribed to clouds within "
       << std::chrono::duration<double>(waited).count()
       << " s; not waiting any longer. Clients subscribe to "
       << (topics_.empty() ? "'c'" : "'/NAME' and a zero byte, NAME being that of a sensor")
       << ", best before they shake hands";
  faults_.tell("subscription missing", text.str());
}

void CloudPublisher::serve() {
  answer_handshakes();
  notice_peers();
}

void CloudPublisher::shut_down() {
  serve();
  const auto until = std::chrono::steady_clock::now() + kPatience;
  while (!is_settled() && std::chrono::steady_clock::now() < until) {
    link::wait_for({&clouds_}, -1, kLook);
    serve();
  }
  if (match_.pending() > 0) give_up_subscriptions(kPatience);
  // the clouds' topics last: with keeps_newest only the last message is sure to arrive
  std::vector<std::string> ending = {"p", "P"};
  for (const auto& [sensor, topic] : topics_) ending.push_back(topic);
  ending.emplace_back(1, kCloudTopic);
  for (const std::string& topic : ending) {
    if (clouds_.publish(encode_shutdown(topic), kPatience)) continue;
    faults_.tell("shutdown missed", "a subscriber does not read; it may wait for more clouds");
  }
}

/// Of clouds and of their end, which is 2015's on a rig too.
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
  while (const std::optional<link::Message> request = handshakes_.receive()) {
    if (!request->is_last()) continue;  // a reply is due after the last part
    if (!request->bytes().empty() || !request->is_whole()) {
      faults_.tell("odd handshake",
                   "a subscriber sent more than the empty message that 2015's protocol has; "
                   "answered all the same");
    }
    handshakes_.send({});
    ++counts_.handshakes;
    match_.add_handshake();
    last_handshake_ = last_change_ = std::chrono::steady_clock::now();
  }
}

/// A subscription follows its connection, where it is not reported itself.
void CloudPublisher::set_subscribers(std::uint64_t count) {
  if (count > counts_.subscribers) last_change_ = std::chrono::steady_clock::now();
  counts_.subscribers = count;
  match_.set_subscribers(count);
}

void CloudPublisher::notice_peers() {
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
      faults_.tell("stranger refused", "something that is no subscriber came to the clouds' port");
    }
  }
  for (const link::PeerEvent event : handshakes_.events()) {
    if (event != link::PeerEvent::refused) continue;
    faults_.tell("stranger refused",
                 "something else than a subscriber came to the handshakes' port");
  }
}

}  // namespace glidar::legacy
