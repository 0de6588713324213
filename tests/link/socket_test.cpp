// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/socket.hpp>

#include "loopback.hpp"

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <memory>

namespace glidar::link {
namespace {

/// ZeroMQ holds 1000 events on either side of a monitor's queue; each visit is two of them.
constexpr int kVisits = 1200;

/// Whether a visitor's request is answered.
bool visit(Context& context, const Endpoint& at, Socket& server) {
  constexpr std::array kWord = {std::byte{'?'}};
  Socket visitor(context, {.kind = SocketKind::request});
  visitor.connect(at);
  if (!visitor.send(kWord)) return false;
  constexpr std::chrono::milliseconds kPollInterval{2};
  return testing::soon([&] {
    wait_for({&server}, -1, kPollInterval);
    if (server.receive()) server.send(kWord);
    wait_for({&visitor}, -1, kPollInterval);
    return visitor.receive().has_value();
  });
}

class Visits : public ::testing::TestWithParam<bool> {};

TEST_P(Visits, MayBeManyWhetherOrNotAnybodyAsksForEvents) {
  Context context;
  Endpoint at;
  const auto server = testing::at_free_port([&](const Endpoint& endpoint) {
    at = endpoint;
    auto socket = std::make_unique<Socket>(
        context, SocketOptions{.kind = SocketKind::reply, .reports_events = GetParam()});
    socket->bind(endpoint);
    return socket;
  });
  for (int k = 0; k < kVisits; ++k) ASSERT_TRUE(visit(context, at, *server)) << k;
  std::size_t events = 0;
  if (GetParam()) {  // each came and left
    EXPECT_TRUE(testing::soon([&] { return (events += server->events().size()) == 2U * kVisits; }));
  } else {
    EXPECT_TRUE(server->events().empty());
  }
}

INSTANTIATE_TEST_SUITE_P(Sockets, Visits, ::testing::Bool(), [](const auto& reports_events) {
  return reports_events.param ? "watched" : "unwatched";
});

}  // namespace
}  // namespace glidar::link
