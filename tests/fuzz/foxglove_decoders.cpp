// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "foxglove_decoders.hpp"

#include "demand.hpp"

#include <glidar/core/error.hpp>
#include <glidar/link/foxglove/protocol.hpp>

#include <string_view>
#include <variant>

namespace glidar::testing {
namespace {

using foxglove::HttpReply;

void try_routes(std::string_view text) {
  constexpr std::string_view kHost = "localhost:1";
  constexpr std::string_view kOrigin = "http://localhost:1";
  constexpr std::string_view kJson = "application/json";
  link::HttpGuard guard({}, link::HttpClients::own_pages);
  for (const std::string_view target : {"/api/pick", "/api/playback"}) {
    foxglove::route({{"POST", kHost, kOrigin}, target, kJson, text}, guard, {true, true});
    const auto foreign =
        foxglove::route({{"POST", kHost, text}, target, kJson, "{}"}, guard, {true, true});
    const auto* reply = std::get_if<HttpReply>(&foreign);
    demand(reply != nullptr && reply->status >= 400, "foreign pages have no effect");
  }
  foxglove::route({{"GET", kHost}, text}, guard, {});
  foxglove::route({{"GET", text}, "/"}, guard, {});
  link::is_allowed_origin(text, kHost, {});
  foxglove::choose_subprotocol(text);
}

}  // namespace

bool try_foxglove_decoders(std::span<const std::byte> bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  try_routes(text);
  try {
    const auto message = foxglove::decode_client_message(text);
    if (const auto* begin = std::get_if<foxglove::Subscribe>(&message)) {
      demand(begin->subscriptions.size() <= foxglove::kMaxSubscriptions, "subscriptions are few");
    }
    return true;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace glidar::testing
