// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/lockstep.hpp>

#include <glidar/core/error.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <type_traits>
#include <utility>
#include <vector>

namespace glidar::lockstep {
namespace {

static_assert(std::endian::native == std::endian::little, "messages are little-endian");

constexpr std::array<char, 4> kMagic = {'G', 'L', 'D', 'R'};
constexpr std::uint16_t kDescribe = 0;
constexpr std::uint16_t kMeasure = 1;
constexpr std::uint16_t kClouds = 2;
constexpr std::uint32_t kHitsOnly = 1;
constexpr std::size_t kStart_bytes = 16;         // magic, version, kind, id
constexpr std::size_t kMeasureStart_bytes = 40;  // and counts
constexpr std::size_t kBody_bytes = 13 * sizeof(double);
constexpr std::size_t kMomentStart_bytes = 24;
constexpr std::size_t kFrameId_bytes = 32;
constexpr double kQuaternionTolerance = 1e-3;
constexpr double kMaxRate = 1e9;  // rad/s and m/s

[[noreturn]] void refuse(std::string where, std::string found, std::string allowed) {
  throw Error({"request, " + std::move(where), std::move(found), std::move(allowed)});
}

/// Reads numbers from bytes whose size was checked.
class Reader {
 public:
  explicit Reader(Bytes bytes) : rest_(bytes) {}

  template <class Number>
  Number read() {
    Number number{};
    std::memcpy(&number, rest_.data(), sizeof(Number));
    rest_ = rest_.subspan(sizeof(Number));
    return number;
  }
  Eigen::Vector3d read_vector() {
    const auto x = read<double>();
    const auto y = read<double>();
    const auto z = read<double>();
    return {x, y, z};
  }
  std::string read_text(std::size_t size) {
    std::string text(size, '\0');
    std::memcpy(text.data(), rest_.data(), size);
    rest_ = rest_.subspan(size);
    return text;
  }

 private:
  Bytes rest_;
};

class Writer {
 public:
  template <class Number>
  void write(Number number) {
    static_assert(std::is_arithmetic_v<Number>);
    const auto* start = reinterpret_cast<const std::byte*>(&number);
    bytes_.insert(bytes_.end(), start, start + sizeof(Number));
  }
  void write_vector(const Eigen::Vector3d& v) {
    for (const double x : {v.x(), v.y(), v.z()}) write(x);
  }
  /// Truncated to the size or padded with zeros.
  void write_text(std::string_view text, std::size_t size) {
    for (std::size_t i = 0; i < size; ++i) write(i < text.size() ? text[i] : '\0');
  }
  void write_start(std::uint16_t kind, std::uint64_t id) {
    for (const char letter : kMagic) write(letter);
    write(kVersion);
    write(kind);
    write(id);
  }
  std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  std::vector<std::byte> bytes_;
};

/// Returns the kind of the message after a check of its version.
std::uint16_t read_start(Bytes message, std::uint64_t& id) {
  if (message.size() < kStart_bytes) {
    refuse("size", std::to_string(message.size()) + " bytes", "at least 16");
  }
  Reader from(message);
  for (const char letter : kMagic) {
    if (from.read<char>() != letter) refuse("first bytes", "other bytes", "'GLDR'");
  }
  const auto version = from.read<std::uint16_t>();
  const auto kind = from.read<std::uint16_t>();
  id = from.read<std::uint64_t>();
  if (version != kVersion) {
    refuse("version", std::to_string(version), std::to_string(kVersion));
  }
  return kind;
}

struct Counts {
  std::uint32_t sensor = 0;
  std::uint32_t flags = 0;
  std::uint32_t columns = 0;
  std::uint32_t moments = 0;
  std::uint32_t objects = 0;
  std::uint32_t reserved = 0;
};

void check_count(const char* what, std::uint32_t found, std::uint32_t min, std::uint32_t max) {
  if (found >= min && found <= max) return;
  refuse(what, std::to_string(found), std::to_string(min) + " to " + std::to_string(max));
}

void check(const Counts& counts, std::size_t size) {
  check_count("number of columns", counts.columns, 1, kMaxColumns);
  check_count("number of moments", counts.moments, 1, kMaxMoments);
  check_count("number of objects", counts.objects, 0, kMaxObjects);
  if ((counts.flags & ~kHitsOnly) != 0) {
    refuse("flags", std::to_string(counts.flags), "0, or 1 for hits only");
  }
  if (counts.reserved != 0) refuse("reserved", std::to_string(counts.reserved), "0");
  const std::size_t wanted =
      kMeasureStart_bytes + counts.columns * kNameBytes +
      std::size_t{counts.moments} *
          (kMomentStart_bytes + kBody_bytes * (1 + std::size_t{counts.objects}));
  if (size != wanted) {
    refuse("size", std::to_string(size) + " bytes",
           std::to_string(wanted) + " for its columns, moments and objects");
  }
}

std::string read_name(Reader& from) {
  std::string name = from.read_text(kNameBytes);
  name.resize(name.find_last_not_of('\0') + 1);
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || c == '_'; };
  if (!name.empty() && std::all_of(name.begin(), name.end(), is_letter)) return name;
  refuse("name of a column", "a name that is empty or has other characters", "a to z and _");
}

Body read_body(Reader& from, const std::string& where) {
  const Eigen::Vector3d position_m = from.read_vector();
  const auto w = from.read<double>();
  const Eigen::Vector3d xyz = from.read_vector();
  Body body{.rate_rad_s = from.read_vector(), .velocity_m_s = from.read_vector()};
  if (!is_within_reach(position_m)) {
    refuse(where + ", position", "a number that is not finite or too large", "metres up to 1e15");
  }
  const Eigen::Quaterniond attitude(w, xyz.x(), xyz.y(), xyz.z());
  if (!(std::abs(attitude.norm() - 1.0) <= kQuaternionTolerance)) {
    refuse(where + ", quaternion", "length " + number_text(attitude.norm()),
           "length 1 to within 0.001, in the order w x y z");
  }
  for (const auto& [name, value] :
       {std::pair{"rate", body.rate_rad_s}, std::pair{"velocity", body.velocity_m_s}}) {
    if (value.allFinite() && value.cwiseAbs().maxCoeff() <= kMaxRate) continue;
    refuse(where + ", " + name, "a number that is not finite or too large", "up to 1e9");
  }
  body.world_from_body = make_pose(position_m, attitude);
  return body;
}

Moment read_moment(Reader& from, std::uint32_t index, std::uint32_t objects) {
  const std::string where = "moment " + std::to_string(index);
  Moment moment;
  constexpr std::int64_t kMaxTime_ns =
      9'000'000'000'000'000'000;  // leaves room for the firing times
  moment.t_ns = from.read<std::int64_t>();
  if (moment.t_ns > kMaxTime_ns || moment.t_ns < -kMaxTime_ns) {
    refuse(where + ", time", std::to_string(moment.t_ns) + " ns", "from -9e18 to 9e18");
  }
  moment.seed = from.read<std::uint64_t>();
  moment.number = from.read<std::uint32_t>();
  if (from.read<std::uint32_t>() != 0) refuse(where + ", reserved", "another number", "0");
  moment.sensor = read_body(from, where + ", sensor");
  moment.objects.reserve(objects);
  for (std::uint32_t k = 0; k < objects; ++k) {
    moment.objects.push_back(read_body(from, where + ", object " + std::to_string(k)));
  }
  return moment;
}

void write_body(const Body& body, Writer& to) {
  const PoseVector numbers = to_xyz_wxyz(body.world_from_body);
  for (const double number : numbers) to.write(number);
  to.write_vector(body.rate_rad_s);
  to.write_vector(body.velocity_m_s);
}

std::string_view type_of(const Column& column) {
  constexpr std::array<std::string_view, 6> kTypes = {"f4", "f8", "u1", "u2", "u4", "i8"};
  static_assert(std::variant_size_v<decltype(Column::values)> == kTypes.size());
  return kTypes.at(column.values.index());
}

std::vector<std::byte> encode_one(const Describe& describe) {
  Writer to;
  to.write_start(kDescribe, describe.id);
  return to.take();
}

std::vector<std::byte> encode_one(const Measure& measure) {
  Writer to;
  to.write_start(kMeasure, measure.id);
  to.write(measure.sensor);
  to.write(measure.drop_invalid ? kHitsOnly : 0U);
  to.write(static_cast<std::uint32_t>(measure.columns.size()));
  to.write(static_cast<std::uint32_t>(measure.moments.size()));
  to.write(
      static_cast<std::uint32_t>(measure.moments.empty() ? 0 : measure.moments[0].objects.size()));
  to.write(std::uint32_t{0});
  for (const std::string& name : measure.columns) to.write_text(name, kNameBytes);
  for (const Moment& moment : measure.moments) {
    to.write(moment.t_ns);
    to.write(moment.seed);
    to.write(moment.number);
    to.write(std::uint32_t{0});
    write_body(moment.sensor, to);
    for (const Body& body : moment.objects) write_body(body, to);
  }
  return to.take();
}

}  // namespace

Request decode_request(Bytes message, std::uint64_t& id) {
  const std::uint16_t kind = read_start(message, id);
  if (kind == kDescribe) {
    if (message.size() != kStart_bytes) {
      refuse("size", std::to_string(message.size()) + " bytes", "16 for a description");
    }
    return Describe{id};
  }
  if (kind != kMeasure) {
    refuse("kind", std::to_string(kind), "0 for a description, 1 for a measurement");
  }
  if (message.size() < kMeasureStart_bytes) {
    refuse("size", std::to_string(message.size()) + " bytes", "at least 40 for a measurement");
  }
  Reader from(message.subspan(kStart_bytes));
  Counts counts;
  for (std::uint32_t* count : {&counts.sensor, &counts.flags, &counts.columns, &counts.moments,
                               &counts.objects, &counts.reserved}) {
    *count = from.read<std::uint32_t>();
  }
  check(counts, message.size());
  Measure measure{.id = id,
                  .sensor = counts.sensor,
                  .drop_invalid = (counts.flags & kHitsOnly) != 0,
                  .columns = {},
                  .moments = {}};
  for (std::uint32_t i = 0; i < counts.columns; ++i) measure.columns.push_back(read_name(from));
  measure.moments.reserve(counts.moments);
  for (std::uint32_t i = 0; i < counts.moments; ++i) {
    measure.moments.push_back(read_moment(from, i, counts.objects));
  }
  return measure;
}

std::vector<std::byte> encode(const Request& request) {
  return std::visit([](const auto& kind) { return encode_one(kind); }, request);
}

std::vector<std::byte> encode_head(std::uint64_t id, std::span<const CloudHead> heads,
                                   const PointCloud& like) {
  Writer to;
  to.write_start(kClouds, id);
  to.write(static_cast<std::uint32_t>(heads.size()));
  to.write(static_cast<std::uint32_t>(like.columns.size()));
  for (const Column& column : like.columns) {
    to.write_text(column.name, kNameBytes);
    to.write_text(type_of(column), 2);
    to.write(static_cast<std::uint16_t>(column.components.size()));
    to.write(std::uint32_t{0});
  }
  for (const CloudHead& head : heads) {
    to.write(head.stamp_ns);
    to.write(head.seed);
    to.write(head.number);
    to.write(head.rows);
    to.write(head.cols);
    to.write(std::uint32_t{0});
    to.write_text(head.frame_id, kFrameId_bytes);
    for (const double number : to_xyz_wxyz(head.world_from_cloud)) to.write(number);
  }
  return to.take();
}

Bytes bytes_of(const Column& column) {
  return std::visit([](const auto& values) { return std::as_bytes(std::span(values)); },
                    column.values);
}

std::vector<std::byte> encode_text_head(std::uint64_t id, TextKind kind) {
  Writer to;
  to.write_start(static_cast<std::uint16_t>(kind), id);
  return to.take();
}

std::string RequestQueue::add(link::Delivered& message, Clock::time_point now) {
  Client& client = clients_[message.from.client];
  const auto in_progress = static_cast<std::int64_t>(client.waiting.size()) +
                           (client.is_served ? 1 : 0) + client.unread->replies;
  if (in_progress >= limits_.requests) {
    return Error({"request, number in progress", std::to_string(in_progress + 1) + " of one client",
                  limit_text(limits_, &link::Limits::requests),
                  "read the replies before sending more requests"})
        .what();
  }
  const auto size = static_cast<std::int64_t>(message.body.bytes().size());
  if (waiting_bytes_ + size + all_unread_->bytes > link::bytes_of_mib(limits_.memory_mib)) {
    return Error({"request, size",
                  std::to_string(size) +
                      " bytes in addition to the requests and replies of all clients",
                  limit_text(limits_, &link::Limits::memory_mib), "repeat the request later"})
        .what();
  }
  waiting_bytes_ += size;
  client.connection = message.from.connection;
  if (client.waiting.empty() && !client.is_served) ready_clients_.push_back(message.from.client);
  client.waiting.push_back({.message = std::move(message), .since = now});
  return {};
}

std::optional<Waiting> RequestQueue::next() {
  if (ready_clients_.empty()) return std::nullopt;
  Client& client = clients_.at(ready_clients_.front());
  ready_clients_.pop_front();
  Waiting waiting = std::move(client.waiting.front());
  client.waiting.pop_front();
  client.is_served = true;
  waiting_bytes_ -= static_cast<std::int64_t>(waiting.message.body.bytes().size());
  return waiting;
}

void RequestQueue::done(const std::string& name) {
  const auto found = clients_.find(name);
  if (found == clients_.end()) return;
  Client& client = found->second;
  const bool was_served = std::exchange(client.is_served, false);
  if (was_served && !client.waiting.empty()) ready_clients_.push_back(name);
}

std::shared_ptr<Unread> RequestQueue::unread_of(const link::ReturnAddress& address) {
  Client& client = clients_[address.client];
  client.connection = address.connection;
  if (client.unread->replies == 0) client.progress_time = Clock::now();
  return client.unread;
}

void RequestQueue::check_clients(
    Clock::time_point now, std::chrono::seconds timeout,
    const std::function<std::uint64_t(const link::ConnectionId&)>& progress,
    const std::function<void(const link::ConnectionId&)>& stalled) {
  for (auto one = clients_.begin(); one != clients_.end();) {
    Client& client = one->second;
    if (client.unread->replies == 0) {
      const bool is_idle = client.waiting.empty() && !client.is_served;
      one = is_idle ? clients_.erase(one) : std::next(one);
      continue;
    }
    const std::uint64_t before = std::exchange(client.progress, progress(client.connection));
    if (before != client.progress) client.progress_time = now;
    if (now - client.progress_time > timeout) stalled(client.connection);
    ++one;
  }
}

namespace {

/// A part that owns its bytes.
link::Part part_of(std::vector<std::byte> bytes) {
  const auto owner = std::make_shared<const std::vector<std::byte>>(std::move(bytes));
  return {.bytes = *owner, .owner = owner};
}

link::SocketOptions socket_options(const ServerOptions& options, link::ErrorLog& errors) {
  constexpr std::chrono::milliseconds kLinger{500};  // time for the last reply
  constexpr std::uint64_t kTogether =
      4;  // clients that may send requests of the maximum size at once
  const link::Limits& limits = options.limits;
  const auto request_bytes = static_cast<std::uint64_t>(link::bytes_of_mib(limits.request_mib));
  const auto queue = static_cast<int>(limits.requests);
  return {.send_queue = 2 * queue,  // replies, and errors for requests beyond the limit
          .receive_queue = queue,
          .max_message_bytes = static_cast<std::int64_t>(request_bytes),
          .linger = kLinger,
          .curve = options.curve,
          .protection = link::Protection{
              .limits = link::connection_limits(limits, request_bytes, kTogether * request_bytes),
              .errors = errors}};
}

/// A reply in transit; destroyed in ZeroMQ's thread when it is sent or its client has left.
struct Sent {
  std::vector<link::Part> parts;
  std::shared_ptr<Unread> client;
  std::shared_ptr<Unread> all;
  std::int64_t bytes = 0;

  void count(std::int64_t sign) const {
    for (const auto& unread : {client, all}) {
      unread->replies += sign;
      unread->bytes += sign * bytes;
    }
  }
  Sent(std::vector<link::Part> all_parts, std::shared_ptr<Unread> of_client,
       std::shared_ptr<Unread> of_all)
      : parts(std::move(all_parts)), client(std::move(of_client)), all(std::move(of_all)) {
    for (const link::Part& part : parts) bytes += static_cast<std::int64_t>(part.bytes.size());
    count(1);
  }
  Sent(const Sent&) = delete;
  Sent& operator=(const Sent&) = delete;
  ~Sent() { count(-1); }
};

}  // namespace

Server::Server(link::Context& context, const ServerOptions& options, link::ErrorLog& errors)
    : limits_(options.limits),
      errors_(errors),
      router_(context, socket_options(options, errors), errors),
      queue_(options.limits) {
  router_.bind(options.endpoint);
}

std::optional<Received> Server::receive() {
  constexpr int kMaxRefused = 16;  // per call
  collect();
  cut_off_stalled_clients(std::chrono::seconds(limits_.request_s));
  for (int i = 0; i < kMaxRefused; ++i) {
    std::optional<Waiting> waiting = queue_.next();
    if (!waiting) return std::nullopt;
    ReplyTo to{.from = waiting->message.from, .since = waiting->since};
    if (!is_wanted(to)) {
      drop(to);
    } else if (std::optional<Request> request = read(*waiting, to)) {
      return Received{std::move(*request), std::move(to)};
    }
  }
  return std::nullopt;
}

/// Queues received requests. Requests beyond a client's limits are refused here, so that they
/// neither fill the memory nor delay other clients.
void Server::collect() {
  constexpr int kMaxAtOnce = 256;
  const Clock::time_point now = Clock::now();
  for (int i = 0; i < kMaxAtOnce; ++i) {
    std::optional<link::Delivered> message = router_.receive();
    if (!message) return;
    ++counts_.received;
    const std::string why = queue_.add(*message, now);
    if (!why.empty()) refuse(*message, why);
  }
}

/// The request in progress continues.
void Server::refuse(const link::Delivered& message, std::string_view why) {
  constexpr std::size_t kIdAt = 8;
  const Bytes bytes = message.body.bytes();
  std::uint64_t id = 0;
  if (bytes.size() >= kIdAt + sizeof(id)) std::memcpy(&id, bytes.data() + kIdAt, sizeof(id));
  ++counts_.refused;
  errors_.report("requests refused", why);
  const link::ReturnAddress& to = message.from;
  const auto text = std::as_bytes(std::span(why));
  const std::vector<link::Part> parts = {part_of(encode_text_head(id, TextKind::error)),
                                         part_of({text.begin(), text.end()})};
  (void)router_.reply(to, parts);  // fails for a client that does not read
}

std::optional<Request> Server::read(const Waiting& waiting, ReplyTo& to) {
  try {
    if (!waiting.message.is_single) {
      throw Error({"request", "a message of several parts", "one part"});
    }
    return decode_request(waiting.message.body.bytes(), to.id);
  } catch (const Error& error) {
    reply_error(to, error.what());
    return std::nullopt;
  }
}

void Server::cut_off_stalled_clients(std::chrono::seconds timeout) {
  constexpr std::chrono::milliseconds kServerPause{100};
  const Clock::time_point now = Clock::now();
  if (now - last_check_ < kServerPause) return;
  last_check_ = now;
  queue_.check_clients(
      now, timeout,
      [this](const link::ConnectionId& client) { return router_.socket().taken_bytes(client); },
      [this](const link::ConnectionId& client) {
        router_.socket().cut_off(client, "client cut off", "it does not read its replies");
      });
}

bool Server::is_wanted(const ReplyTo& to) const {
  return router_.socket().is_open(to.from.connection);
}

void Server::drop(const ReplyTo& to) {
  queue_.done(to.from.client);
  reserved_bytes_ -= to.reserved_bytes;
}

bool Server::reserve(ReplyTo& to, std::int64_t bytes) {
  if (to.reserved_bytes > 0) return true;
  const std::int64_t used = held_bytes();
  if (used > 0 && used + bytes > link::bytes_of_mib(limits_.memory_mib)) {
    cut_off_stalled_clients(std::chrono::seconds(1));
    return false;
  }
  to.reserved_bytes = bytes;
  reserved_bytes_ += bytes;
  return true;
}

std::int64_t Server::held_bytes() const {
  return queue_.waiting_bytes() + queue_.all_unread()->bytes + reserved_bytes_;
}

void Server::reply(const ReplyTo& to, std::span<const CloudReply> clouds) {
  std::vector<CloudHead> heads;
  for (const CloudReply& reply : clouds) heads.push_back(reply.head);
  std::vector<link::Part> parts = {part_of(encode_head(to.id, heads, *clouds.front().cloud))};
  for (const CloudReply& reply : clouds) {
    for (const Column& column : reply.cloud->columns) {
      parts.push_back({.bytes = bytes_of(column), .owner = reply.cloud});
    }
  }
  counts_.clouds += clouds.size();
  send(to, std::move(parts));
}

void Server::reply_text(const ReplyTo& to, TextKind kind, std::string_view text) {
  const auto bytes = std::as_bytes(std::span(text));
  send(to, {part_of(encode_text_head(to.id, kind)), part_of({bytes.begin(), bytes.end()})});
}

/// A client that has left needs no reply.
void Server::send(const ReplyTo& to, std::vector<link::Part> parts) {
  drop(to);
  const auto sent = std::make_shared<const Sent>(std::move(parts), queue_.unread_of(to.from),
                                                 queue_.all_unread());
  std::vector<link::Part> shared = sent->parts;
  for (link::Part& part : shared) part.owner = sent;
  if (router_.reply(to.from, shared) != link::Sending::queue_full) return;
  errors_.report("replies not sent", "the client does not read them");
}

void Server::reply_error(const ReplyTo& to, std::string_view text) {
  ++counts_.refused;
  errors_.report("requests refused", text);
  reply_text(to, TextKind::error, text);
}

void Server::reply_description(const ReplyTo& to, std::string_view json) {
  reply_text(to, TextKind::description, json);
}

std::chrono::milliseconds Server::poll_timeout() const {
  constexpr std::chrono::milliseconds kIdle{1000};
  constexpr std::chrono::milliseconds kBusy{50};
  return queue_.has_clients() ? kBusy : kIdle;
}

}  // namespace glidar::lockstep
