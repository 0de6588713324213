// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/router.hpp>

#include <cstddef>
#include <memory>
#include <utility>

namespace glidar::link {
namespace {

constexpr std::size_t kMaxEnvelopeParts = 8;
constexpr std::size_t kMaxEnvelopePart_bytes = 255;  // the maximum size of identities

/// Maximum number of malformed messages that one call discards.
constexpr int kMaxDiscarded = 64;

SocketOptions as_router(SocketOptions options) {
  options.kind = SocketKind::router;
  return options;
}

std::string text_of(const Message& message) {
  return {reinterpret_cast<const char*>(message.bytes().data()), message.bytes().size()};
}

}  // namespace

Part part_of(std::string bytes) {
  const auto owner = std::make_shared<const std::string>(std::move(bytes));
  return {.bytes = std::as_bytes(std::span(*owner)), .owner = owner};
}

Router::Router(Context& context, SocketOptions options, ErrorLog& errors)
    : errors_(errors), socket_(context, as_router(std::move(options))) {}

std::optional<Delivered> Router::receive() {
  for (int i = 0; i < kMaxDiscarded; ++i) {
    const std::optional<Message> identity = socket_.receive();
    if (!identity) return std::nullopt;
    if (std::optional<Delivered> delivered = read(*identity)) return delivered;
    errors_.report(
        "message discarded",
        "a peer sent a message without the empty part that precedes a request; use a REQ "
        "socket, or a DEALER that sends an empty part first");
  }
  return std::nullopt;
}

/// Reads all parts of a message, which arrive together.
std::optional<Delivered> Router::read(const Message& identity) {
  Delivered delivered{.from = {.client = text_of(identity)}, .body = {}};
  bool has_delimiter = false;
  bool has_body = false;
  for (bool is_last = identity.is_last(); !is_last;) {
    std::optional<Message> part = socket_.receive();
    if (!part) break;
    is_last = part->is_last();
    if (has_body) {
      delivered.is_single = false;
    } else if (has_delimiter) {
      delivered.from.connection = part->connection();
      delivered.body = std::move(*part);
      has_body = true;
    } else if (part->bytes().empty()) {
      has_delimiter = true;
    } else if (delivered.from.envelope.size() < kMaxEnvelopeParts &&
               part->bytes().size() <= kMaxEnvelopePart_bytes) {
      delivered.from.envelope.push_back(text_of(*part));
    } else {
      while (!is_last && (part = socket_.receive())) is_last = part->is_last();
    }
  }
  if (!has_body) return std::nullopt;
  return delivered;
}

Sending Router::reply(const ReturnAddress& to, std::span<const Part> parts) {
  std::vector<Part> all = {part_of(to.client)};
  for (const std::string& part : to.envelope) all.push_back(part_of(part));
  all.push_back({});  // the delimiter
  all.insert(all.end(), parts.begin(), parts.end());
  return socket_.send_parts(all);
}

}  // namespace glidar::link
