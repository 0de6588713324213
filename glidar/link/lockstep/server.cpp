// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/lockstep/server.hpp>

#include <glidar/core/error.hpp>

#include <utility>
#include <vector>

namespace glidar::lockstep {
namespace {

/// Bytes that keep themselves.
link::Part part_of(std::vector<std::byte> bytes) {
  const auto owner = std::make_shared<const std::vector<std::byte>>(std::move(bytes));
  return {.bytes = *owner, .owner = owner};
}

link::SocketOptions socket_options(const ServerOptions& options) {
  constexpr std::chrono::milliseconds kLinger{500};  // for the last reply
  return {.kind = link::SocketKind::reply,
          .largest_message_bytes = static_cast<std::int64_t>(kLargestRequest_bytes),
          .linger = kLinger,
          .curve = options.curve};
}

}  // namespace

Server::Server(link::Context& context, const ServerOptions& options, link::FaultLog& faults)
    : faults_(faults), socket_(context, socket_options(options)) {
  socket_.bind(options.endpoint);
}

std::optional<Request> Server::receive() {
  std::optional<link::Message> message = socket_.receive();
  if (!message) return std::nullopt;
  ++counts_.received;
  const bool is_single = message->is_whole();
  while (!message->is_last()) message = socket_.receive();  // parts come together
  std::uint64_t id = 0;
  try {
    if (!is_single) {
      throw Error({"request", "a message of several parts", "one part", ""});
    }
    return decode_request(message->bytes(), id);
  } catch (const Error& error) {
    reply_error(id, error.what());
    return std::nullopt;
  }
}

void Server::reply(std::uint64_t id, std::span<const CloudReply> clouds) {
  std::vector<CloudHead> heads;
  for (const CloudReply& reply : clouds) heads.push_back(reply.head);
  std::vector<link::Part> parts = {part_of(encode_head(id, heads, *clouds.front().cloud))};
  for (const CloudReply& reply : clouds) {
    for (const Column& column : reply.cloud->columns) {
      parts.push_back({.bytes = bytes_of(column), .owner = reply.cloud});
    }
  }
  counts_.clouds += clouds.size();
  if (!socket_.send_parts(parts)) faults_.tell("replies not sent", "the client's queue is full");
}

void Server::reply_text(std::uint64_t id, TextKind kind, std::string_view text) {
  const auto bytes = std::as_bytes(std::span(text));
  const std::vector<link::Part> parts = {part_of(encode_text_head(id, kind)),
                                         part_of({bytes.begin(), bytes.end()})};
  if (!socket_.send_parts(parts)) faults_.tell("replies not sent", "the client's queue is full");
}

void Server::reply_error(std::uint64_t id, std::string_view text) {
  ++counts_.refused;
  faults_.tell("requests refused", text);
  reply_text(id, TextKind::error, text);
}

void Server::reply_description(std::uint64_t id, std::string_view json) {
  reply_text(id, TextKind::description, json);
}

}  // namespace glidar::lockstep
