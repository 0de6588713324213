// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/woods2016/protocol.hpp>

#include "link/loopback.hpp"
#include "link/message_bytes.hpp"
#include "link/raw_peer.hpp"
#include "support/error_text.hpp"

#include <gmock/gmock.h>

#include <memory>

namespace glidar::woods2016 {
namespace {

using ::testing::HasSubstr;
using std::chrono_literals::operator""ms;
using testing::received;
using testing::soon;

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
