// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/socket.hpp>

#include "loopback.hpp"
#include "message_bytes.hpp"
#include "raw_peer.hpp"

#include <gmock/gmock.h>

#include <memory>

namespace glidar::link {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::MessageBytes;
using testing::RawPeer;
using testing::soon;

class RouterTest : public ::testing::Test {
 protected:
  RouterTest() {
    router = testing::at_free_port([&](const Endpoint& at) {
      endpoint = at;
      auto made = std::make_unique<Router>(context, SocketOptions{}, errors);
      made->bind(at);
      return made;
    });
  }
  Socket client() {
    Socket socket(context, {.kind = SocketKind::request});
    socket.connect(endpoint);
    return socket;
  }
  Delivered delivered() {
    std::optional<Delivered> found;
    EXPECT_TRUE(soon([&] { return (found = router->receive()).has_value(); }));
    return std::move(*found);
  }
  Sending reply(const Delivered& request, const std::string& text) {
    const std::vector<Part> parts = {part_of(text)};
    return router->reply(request.from, parts);
  }
  static std::string text_of(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }
  /// A peer that is none of ZeroMQ's.
  RawPeer dealer(const std::string& parts) const {
    RawPeer peer(endpoint);
    EXPECT_TRUE(peer.shake("DEALER"));
    EXPECT_TRUE(peer.send(parts));
    return peer;
  }

  std::vector<std::string> said;
  ErrorLog errors{
      {.log = [this](Severity, std::string_view t) { said.emplace_back(t); }, .progress = {}}};
  Context context;
  Endpoint endpoint;
  std::unique_ptr<Router> router;
};

TEST_F(RouterTest, RepliesInAnyOrderReachTheirClients) {
  Socket first = client();
  Socket second = client();
  first.send(MessageBytes().text("first").bytes);
  const Delivered one = delivered();
  second.send(MessageBytes().text("second").bytes);
  const Delivered two = delivered();
  EXPECT_EQ(text_of(one.body.bytes()), "first");
  EXPECT_NE(one.from.client, two.from.client);
  EXPECT_GE(one.from.connection.descriptor, 0);
  EXPECT_EQ(reply(two, "to the second"), Sending::sent);
  EXPECT_EQ(reply(one, "to the first"), Sending::sent);
  EXPECT_EQ(text_of(testing::received(first)), "to the first");
  EXPECT_EQ(text_of(testing::received(second)), "to the second");
}

TEST_F(RouterTest, ReturnsTheEnvelopeOfARequest) {
  using testing::zmtp_part;
  const RawPeer peer =
      dealer(zmtp_part("number", true) + zmtp_part("", true) + zmtp_part("body", false));
  const Delivered request = delivered();
  EXPECT_THAT(request.from.envelope, ElementsAre("number"));
  EXPECT_EQ(text_of(request.body.bytes()), "body");
  EXPECT_TRUE(request.is_single);
}

TEST_F(RouterTest, ReportsThatABodyHasSeveralParts) {
  using testing::zmtp_part;
  const RawPeer peer = dealer(zmtp_part("", true) + zmtp_part("body", true) + zmtp_part("", true) +
                              zmtp_part("more", false));
  const Delivered request = delivered();
  EXPECT_EQ(text_of(request.body.bytes()), "body");
  EXPECT_FALSE(request.is_single);
}

TEST_F(RouterTest, DiscardsAndReportsAMessageWithoutADelimiterOrBody) {
  using testing::zmtp_part;
  std::string many;
  for (int k = 0; k < 9; ++k) many += zmtp_part("x", true);
  const std::string longest(255, 'x');
  const RawPeer peer =
      dealer(zmtp_part("x", false) + zmtp_part("", false) + zmtp_part("x", true) +
             zmtp_part("y", false) + many + zmtp_part("", true) + zmtp_part("body", false) +
             zmtp_part(longest, true) + zmtp_part("", true) + zmtp_part("good", false));
  EXPECT_EQ(text_of(delivered().body.bytes()), "good");
  EXPECT_EQ(errors.counts().at("message discarded"), 4U);
  EXPECT_THAT(said.at(0), HasSubstr("use a REQ socket"));
}

TEST_F(RouterTest, AReplyToAClientThatLeftIsNotSent) {
  Socket stays = client();
  Delivered request;
  {
    Socket leaves = client();
    leaves.send(MessageBytes().text("x").bytes);
    request = delivered();
  }
  EXPECT_TRUE(soon([&] { return reply(request, "late") == Sending::peer_gone; }));
  stays.send(MessageBytes().text("y").bytes);
  EXPECT_EQ(reply(delivered(), "in time"), Sending::sent);
  EXPECT_EQ(text_of(testing::received(stays)), "in time");
}

TEST_F(RouterTest, AClientThatReadsNoRepliesDoesNotBlockOthers) {
  const std::string request = testing::zmtp_part("", true) + testing::zmtp_part("x", false);
  const RawPeer deaf = dealer(request);
  const Delivered asked = delivered();
  const std::string large(1 << 20, 'x');
  EXPECT_TRUE(soon([&] { return reply(asked, large) == Sending::queue_full; }));
  Socket reads = client();
  reads.send(MessageBytes().text("y").bytes);
  EXPECT_EQ(reply(delivered(), "in time"), Sending::sent);
  EXPECT_EQ(text_of(testing::received(reads)), "in time");
}

}  // namespace
}  // namespace glidar::link
