// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/woods2016/protocol.hpp>

#include "link/loopback.hpp"
#include "link/message_bytes.hpp"

#include <gmock/gmock.h>

#include <chrono>
#include <memory>

namespace glidar::woods2016 {
namespace {

using ::testing::HasSubstr;
using testing::MessageBytes;
using testing::soon;
using std::chrono_literals::operator""ms;

/// A simulator's sockets.
struct Simulator {
  link::Socket poses;
  link::Socket hand;

  Simulator(link::Context& context, const link::Endpoint& at)
      : poses(context, {.kind = link::SocketKind::publish, .linger = 1000ms}),
        hand(context, {.kind = link::SocketKind::reply}) {
    poses.bind(at);
    hand.bind({at.host, static_cast<std::uint16_t>(at.port + 1)});
  }
  void send(const std::vector<std::byte>& bytes) { poses.publish(bytes, 1000ms); }
};

std::vector<std::byte> pose(std::uint64_t timestamp) {
  Placement placement;
  placement.timestamp = timestamp;
  const auto bytes = encode_placement(placement);
  return {bytes.begin(), bytes.end()};
}

class PoseReceiverTest : public ::testing::Test {
 protected:
  void start(int queue = 100) {
    simulator = testing::at_free_port([&](const link::Endpoint& at) {
      endpoint = at;
      return std::make_unique<Simulator>(context, at);
    });
    receiver = std::make_unique<PoseReceiver>(
        context, PoseReceiverOptions{.endpoint = endpoint, .queue = queue}, errors);
  }
  bool shake() {
    bool is_answered = false;
    return soon([&] {
      if (!is_answered && simulator->hand.receive()) is_answered = simulator->hand.send({});
      return receiver->is_ready() && is_answered;
    });
  }
  std::optional<std::uint64_t> next_timestamp() {
    std::optional<Placement> placement;
    soon([&] { return (placement = receiver->receive()).has_value() || receiver->is_over(); });
    return placement ? std::optional(placement->timestamp) : std::nullopt;
  }

  std::vector<std::string> said;
  link::ErrorLog errors{
      {.log = [this](Severity, std::string_view t) { said.emplace_back(t); }, .progress = {}}};
  link::Context context;
  link::Endpoint endpoint;
  std::unique_ptr<Simulator> simulator;
  std::unique_ptr<PoseReceiver> receiver;
};

TEST_F(PoseReceiverTest, MissesNoPoseSentAfterTheHandshake) {
  start();
  ASSERT_TRUE(shake());
  for (std::uint64_t stamp = 1; stamp <= 5; ++stamp) simulator->send(pose(stamp));
  for (std::uint64_t stamp = 1; stamp <= 5; ++stamp) EXPECT_EQ(next_timestamp(), stamp);
  EXPECT_TRUE(said.empty());
}

TEST_F(PoseReceiverTest, EndsWithTheEndMessage) {
  start();
  ASSERT_TRUE(shake());
  simulator->send(pose(1));
  simulator->send(MessageBytes().text("vKTHXBAI").bytes);
  EXPECT_EQ(next_timestamp(), 1U);
  EXPECT_EQ(next_timestamp(), std::nullopt);
  EXPECT_TRUE(receiver->is_over());
}

TEST_F(PoseReceiverTest, SkipsInvalidMessages) {
  start();
  ASSERT_TRUE(shake());
  std::vector<std::byte> huge(std::size_t{1} << 20U, std::byte{'v'});
  simulator->send(MessageBytes().text("v").bytes);
  simulator->send(huge);
  simulator->send(pose(3));
  EXPECT_EQ(next_timestamp(), 3U);
  EXPECT_EQ(receiver->counts().refused, 2U);
  EXPECT_THAT(
      said, ::testing::ElementsAre(HasSubstr("pose refused: pose message ('v'): it has 1 bytes")));
}

TEST_F(PoseReceiverTest, CutsOffALargeSenderAndReconnects) {
  start();
  ASSERT_TRUE(shake());
  simulator->send(std::vector<std::byte>((std::size_t{16} << 20U) + 1, std::byte{'v'}));
  ASSERT_TRUE(soon([&] {
    receiver->receive();
    return !said.empty();
  }));
  EXPECT_THAT(said[0], HasSubstr("more than 16 MiB"));
  ASSERT_TRUE(soon([&] {
    simulator->send(pose(9));
    return receiver->receive().has_value();
  }));
}

TEST_F(PoseReceiverTest, SkipsRepeatedTimestampsAndReportsEarlierOnes) {
  start();
  ASSERT_TRUE(shake());
  for (const std::uint64_t stamp : {4, 4, 4, 2, 3}) simulator->send(pose(stamp));
  EXPECT_EQ(next_timestamp(), 4U);
  EXPECT_EQ(next_timestamp(), 2U);
  EXPECT_EQ(next_timestamp(), 3U);
  EXPECT_EQ(receiver->counts().repeated, 2U);
  EXPECT_EQ(receiver->counts().backwards, 1U);
}

TEST_F(PoseReceiverTest, DoesNotReportASimulatorThatEndedAsLost) {
  start();
  ASSERT_TRUE(shake());
  constexpr std::uint64_t kPoses = 10;
  for (std::uint64_t stamp = 1; stamp <= kPoses; ++stamp) simulator->send(pose(stamp));
  simulator->send(encode_shutdown("v"));
  simulator.reset();
  ASSERT_TRUE(soon([&] { return !testing::has_connections(endpoint.port); }));  // none is read yet
  for (std::uint64_t stamp = 1; stamp <= kPoses; ++stamp) EXPECT_EQ(next_timestamp(), stamp);
  EXPECT_EQ(next_timestamp(), std::nullopt);
  EXPECT_TRUE(receiver->is_over());
  EXPECT_TRUE(said.empty());
}

TEST_F(PoseReceiverTest, IsReadyIfASimulatorSentAllItsPosesAndLeftBeforeItsReplyWasRead) {
  start();
  ASSERT_TRUE(soon([&] { return !receiver->is_ready() && simulator->hand.receive().has_value(); }));
  simulator->send(pose(1));
  simulator->send(encode_shutdown("v"));
  simulator.reset();  // without a reply, as if it came too late
  ASSERT_TRUE(soon([&] { return receiver->is_ready(); }));
  EXPECT_EQ(next_timestamp(), 1U);
  EXPECT_EQ(next_timestamp(), std::nullopt);
  EXPECT_TRUE(receiver->is_over());
}

TEST_F(PoseReceiverTest, ReconnectsToARestartedSimulator) {
  start();
  ASSERT_TRUE(shake());
  simulator.reset();
  ASSERT_TRUE(soon([&] {
    receiver->receive();
    return !said.empty();
  }));
  EXPECT_THAT(said[0], HasSubstr("simulator lost"));
  ASSERT_TRUE(soon([&] {
    try {
      simulator = std::make_unique<Simulator>(context, endpoint);
      return true;
    } catch (const Error&) {
      return false;
    }
  }));
  bool is_answered = false;
  ASSERT_TRUE(soon([&] {
    receiver->receive();
    if (!is_answered && simulator->hand.receive()) is_answered = simulator->hand.send({});
    return is_answered;
  }));
  simulator->send(pose(1));
  EXPECT_EQ(next_timestamp(), 1U);
}

}  // namespace
}  // namespace glidar::woods2016
