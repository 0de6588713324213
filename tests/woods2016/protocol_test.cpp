// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/math/constants.hpp>

#include <glidar/woods2016/protocol.hpp>

#include "link/loopback.hpp"
#include "link/message_bytes.hpp"
#include "link/raw_peer.hpp"
#include "support/error_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <memory>

namespace glidar::woods2016 {
namespace {

using ::testing::HasSubstr;
using testing::MessageBytes;

MessageBytes placement_bytes(std::array<double, 11> numbers) {
  MessageBytes message;
  message.text("v").raw({7, 0, 0, 0, 0, 0, 0, 0x80});
  for (const double number : numbers) message.number(number);
  return message;
}

constexpr std::array<double, 11> kNumbers = {0.6,  0.0, 0.8, 0.0, 1.0, -2.0,
                                             30.0, 1.0, 0.0, 0.0, 0.0};

TEST(PlacementMessage, IsReadFromBytesWrittenByHand) {
  const MessageBytes message = placement_bytes(kNumbers);
  ASSERT_EQ(message.bytes.size(), 97U);
  const Placement placement = decode_placement(message.bytes);
  EXPECT_EQ(placement.timestamp, 0x8000000000000007U);
  EXPECT_DOUBLE_EQ(placement.object.w(), 0.6);
  EXPECT_DOUBLE_EQ(placement.object.y(), 0.8);
  EXPECT_EQ(placement.translation_m, Eigen::Vector3d(1.0, -2.0, 30.0));
  EXPECT_EQ(placement.sensor.w(), 1.0);
}

TEST(PlacementMessage, WritesTheBytesItReads) {
  const MessageBytes message = placement_bytes(kNumbers);
  const auto written = encode_placement(decode_placement(message.bytes));
  EXPECT_TRUE(
      std::equal(written.begin(), written.end(), message.bytes.begin(), message.bytes.end()));
}

TEST(PlacementMessage, WrongSizeIsAnErrorWithBothSizes) {
  MessageBytes message = placement_bytes(kNumbers);
  message.bytes.pop_back();
  EXPECT_THAT(error_text([&] { decode_placement(message.bytes); }),
              ::testing::AllOf(HasSubstr("96 bytes"), HasSubstr("97")));
  message.bytes.resize(98);
  EXPECT_THAT(error_text([&] { decode_placement(message.bytes); }), HasSubstr("98 bytes"));
  message.bytes.resize(std::size_t{1} << 24U);
  EXPECT_THAT(error_text([&] { decode_placement(message.bytes); }), HasSubstr("16777216 bytes"));
  for (std::size_t size = 1; size < 97; ++size) {
    message.bytes.resize(size);
    EXPECT_THROW(decode_placement(message.bytes), Error) << size;
  }
  EXPECT_THAT(error_text([] { decode_placement({}); }), HasSubstr("it is empty"));
}

TEST(PlacementMessage, WrongTypeIsAnErrorWithTheFirstByte) {
  MessageBytes message = placement_bytes(kNumbers);
  message.bytes[0] = std::byte{'c'};
  EXPECT_THAT(error_text([&] { decode_placement(message.bytes); }), HasSubstr("'c'; allowed: 'v'"));
  message.bytes[0] = std::byte{0x07};
  EXPECT_THAT(error_text([&] { decode_placement(message.bytes); }), HasSubstr("0x07"));
}

TEST(PlacementMessage, NumbersThatAreNotFiniteAreErrorsWithTheirName) {
  const std::array<const char*, 11> names = {
      "object w",      "object x", "object y", "object z", "translation x", "translation y",
      "translation z", "sensor w", "sensor x", "sensor y", "sensor z"};
  for (std::size_t i = 0; i < names.size(); ++i) {
    for (const double bad : {kNaN, HUGE_VAL, -HUGE_VAL}) {
      auto numbers = kNumbers;
      numbers.at(i) = bad;
      EXPECT_THAT(error_text([&] { decode_placement(placement_bytes(numbers).bytes); }),
                  HasSubstr(names.at(i)));
    }
  }
}

TEST(PlacementMessage, PositionsTooFarAwayAreErrors) {
  auto numbers = kNumbers;
  numbers[5] = -1e15;
  EXPECT_NO_THROW(decode_placement(placement_bytes(numbers).bytes));
  numbers[5] = -1.1e15;
  EXPECT_THAT(error_text([&] { decode_placement(placement_bytes(numbers).bytes); }),
              HasSubstr("translation y is -1.1e+15"));
}

TEST(PlacementMessage, QuaternionsOfWrongLengthAreErrors) {
  for (const double length : {0.0, 0.998, 1.002, 2.0, 1e-300, 1e300}) {
    auto numbers = kNumbers;
    numbers[7] = length;
    EXPECT_THAT(error_text([&] { decode_placement(placement_bytes(numbers).bytes); }),
                HasSubstr("the sensor's quaternion has the length"))
        << length;
  }
}

TEST(PlacementMessage, SinglePrecisionQuaternionsAreNormalised) {
  auto numbers = kNumbers;
  numbers[0] = 0.6F;
  numbers[2] = 0.8F;
  EXPECT_NEAR(decode_placement(placement_bytes(numbers).bytes).object.norm(), 1.0, 1e-15);
}

PointCloud encoded_cloud(std::vector<double> xyz, std::vector<float> intensity) {
  const auto points = static_cast<std::uint32_t>(intensity.size());
  PointCloud cloud{1, points, "legacy", Pose::Identity(), {}};
  cloud.columns.push_back({"xyz", {"x", "y", "z"}, std::move(xyz)});
  cloud.columns.push_back({"intensity", {"intensity"}, std::move(intensity)});
  return cloud;
}

std::vector<std::byte> encoded(const PointCloud& cloud, std::uint64_t timestamp) {
  std::vector<std::byte> bytes(cloud_bytes(cloud.size()));
  bytes.resize(encode_cloud(cloud, timestamp, bytes));
  return bytes;
}

TEST(CloudMessage, HasTheDocumentedBytesWithoutMisses) {
  const PointCloud cloud =
      encoded_cloud({1.0, 2.0, -0.5, kNaN, kNaN, kNaN, 0.25, 0.0, 8.0}, {0.5F, 0.0F, 1.0F});
  const MessageBytes expected = MessageBytes()
                                    .text("c")
                                    .raw({5, 1, 0, 0, 0, 0, 0, 0})
                                    .raw({0, 0, 0x80, 0x3f, 0, 0, 0, 0x40, 0, 0, 0, 0xbf})
                                    .raw({0, 0, 0, 0x3f})
                                    .raw({0, 0, 0x80, 0x3e, 0, 0, 0, 0, 0, 0, 0, 0x41})
                                    .raw({0, 0, 0x80, 0x3f});
  EXPECT_EQ(encoded(cloud, 261), expected.bytes);
}

TEST(CloudMessage, WithoutHitsIsTheHeaderOnly) {
  const PointCloud cloud = encoded_cloud({kNaN, kNaN, kNaN}, {0.0F});
  EXPECT_EQ(encoded(cloud, 0).size(), 9U);
  EXPECT_TRUE(decode_cloud(encoded(cloud, 0)).points.empty());
}

TEST(CloudMessage, RoundTripsLosslessly) {
  const Cloud cloud =
      decode_cloud(encoded(encoded_cloud({1.0, 2.0, 3.0}, {0.5F}), ~std::uint64_t{0}));
  EXPECT_EQ(cloud.timestamp, ~std::uint64_t{0});
  ASSERT_EQ(cloud.points.size(), 1U);
  EXPECT_EQ(cloud.points[0].z_m, 3.0F);
  EXPECT_EQ(cloud.points[0].intensity, 0.5F);
}

TEST(CloudMessage, IncompletePointsAreErrors) {
  std::vector<std::byte> bytes = encoded(encoded_cloud({1.0, 2.0, 3.0}, {0.5F}), 1);
  bytes.pop_back();
  EXPECT_THAT(error_text([&] { decode_cloud(bytes); }), HasSubstr("24 bytes"));
  EXPECT_THAT(error_text([&] { decode_cloud(std::span(bytes).first(8)); }), HasSubstr("8 bytes"));
  EXPECT_THAT(error_text([] { decode_cloud({}); }), HasSubstr("it is empty"));
  const auto nan = MessageBytes().text("c").number(std::uint64_t{1}).number(1.0F).number(kNaNf);
  MessageBytes with_nan = nan;
  with_nan.number(0.0F).number(0.0F);
  EXPECT_THAT(error_text([&] { decode_cloud(with_nan.bytes); }), HasSubstr("point 0"));
}

TEST(CloudMessage, RequiresItsColumnsAndABufferOfItsSize) {
  PointCloud cloud = encoded_cloud({1.0, 2.0, 3.0}, {0.5F});
  std::vector<std::byte> small(cloud_bytes(1) - 1);
  EXPECT_THAT(error_text([&] { encode_cloud(cloud, 1, small); }), HasSubstr("24 bytes"));
  cloud.columns.pop_back();
  EXPECT_THAT(error_text([&] { encoded(cloud, 1); }), HasSubstr("no column intensity"));
}

TEST(ShutdownMessage, HasEightBytesForAnyTopic) {
  const auto bytes = encode_shutdown("c");
  EXPECT_EQ(MessageBytes().text("cKTHXBAI").bytes, std::vector(bytes.begin(), bytes.end()));
  EXPECT_TRUE(is_shutdown(MessageBytes().text("vKTHXBAI").bytes));
  EXPECT_FALSE(is_shutdown(MessageBytes().text("vKTHXBAI!").bytes));
  EXPECT_FALSE(is_shutdown(MessageBytes().text("vKTHXBA").bytes));
  EXPECT_FALSE(is_shutdown({}));
}

TEST(HandshakeMatch, NothingIsPendingAtFirst) {
  const HandshakeMatch match;
  EXPECT_EQ(match.pending(), 0U);
  EXPECT_EQ(match.matched(), 0U);
}

TEST(HandshakeMatch, ASubscriptionMayArriveBeforeOrAfterTheHandshake) {
  HandshakeMatch match;
  match.set_subscribers(1);
  match.add_handshake();
  EXPECT_EQ(match.pending(), 0U);
  match.add_handshake();
  EXPECT_EQ(match.pending(), 1U);
  match.set_subscribers(2);
  EXPECT_EQ(match.pending(), 0U);
  EXPECT_EQ(match.matched(), 2U);
}

TEST(HandshakeMatch, EachSubscriberMatchesOneHandshake) {
  HandshakeMatch match;
  match.set_subscribers(1);
  match.add_handshake();
  match.add_handshake();
  match.set_subscribers(1);
  EXPECT_EQ(match.pending(), 1U);
}

TEST(HandshakeMatch, ASubscriberThatLeftStaysMatched) {
  HandshakeMatch match;
  match.add_handshake();
  match.set_subscribers(1);
  match.set_subscribers(0);
  EXPECT_EQ(match.pending(), 0U);
  EXPECT_EQ(match.matched(), 1U);
}

TEST(HandshakeMatch, AReturningSubscriberIsNotMatchedWithTheNextPeer) {
  HandshakeMatch match;
  match.add_handshake();
  match.set_subscribers(1);
  match.set_subscribers(0);
  match.set_subscribers(1);
  match.add_handshake();
  EXPECT_EQ(match.pending(), 1U);
}

TEST(HandshakeMatch, ASubscriberThatLeftBeforeItsHandshakeIsExpectedAgain) {
  HandshakeMatch match;
  match.set_subscribers(1);
  match.set_subscribers(0);
  match.add_handshake();
  EXPECT_EQ(match.pending(), 1U);
}

TEST(HandshakeMatch, LateSubscriptionsMatchTheOldHandshakes) {
  HandshakeMatch match;
  match.add_handshake();
  match.stop_waiting();
  EXPECT_EQ(match.pending(), 0U);
  EXPECT_EQ(match.matched(), 0U);
  match.set_subscribers(1);
  match.add_handshake();
  EXPECT_EQ(match.pending(), 1U);
  match.set_subscribers(2);
  EXPECT_EQ(match.pending(), 0U);
}

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

using std::chrono_literals::operator""ms;
using testing::received;

PointCloud cloud_of(std::uint32_t points) {
  PointCloud cloud{1, points, "legacy", Pose::Identity(), {}};
  cloud.columns.push_back({"xyz", {"x", "y", "z"}, std::vector<double>(3 * points, 2.0)});
  cloud.columns.push_back({"intensity", {"intensity"}, std::vector<float>(points, 0.5F)});
  return cloud;
}

class CloudPublisherTest : public ::testing::Test {
 protected:
  void publish(CloudPublisherOptions options = {}) {
    publisher = testing::at_free_port([&](const link::Endpoint& at) {
      endpoint = options.endpoint = at;
      return std::make_unique<CloudPublisher>(context, options, errors);
    });
  }
  link::Socket subscriber(int queue = 1000, const std::string& topic = "c") {
    link::Socket socket(context, {.kind = link::SocketKind::subscribe,
                                  .receive_queue = queue,
                                  .max_message_bytes = std::int64_t{1} << 30});
    socket.subscribe(topic);
    socket.connect(endpoint);
    return socket;
  }
  /// A peer that has shaken hands.
  link::Socket shaken_hand() {
    link::Socket hand(context, {.kind = link::SocketKind::request});
    hand.connect({endpoint.host, static_cast<std::uint16_t>(endpoint.port + 1)});
    hand.send({});
    EXPECT_TRUE(soon([&] {
      publisher->serve();
      return hand.receive().has_value();
    }));
    return hand;
  }
  bool becomes_ready(std::uint64_t subscribers) {
    return soon([&] {
      publisher->serve();
      return publisher->has(subscribers);
    });
  }
  /// True if it stays unready in repeated checks.
  bool stays_unready(std::uint64_t subscribers) {
    for (int k = 0; k < 100; ++k) {
      publisher->serve();
      if (publisher->has(subscribers)) return false;
    }
    return true;
  }
  bool has_subscribers(std::uint64_t count) {
    return soon([&] {
      publisher->serve();
      return publisher->counts().subscribers == count;
    });
  }
  void send(std::uint32_t number, std::int64_t stamp_ns = 0, std::uint32_t points = 1) {
    Frame frame;
    frame.number = number;
    frame.stamp_ns = stamp_ns;
    publisher->write(cloud_of(points), frame);
  }

  std::vector<std::string> said;
  link::ErrorLog errors{
      {.log = [this](Severity, std::string_view t) { said.emplace_back(t); }, .progress = {}}};
  link::Context context;
  link::Endpoint endpoint;
  std::unique_ptr<CloudPublisher> publisher;
};

TEST_F(CloudPublisherTest, SendsOneMessageForEachCloudAndThenTheShutdown) {
  publish();
  link::Socket socket = subscriber();
  ASSERT_TRUE(has_subscribers(1));
  send(0);
  publisher->shut_down();
  const Cloud cloud = decode_cloud(received(socket));
  EXPECT_EQ(cloud.timestamp, 1U);
  ASSERT_EQ(cloud.points.size(), 1U);
  EXPECT_EQ(cloud.points[0].x_m, 2.0F);
  EXPECT_EQ(received(socket), testing::MessageBytes().text("cKTHXBAI").bytes);
}

TEST_F(CloudPublisherTest, AnswersHandshakesAtTheNextPort) {
  publish();
  link::Socket socket = subscriber();
  link::Socket hand(context, {.kind = link::SocketKind::request});
  hand.connect({endpoint.host, static_cast<std::uint16_t>(endpoint.port + 1)});
  hand.send({});
  EXPECT_TRUE(publisher->has(0));
  EXPECT_FALSE(publisher->has(1));
  ASSERT_TRUE(soon([&] {
    publisher->serve();
    return publisher->has(1);
  }));
  ASSERT_TRUE(soon([&] { return hand.receive().has_value(); }));
  EXPECT_EQ(publisher->counts().handshakes, 1U);
}

/// No time out in the tests below that wait for a subscription.
constexpr std::chrono::hours kForever{1000};

TEST_F(CloudPublisherTest, WaitsForTheSubscriptionOfAPeerThatShookHandsFirst) {
  publish({.subscription_timeout = kForever});
  const link::Socket hand = shaken_hand();
  EXPECT_TRUE(stays_unready(1));
  EXPECT_EQ(publisher->ready(), 0U);
  link::Socket socket = subscriber();
  ASSERT_TRUE(becomes_ready(1));
  EXPECT_EQ(publisher->ready(), 1U);
  send(0);
  EXPECT_EQ(decode_cloud(received(socket)).timestamp, 1U);
  EXPECT_TRUE(said.empty());
}

TEST_F(CloudPublisherTest, WaitsForOneSubscriptionOfEachPeerThatShookHands) {
  publish({.subscription_timeout = kForever});
  link::Socket first = subscriber();
  first.subscribe("cK");  // two subscriptions of one peer
  ASSERT_TRUE(has_subscribers(1));
  const link::Socket hand = shaken_hand();
  ASSERT_TRUE(becomes_ready(1));
  const link::Socket another_hand = shaken_hand();
  EXPECT_TRUE(stays_unready(1));
  EXPECT_TRUE(stays_unready(2));
  link::Socket second = subscriber();
  ASSERT_TRUE(becomes_ready(2));
  send(0);
  EXPECT_EQ(decode_cloud(received(first)).timestamp, 1U);
  EXPECT_EQ(decode_cloud(received(second)).timestamp, 1U);
}

TEST_F(CloudPublisherTest, WaitsForASubscriptionToATopicThatItSends) {
  publish({.subscription_timeout = kForever});
  publisher->set_topics({{1, rig_topic("lidar")}, {2, rig_topic("camera")}});
  const link::Socket stranger = subscriber(1000, "/radar");
  const link::Socket hand = shaken_hand();
  EXPECT_TRUE(stays_unready(1));
  const link::Socket socket = subscriber(1000, rig_topic("camera"));
  EXPECT_TRUE(becomes_ready(1));
  EXPECT_EQ(publisher->counts().subscribers, 1U);
}

TEST_F(CloudPublisherTest, CountsAPeerWithTheTopicsOfSeveralSensorsOnce) {
  publish({.subscription_timeout = kForever});
  publisher->set_topics({{1, rig_topic("lidar")}, {2, rig_topic("camera")}});
  link::Socket both(context, {.kind = link::SocketKind::subscribe});
  both.subscribe(rig_topic("lidar"));
  both.subscribe(rig_topic("camera"));
  both.connect(endpoint);
  const link::Socket hand = shaken_hand();
  ASSERT_TRUE(becomes_ready(1));
  EXPECT_EQ(publisher->counts().subscribers, 1U);
}

TEST_F(CloudPublisherTest, DoesNotCountAReturningPeerTwice) {
  publish({.subscription_timeout = kForever});
  const link::Socket hand = shaken_hand();
  auto socket = std::make_unique<link::Socket>(subscriber());
  ASSERT_TRUE(becomes_ready(1));
  socket.reset();
  ASSERT_TRUE(has_subscribers(0));
  socket = std::make_unique<link::Socket>(subscriber());
  ASSERT_TRUE(has_subscribers(1));
  const link::Socket another_hand = shaken_hand();
  EXPECT_TRUE(stays_unready(2));
  const link::Socket another = subscriber();
  EXPECT_TRUE(becomes_ready(2));
}

TEST_F(CloudPublisherTest, StopsWaitingForAPeerThatNeverSubscribesAndReportsItOnce) {
  publish({.subscription_timeout = 50ms});
  const link::Socket hand = shaken_hand();
  ASSERT_TRUE(becomes_ready(1));
  EXPECT_TRUE(publisher->has(1));
  publisher->shut_down();
  EXPECT_THAT(said, ::testing::ElementsAre(HasSubstr(
                        "1 peer has shaken hands but not subscribed to clouds within 0.05 s")));
  EXPECT_EQ(errors.counts().at("subscription missing"), 1U);
}

TEST_F(CloudPublisherTest, ReportsTheTopicsOfARigForAMissingSubscription) {
  publish({.subscription_timeout = 0ms});
  publisher->set_topics({{1, rig_topic("lidar")}});
  const link::Socket hand = shaken_hand();
  ASSERT_TRUE(becomes_ready(1));
  EXPECT_THAT(said, ::testing::ElementsAre(HasSubstr("'/NAME' and a zero byte")));
}

TEST_F(CloudPublisherTest, DoesNotWaitIfNoSubscribersAreRequested) {
  publish({.subscription_timeout = kForever});
  EXPECT_TRUE(publisher->has(0));
  const link::Socket hand = shaken_hand();
  EXPECT_TRUE(publisher->has(0));
}

TEST_F(CloudPublisherTest, KeepingTheNewestWaitsForTheConnectionOfAPeer) {
  publish({.keeps_newest = true, .subscription_timeout = kForever});
  const link::Socket hand = shaken_hand();
  EXPECT_TRUE(stays_unready(1));
  link::Socket socket = subscriber();
  ASSERT_TRUE(becomes_ready(1));
  send(0);
  EXPECT_EQ(decode_cloud(received(socket)).timestamp, 1U);
}

TEST_F(CloudPublisherTest, AnswersAndReportsAHandshakeWithContent) {
  publish();
  link::Socket hand(context, {.kind = link::SocketKind::request});
  hand.connect({endpoint.host, static_cast<std::uint16_t>(endpoint.port + 1)});
  hand.send(testing::MessageBytes().text("hello").bytes);
  ASSERT_TRUE(soon([&] {
    publisher->serve();
    return publisher->counts().handshakes == 1;
  }));
  EXPECT_TRUE(soon([&] { return hand.receive().has_value(); }));
  EXPECT_THAT(said, ::testing::ElementsAre(HasSubstr("more than the empty message")));
}

TEST_F(CloudPublisherTest, AnswersEveryHandshakeAmongPeersThatSendGarbage) {
  publish();
  const link::Endpoint hands = {endpoint.host, static_cast<std::uint16_t>(endpoint.port + 1)};
  const std::vector<testing::Garbage> garbage = testing::garbage();
  for (std::size_t k = 0; k < 4 * garbage.size(); ++k) {
    const testing::RawPeer stranger = testing::stranger(hands, garbage[k % garbage.size()]);
    const link::Socket hand = shaken_hand();
  }
  EXPECT_GE(publisher->counts().handshakes, 4 * garbage.size());
}

TEST_F(CloudPublisherTest, CutsOffAPeerThatSubscribesEndlessly) {
  publish();
  const testing::RawPeer flood(endpoint);
  ASSERT_TRUE(flood.shake("SUB"));
  int topic = 0;
  EXPECT_TRUE(soon([&] {
    const std::string name = std::to_string(topic++) + std::string(40, 't');
    flood.send(testing::zmtp_part('\1' + name, false) +
               testing::zmtp_part(std::string(1, '\0') + name, false));
    publisher->serve();
    return flood.is_closed();
  }));
  EXPECT_EQ(errors.counts().count("peer cut off"), 1U);
  link::Socket steady = subscriber();
  EXPECT_TRUE(has_subscribers(1));
}

TEST_F(CloudPublisherTest, SendsACloudOncePerTimestamp) {
  publish({.timestamps = Timestamps::of_poses});
  link::Socket socket = subscriber();
  ASSERT_TRUE(has_subscribers(1));
  for (const std::int64_t stamp : {0, 0, -1, 7, 7}) send(0, stamp);
  EXPECT_EQ(decode_cloud(received(socket)).timestamp, 0U);
  EXPECT_EQ(decode_cloud(received(socket)).timestamp, ~std::uint64_t{0});
  EXPECT_EQ(decode_cloud(received(socket)).timestamp, 7U);
  EXPECT_EQ(publisher->counts().sent, 3U);
  EXPECT_EQ(publisher->counts().repeated, 2U);
}

TEST_F(CloudPublisherTest, SendsEveryKthFrameFromTheFirst) {
  publish({.every = 3});
  link::Socket socket = subscriber();
  ASSERT_TRUE(has_subscribers(1));
  for (std::uint32_t number = 0; number < 7; ++number) {
    if (publisher->wants(number)) send(number);
  }
  EXPECT_EQ(publisher->counts().sent, 3U);
  for (std::uint64_t k = 1; k <= 3; ++k) EXPECT_EQ(decode_cloud(received(socket)).timestamp, k);
}

TEST_F(CloudPublisherTest, DoesNotBlockOnASlowSubscriberAndCountsMissedClouds) {
  publish({.queue = 2});
  link::Socket deaf = subscriber(1);
  link::Socket reader = subscriber();
  ASSERT_TRUE(has_subscribers(2));
  constexpr std::uint32_t kPoints = 1U << 16U;
  std::uint64_t read = 0;
  for (std::uint32_t number = 0; number < 64; ++number) {
    send(number, 0, kPoints);
    ASSERT_EQ(received(reader).size(), cloud_bytes(kPoints));
    ++read;
  }
  EXPECT_EQ(read, 64U);
  // 1 MiB each: the queue and the system's buffers (some 10 MB) have the first ones
  EXPECT_GT(publisher->counts().missed, 40U);
  EXPECT_LT(publisher->counts().missed, 64U);
  EXPECT_THAT(said[0], HasSubstr("clouds missed"));
}

TEST_F(CloudPublisherTest, CountsNoMissesAfterASlowSubscriberHasRecovered) {
  publish({.queue = 2});
  link::Socket slow = subscriber(1);
  ASSERT_TRUE(has_subscribers(1));
  constexpr std::uint32_t kPoints = 1U << 16U;
  for (std::uint32_t number = 0; number < 64; ++number) send(number, 0, kPoints);
  const std::uint64_t missed = publisher->counts().missed;
  for (std::uint64_t k = 0; k < 64 - missed; ++k) {
    ASSERT_EQ(received(slow).size(), cloud_bytes(kPoints)) << k << " of those not missed";
  }
  do {  // a message in transit may have been counted too
    link::wait_for({&slow}, -1, 200ms);
  } while (slow.receive());
  for (std::uint32_t number = 64; number < 80; ++number) {
    send(number, 0, kPoints);
    EXPECT_EQ(decode_cloud(received(slow)).timestamp, number + 1);
  }
  EXPECT_EQ(publisher->counts().missed, missed);
}

TEST_F(CloudPublisherTest, DetectsASubscriberThatVanishes) {
  publish();
  {
    const link::Socket socket = subscriber();
    ASSERT_TRUE(has_subscribers(1));
  }
  EXPECT_TRUE(has_subscribers(0));
}

TEST_F(CloudPublisherTest, ConflatedKeepsTheNewestForASlowSubscriber) {
  publish({.keeps_newest = true, .queue = 1});
  const link::Socket deaf = subscriber(1);
  ASSERT_TRUE(has_subscribers(1));
  for (std::uint32_t number = 0; number < 64; ++number) send(number, 0, 1U << 16U);
  EXPECT_EQ(publisher->counts().missed, 0U);
}

TEST_F(CloudPublisherTest, ExplainsAPortInUse) {
  publish();
  EXPECT_THAT(error_text([&] { CloudPublisher(context, {.endpoint = endpoint}, errors); }),
              ::testing::AllOf(HasSubstr("tcp://127.0.0.1:" + std::to_string(endpoint.port)),
                               HasSubstr("another program uses this port")));
}

}  // namespace

}  // namespace glidar::woods2016
