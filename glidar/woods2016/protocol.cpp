// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/woods2016/protocol.hpp>

#include <glidar/core/error.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstring>
#include <sstream>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

namespace glidar::woods2016 {
namespace {

static_assert(std::endian::native == std::endian::little, "messages are little-endian");
static_assert(sizeof(CloudPoint) == 16, "points are copied without padding");

constexpr std::string_view kShutdown = "KTHXBAI";
constexpr std::size_t kHeadBytes = 1 + 8;
constexpr const char* kPoseMessage = "pose message ('v')";
constexpr const char* kCloudMessage = "cloud message ('c')";

/// A byte in readable form: 'v', or 0x07.
std::string byte_text(std::byte byte) {
  const auto value = std::to_integer<unsigned>(byte);
  if (value > 0x20 && value < 0x7f) return std::string("'") + static_cast<char>(value) + "'";
  constexpr std::string_view kDigits = "0123456789abcdef";
  return std::string("0x") + kDigits[value >> 4U] + kDigits[value & 0xfU];
}

void check_topic(const char* where, Bytes message, char topic) {
  if (message.empty())
    throw Error({where, "it is empty", std::string("'") + topic + "' and its content"});
  if (message[0] == static_cast<std::byte>(topic)) return;
  throw Error(
      {where, "its first byte is " + byte_text(message[0]), std::string("'") + topic + "'"});
}

/// The number at a valid offset.
template <class T>
T read(Bytes message, std::size_t offset) {
  T value;
  std::memcpy(&value, message.data() + offset, sizeof(T));
  return value;
}

template <class T>
void write(std::span<std::byte> message, std::size_t offset, T value) {
  std::memcpy(message.data() + offset, &value, sizeof(T));
}

/// Names of the numbers of a placement, for errors.
constexpr std::array kNumberNames = {"object w",      "object x",      "object y",      "object z",
                                     "translation x", "translation y", "translation z", "sensor w",
                                     "sensor x",      "sensor y",      "sensor z"};
using Numbers = std::array<double, kNumberNames.size()>;

void check_numbers(const Numbers& numbers) {
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const bool is_position = i >= 4 && i < 7;
    if (std::isfinite(numbers[i]) && (!is_position || std::abs(numbers[i]) <= kMaxCoordinate_m))
      continue;
    throw Error({kPoseMessage, std::string(kNumberNames[i]) + " is " + number_text(numbers[i]),
                 is_position ? "metres from -1e15 to 1e15" : "a finite number"});
  }
}

Eigen::Quaterniond unit_quaternion(const Numbers& numbers, std::size_t first, const char* name) {
  const Eigen::Quaterniond q(numbers[first], numbers[first + 1], numbers[first + 2],
                             numbers[first + 3]);
  const double length = q.coeffs().stableNorm();
  if (std::abs(length - 1.0) <= kQuaternionTolerance) return q.normalized();
  throw Error({kPoseMessage,
               std::string("the ") + name + "'s quaternion has the length " + number_text(length),
               "1 to within 0.001, in the order w x y z"});
}

/// The numbers of the column with this name and this many numbers per point.
template <class T>
const std::vector<T>& field_values(const PointCloud& cloud, const char* name,
                                   std::size_t components) {
  const Column* column = find_column(cloud, name);
  const auto* numbers = column == nullptr ? nullptr : std::get_if<std::vector<T>>(&column->values);
  if (numbers != nullptr && numbers->size() == components * cloud.size()) return *numbers;
  throw Error({kCloudMessage, std::string("the cloud has no column ") + name, "xyz and intensity"});
}

}  // namespace

Placement decode_placement(Bytes message) {
  check_topic(kPoseMessage, message, kPlacementTopic);
  if (message.size() != kPlacementBytes) {
    throw Error(
        {kPoseMessage, "it has " + std::to_string(message.size()) + " bytes",
         std::to_string(kPlacementBytes) + ": the byte 'v', a 64-bit timestamp, 11 doubles"});
  }
  Numbers numbers{};
  std::memcpy(numbers.data(), message.data() + kHeadBytes, sizeof(numbers));
  check_numbers(numbers);
  return {.timestamp = read<std::uint64_t>(message, 1),
          .object = unit_quaternion(numbers, 0, "object"),
          .translation_m = {numbers[4], numbers[5], numbers[6]},
          .sensor = unit_quaternion(numbers, 7, "sensor")};
}

std::array<std::byte, kPlacementBytes> encode_placement(const Placement& placement) {
  std::array<std::byte, kPlacementBytes> message{};
  const auto& [timestamp, object, t, sensor] = placement;
  const Numbers numbers = {object.w(), object.x(), object.y(), object.z(), t.x(),     t.y(),
                           t.z(),      sensor.w(), sensor.x(), sensor.y(), sensor.z()};
  write(std::span(message), 0, kPlacementTopic);
  write(std::span(message), 1, timestamp);
  write(std::span(message), kHeadBytes, numbers);
  return message;
}

Cloud decode_cloud(Bytes message) {
  check_topic(kCloudMessage, message, kCloudTopic);
  if (message.size() < kHeadBytes || (message.size() - kHeadBytes) % sizeof(CloudPoint) != 0) {
    throw Error({kCloudMessage, "it has " + std::to_string(message.size()) + " bytes",
                 "9, and 16 for every point"});
  }
  Cloud cloud;
  cloud.timestamp = read<std::uint64_t>(message, 1);
  cloud.points.resize((message.size() - kHeadBytes) / sizeof(CloudPoint));
  if (cloud.points.empty()) return cloud;
  std::memcpy(cloud.points.data(), message.data() + kHeadBytes, message.size() - kHeadBytes);
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const auto& [x, y, z, intensity] = cloud.points[i];
    if (std::isfinite(x) && std::isfinite(y) && std::isfinite(z) && std::isfinite(intensity))
      continue;
    throw Error({kCloudMessage, "point " + std::to_string(i) + " is not finite", "finite numbers"});
  }
  return cloud;
}

std::size_t encode_cloud(const PointCloud& cloud, std::uint64_t timestamp,
                         std::span<std::byte> to) {
  const auto& xyz = field_values<double>(cloud, "xyz", 3);
  const auto& intensity = field_values<float>(cloud, "intensity", 1);
  if (to.size() < cloud_bytes(cloud.size())) {
    throw Error({kCloudMessage, "there is room for " + std::to_string(to.size()) + " bytes",
                 std::to_string(cloud_bytes(cloud.size())) + " or more"});
  }
  write(to, 0, kCloudTopic);
  write(to, 1, timestamp);
  std::byte* place = to.data() + kHeadBytes;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const CloudPoint point = {static_cast<float>(xyz[3 * i]), static_cast<float>(xyz[3 * i + 1]),
                              static_cast<float>(xyz[3 * i + 2]), intensity[i]};
    // Every point is written, but kept only if it is a hit: faster than a branch per miss.
    std::memcpy(place, &point, sizeof(point));
    if (!std::isnan(point.x_m)) place += sizeof(point);
  }
  return static_cast<std::size_t>(place - to.data());
}

std::vector<std::byte> encode_shutdown(std::string_view topic) {
  std::vector<std::byte> message(topic.size() + kShutdown.size());
  std::memcpy(message.data(), topic.data(), topic.size());
  std::memcpy(message.data() + topic.size(), kShutdown.data(), kShutdown.size());
  return message;
}

bool is_shutdown(Bytes message) {
  return message.size() == 1 + kShutdown.size() &&
         std::memcmp(message.data() + 1, kShutdown.data(), kShutdown.size()) == 0;
}

void HandshakeMatch::add_handshake() {
  if (early_ > 0) {
    --early_;
    ++matched_;
  } else {
    ++pending_;
  }
}

void HandshakeMatch::set_subscribers(std::uint64_t count) {
  for (; subscribers_ < count; ++subscribers_) {
    if (pending_ > 0) {
      --pending_;
      ++matched_;
    } else if (absent_ > 0) {
      --absent_;  // a returning peer does not shake hands again
    } else {
      ++early_;
    }
  }
  // It is unknown which one left. It is assumed to be one without a handshake, which may cause an
  // unnecessary wait.
  for (; subscribers_ > count; --subscribers_) {
    if (early_ > 0) {
      --early_;
    } else {
      ++absent_;
    }
  }
}

void HandshakeMatch::stop_waiting() {
  absent_ += pending_;
  pending_ = 0;
}

namespace {

/// Poses are small; a peer that sends more is cut off. Smaller messages are read and refused.
constexpr std::int64_t kMaxMessageBytes = std::int64_t{16} << 20;

link::SocketOptions pose_socket_options(const PoseReceiverOptions& options) {
  return {.kind = link::SocketKind::subscribe,
          .receive_queue = std::max(options.queue, 1),
          .keeps_newest = options.queue == 0,
          .max_message_bytes = kMaxMessageBytes,
          .reports_events = true};
}

link::Endpoint next_port(link::Endpoint endpoint) {
  ++endpoint.port;
  return endpoint;
}

/// Maximum delay between the opening of a simulator's handshake port and its pose port. After it,
/// the handshake is sent without a connection to the pose port.
constexpr std::chrono::seconds kPosesDelay{5};

/// Delay before reconnecting to a simulator that was cut off.
constexpr std::chrono::seconds kReconnectDelay{1};

/// So that a flood of invalid messages does not block the caller.
constexpr int kMaxMessagesAtOnce = 256;

constexpr link::SocketOptions kHandshakeSocket = {.kind = link::SocketKind::request,
                                                  .reports_events = true};

}  // namespace

PoseReceiver::PoseReceiver(link::Context& context, const PoseReceiverOptions& options,
                           link::ErrorLog& errors)
    : context_(context),
      options_(options),
      errors_(errors),
      poses_(context, pose_socket_options(options)),
      handshake_(context, kHandshakeSocket) {
  open_poses();
  open_handshake();
}

bool PoseReceiver::is_ready() {
  if (awaits_reply_ && handshake_.receive()) {
    awaits_reply_ = false;
    is_ready_ = true;
  }
  process_connection_events();
  send_handshake_when_connected();
  return is_ready_;
}

std::optional<Placement> PoseReceiver::receive() {
  process_connection_events();
  send_handshake_when_connected();
  for (int i = 0; i < kMaxMessagesAtOnce && !is_over_; ++i) {
    const std::optional<link::Message> message = poses_.receive();
    if (!message) {
      report_loss();
      reconnect_if_cut_off();
      return std::nullopt;
    }
    ++counts_.received;
    if (std::optional<Placement> placement = read(*message)) return placement;
  }
  return std::nullopt;
}

std::optional<Placement> PoseReceiver::read(const link::Message& message) {
  if (!message.is_whole()) {
    refuse("it has several parts; a pose has one");
    return std::nullopt;
  }
  if (is_shutdown(message.bytes())) {
    is_over_ = true;
    return std::nullopt;
  }
  try {
    Placement placement = decode_placement(message.bytes());
    if (is_new(placement.timestamp)) return placement;
  } catch (const Error& error) {
    refuse(error.what());
  }
  return std::nullopt;
}

void PoseReceiver::refuse(const std::string& why) {
  ++counts_.refused;
  errors_.report("pose refused", why);
}

/// A simulator may restart its clock, so a smaller timestamp is reported but accepted.
bool PoseReceiver::is_new(std::uint64_t timestamp) {
  const std::optional<std::uint64_t> before = std::exchange(last_timestamp_, timestamp);
  if (before == timestamp) {
    ++counts_.repeated;
    return false;
  }
  if (before && timestamp < *before) {
    ++counts_.backwards;
    errors_.report("timestamp decreased", "from timestamp " + std::to_string(*before) + " to " +
                                              std::to_string(timestamp) +
                                              "; the cloud is made as for any other");
  }
  return true;
}

void PoseReceiver::open_poses() {
  poses_.subscribe(std::string_view(&kPlacementTopic, 1));
  poses_.connect(options_.endpoint);
}

/// After all messages are read: a simulator that sent its end message is not lost.
void PoseReceiver::report_loss() {
  if (!std::exchange(loss_unreported_, false)) return;
  errors_.report("simulator lost",
                 "its connection ended, or it sent more than 16 MiB at once; waiting for it");
}

/// ZeroMQ reconnects to a peer that went away, but not to one that it cut off.
void PoseReceiver::reconnect_if_cut_off() {
  if (!lost_ || std::chrono::steady_clock::now() - *lost_ < kReconnectDelay) return;
  lost_.reset();
  poses_ = link::Socket(context_, pose_socket_options(options_));
  open_poses();
}

void PoseReceiver::open_handshake() {
  handshake_ = link::Socket(context_, kHandshakeSocket);
  handshake_.connect(next_port(options_.endpoint));
  reachable_.reset();
  handshake_sent_ = awaits_reply_ = false;
}

/// A simulator may send poses as soon as it has answered, so the subscription must arrive before
/// the handshake. The subscription is sent when the pose connection is established; then the
/// handshake connection is made again, and the simulator, which serves both in one thread, reads
/// the handshake some round trips later. A simulator that opens its pose port only after the
/// handshake gets the handshake after kPosesDelay.
void PoseReceiver::send_handshake_when_connected() {
  if (handshake_sent_) return;
  const bool is_late = reachable_ && std::chrono::steady_clock::now() - *reachable_ >= kPosesDelay;
  if (!is_connected_ && !is_late) return;
  if (is_connected_) open_handshake();
  handshake_sent_ = true;
  awaits_reply_ = handshake_.send({});
}

/// A simulator that restarts waits for a new handshake.
void PoseReceiver::process_connection_events() {
  for (const link::PeerEvent event : handshake_.events()) {
    if (event == link::PeerEvent::joined) reachable_ = std::chrono::steady_clock::now();
    if (event == link::PeerEvent::left) reachable_.reset();
    if (event == link::PeerEvent::left && !is_connected_) open_handshake();
  }
  for (const link::PeerEvent event : poses_.events()) {
    if (event == link::PeerEvent::joined) {
      is_connected_ = true;
      lost_.reset();
    }
    if (event != link::PeerEvent::left) continue;
    loss_unreported_ = true;
    is_connected_ = false;
    // It may have answered, sent all its poses and ended since the last call, and the reply is
    // lost.
    if (awaits_reply_ && link::wait_for({&poses_}, -1, {})) is_ready_ = true;
    open_handshake();
    lost_ = std::chrono::steady_clock::now();
  }
}

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
