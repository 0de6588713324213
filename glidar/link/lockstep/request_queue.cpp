// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/lockstep/request_queue.hpp>

#include <glidar/core/error.hpp>

#include <utility>

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

}  // namespace glidar::lockstep
