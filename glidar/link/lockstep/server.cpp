// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/lockstep/server.hpp>

#include <glidar/core/error.hpp>

#include <cstring>
#include <utility>
#include <vector>

namespace glidar::lockstep {

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
