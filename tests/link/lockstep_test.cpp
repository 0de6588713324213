// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/error.hpp>

#include <glidar/link/lockstep.hpp>
#include <glidar/math/constants.hpp>

#include "loopback.hpp"
#include "raw_peer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <support/error_text.hpp>

#include <cstring>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace glidar::lockstep {
namespace {

using ::testing::HasSubstr;

/// Bytes put together by hand, from the tables of docs/link/lockstep.md.
class Hand {
 public:
  template <class Number>
  Hand& put(Number number) {
    std::array<std::byte, sizeof(Number)> raw{};
    std::memcpy(raw.data(), &number, sizeof(Number));
    bytes.insert(bytes.end(), raw.begin(), raw.end());
    return *this;
  }
  Hand& letters(const char* text, std::size_t size) {
    for (std::size_t i = 0; i < size; ++i) put(i < std::strlen(text) ? text[i] : '\0');
    return *this;
  }
  Hand& body(double x, double qw, double rate_z, double velocity_y) {
    for (const double number :
         {x, 0.0, 0.0, qw, 0.0, 0.0, 0.0, 0.0, 0.0, rate_z, 0.0, velocity_y, 0.0}) {
      put(number);
    }
    return *this;
  }
  std::vector<std::byte> bytes;
};

Hand measure_start(std::uint32_t columns, std::uint32_t moments, std::uint32_t objects) {
  Hand hand;
  hand.letters("GLDR", 4).put(std::uint16_t{1}).put(std::uint16_t{1}).put(std::uint64_t{77});
  for (const std::uint32_t number : {0U, 1U, columns, moments, objects, 0U}) hand.put(number);
  return hand;
}

/// Two columns, one moment, one object.
Hand good() {
  Hand hand = measure_start(2, 1, 1);
  hand.letters("xyz", 24).letters("intensity", 24);
  hand.put(std::int64_t{-5}).put(std::uint64_t{9}).put(std::uint32_t{3}).put(std::uint32_t{0});
  hand.body(2.0, 1.0, 0.0, 0.0).body(4.0, 1.0, 0.25, -3.0);
  return hand;
}

std::string error_of(const std::vector<std::byte>& bytes) {
  std::uint64_t id = 0;
  return error_text([&] { decode_request(bytes, id); });
}

/// The good request with other bytes at a place.
template <class Number>
std::string error_with(std::size_t at, Number number) {
  Hand hand = good();
  std::memcpy(hand.bytes.data() + at, &number, sizeof(Number));
  return error_of(hand.bytes);
}

constexpr std::size_t kMoment = 40 + 2 * 24;
constexpr std::size_t kSensor = kMoment + 24;
constexpr std::size_t kObject = kSensor + 104;

TEST(DecodeRequest, ReadsEveryFieldOfBytesWrittenByHand) {
  std::uint64_t id = 0;
  const Request request = decode_request(good().bytes, id);
  EXPECT_EQ(id, 77U);
  const auto& measure = std::get<Measure>(request);
  EXPECT_EQ(measure.id, 77U);
  EXPECT_TRUE(measure.drop_invalid);
  EXPECT_THAT(measure.columns, ::testing::ElementsAre("xyz", "intensity"));
  ASSERT_EQ(measure.moments.size(), 1U);
  const Moment& moment = measure.moments[0];
  EXPECT_EQ(moment.t_ns, -5);
  EXPECT_EQ(moment.seed, 9U);
  EXPECT_EQ(moment.number, 3U);
  EXPECT_EQ(moment.sensor.world_from_body.translation().x(), 2.0);
  ASSERT_EQ(moment.objects.size(), 1U);
  EXPECT_EQ(moment.objects[0].world_from_body.translation().x(), 4.0);
  EXPECT_EQ(moment.objects[0].rate_rad_s, Eigen::Vector3d(0.0, 0.0, 0.25));
  EXPECT_EQ(moment.objects[0].velocity_m_s, Eigen::Vector3d(0.0, -3.0, 0.0));
}

TEST(Encode, WritesTheSameBytesAsByHand) {
  std::uint64_t id = 0;
  EXPECT_EQ(encode(decode_request(good().bytes, id)), good().bytes);
  Hand describe;
  describe.letters("GLDR", 4).put(std::uint16_t{1}).put(std::uint16_t{0}).put(std::uint64_t{5});
  EXPECT_EQ(encode(Describe{5}), describe.bytes);
  EXPECT_EQ(std::get<Describe>(decode_request(describe.bytes, id)).id, 5U);
}

TEST(DecodeRequest, RejectsAnyWrongLength) {
  const std::vector<std::byte> whole = good().bytes;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_THAT(error_of({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)}),
                HasSubstr("size"))
        << size;
  }
  std::vector<std::byte> longer = whole;
  longer.push_back(std::byte{0});
  EXPECT_THAT(error_of(longer), HasSubstr("size"));
}

TEST(DecodeRequest, ReadsTheIdOfInvalidRequests) {
  Hand hand = good();
  hand.bytes.pop_back();
  std::uint64_t id = 0;
  EXPECT_THROW(decode_request(hand.bytes, id), Error);
  EXPECT_EQ(id, 77U);
}

TEST(DecodeRequest, ReportsTheInvalidField) {
  EXPECT_THAT(error_with(0, 'X'), HasSubstr("GLDR"));
  EXPECT_THAT(error_with(4, std::uint16_t{2}), HasSubstr("version: 2; allowed: 1"));
  EXPECT_THAT(error_with(6, std::uint16_t{9}), HasSubstr("kind: 9"));
  EXPECT_THAT(error_with(20, 2U), HasSubstr("flags: 2"));
  EXPECT_THAT(error_with(24, 0U), HasSubstr("number of columns: 0; allowed: 1 to 64"));
  EXPECT_THAT(error_with(24, 0xffffffffU), HasSubstr("number of columns"));
  EXPECT_THAT(error_with(28, 0xffffffffU), HasSubstr("number of moments"));
  EXPECT_THAT(error_with(32, 0xffffffffU), HasSubstr("number of objects"));
  EXPECT_THAT(error_with(32, 1'000'000U), HasSubstr("size"));
  EXPECT_THAT(error_with(36, 1U), HasSubstr("reserved"));
  EXPECT_THAT(error_with(40, 'A'), HasSubstr("name of a column"));
  EXPECT_THAT(error_with(40, '\0'), HasSubstr("name of a column"));
  EXPECT_THAT(error_with(kMoment + 20, 1U), HasSubstr("moment 0, reserved"));
}

TEST(DecodeRequest, RejectsNumbersThatAreNotFinite) {
  const double nan = kNaN;
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, infinity, -infinity, 1e300}) {
    EXPECT_THAT(error_with(kSensor, bad), HasSubstr("moment 0, sensor, position"));
    EXPECT_THAT(error_with(kObject + 8, bad), HasSubstr("moment 0, object 0, position"));
    EXPECT_THAT(error_with(kObject + 24, bad), HasSubstr("object 0, quaternion"));
    EXPECT_THAT(error_with(kObject + 56, bad), HasSubstr("object 0, rate"));
    EXPECT_THAT(error_with(kObject + 80, bad), HasSubstr("object 0, velocity"));
  }
}

TEST(DecodeRequest, RejectsQuaternionsThatAreNotOfLengthOne) {
  EXPECT_THAT(error_with(kSensor + 24, 0.0), HasSubstr("length 0"));
  EXPECT_THAT(error_with(kSensor + 24, 1.1), HasSubstr("length 1.1"));
  EXPECT_EQ(error_with(kSensor + 24, 1.0005), "no error") << "written with few digits";
}

TEST(EncodeHead, HasTheLayoutOfTheTables) {
  PointCloud cloud;
  cloud.columns = {{"xyz", {"x", "y", "z"}, std::vector<double>(6)},
                   {"ring", {"ring"}, std::vector<std::uint16_t>(2)}};
  const CloudHead head{
      .stamp_ns = -2,
      .seed = 8,
      .number = 4,
      .rows = 1,
      .cols = 2,
      .frame_id = "lidar_frame",
      .world_from_cloud = make_pose({1.0, 2.0, 3.0}, Eigen::Quaterniond::Identity())};
  Hand hand;
  hand.letters("GLDR", 4).put(std::uint16_t{1}).put(std::uint16_t{2}).put(std::uint64_t{6});
  hand.put(1U).put(2U);
  hand.letters("xyz", 24).letters("f8", 2).put(std::uint16_t{3}).put(0U);
  hand.letters("ring", 24).letters("u2", 2).put(std::uint16_t{1}).put(0U);
  hand.put(std::int64_t{-2}).put(std::uint64_t{8}).put(4U).put(1U).put(2U).put(0U);
  hand.letters("lidar_frame", 32);
  for (const double number : {1.0, 2.0, 3.0, 1.0, 0.0, 0.0, 0.0}) hand.put(number);
  EXPECT_EQ(encode_head(6, {{head}}, cloud), hand.bytes);
  EXPECT_EQ(hand.bytes.size(), 24U + 2U * 32U + 120U);
  EXPECT_EQ(bytes_of(cloud.columns[0]).size(), 48U);
}

TEST(EncodeTextHead, DistinguishesErrorsFromDescriptions) {
  Hand hand;
  hand.letters("GLDR", 4).put(std::uint16_t{1}).put(std::uint16_t{3}).put(std::uint64_t{1});
  EXPECT_EQ(encode_text_head(1, TextKind::error), hand.bytes);
}

using ::testing::ElementsAre;
using ::testing::IsEmpty;

link::Delivered from(const std::string& client, int connection = 1) {
  return {.from = {.client = client, .connection = {.descriptor = connection}}, .body = {}};
}

std::string add(RequestQueue& queue, const std::string& client) {
  link::Delivered message = from(client);
  return queue.add(message, {});
}

/// The clients of all that wait, each answered before the next one.
std::vector<std::string> turns(RequestQueue& queue) {
  std::vector<std::string> clients;
  while (const std::optional<Waiting> waiting = queue.next()) {
    clients.push_back(waiting->message.from.client);
    queue.done(clients.back());
  }
  return clients;
}

TEST(RequestQueue, ServesClientsInTurn) {
  RequestQueue queue({});
  for (int k = 0; k < 4; ++k) EXPECT_THAT(add(queue, "flood"), IsEmpty());
  EXPECT_THAT(add(queue, "b"), IsEmpty());
  EXPECT_THAT(add(queue, "c"), IsEmpty());
  EXPECT_THAT(add(queue, "b"), IsEmpty());
  EXPECT_THAT(turns(queue), ElementsAre("flood", "b", "c", "flood", "b", "flood", "flood"));
}

TEST(RequestQueue, AClientHasOneRequestInProgress) {
  RequestQueue queue({});
  add(queue, "a");
  add(queue, "a");
  ASSERT_TRUE(queue.next());
  EXPECT_FALSE(queue.next());
  add(queue, "b");
  EXPECT_EQ(queue.next()->message.from.client, "b");
  queue.done("a");
  EXPECT_EQ(queue.next()->message.from.client, "a");
}

TEST(RequestQueue, RejectsRequestsBeyondTheLimitOfOneClientOnly) {
  RequestQueue queue({.requests = 2});
  add(queue, "a");
  EXPECT_TRUE(queue.next());
  EXPECT_THAT(add(queue, "a"), IsEmpty());
  EXPECT_THAT(add(queue, "a"), ::testing::AllOf(HasSubstr("3 of one client"),
                                                HasSubstr("at most 2 (--limit requests)")));
  EXPECT_THAT(add(queue, "b"), IsEmpty());
  queue.done("a");
  const auto unread = queue.unread_of(from("a").from);
  unread->replies = 1;
  EXPECT_THAT(add(queue, "a"), HasSubstr("--limit requests"));
  unread->replies = 0;
  EXPECT_THAT(add(queue, "a"), IsEmpty());
}

TEST(RequestQueue, RejectsRequestsWhileUnreadRepliesFillTheMemory) {
  RequestQueue queue({.memory_mib = 1});
  queue.all_unread()->bytes = (1 << 20) + 1;
  EXPECT_THAT(add(queue, "a"), HasSubstr("--limit memory-mib"));
}

TEST(RequestQueue, RemovesClientsWithoutRequests) {
  RequestQueue queue({});
  const auto check = [&] {
    queue.check_clients(
        {}, std::chrono::seconds(1), [](const auto&) { return 0; }, [](const auto&) {});
  };
  add(queue, "a");
  check();
  EXPECT_TRUE(queue.has_clients());
  EXPECT_TRUE(queue.next());
  check();
  EXPECT_TRUE(queue.has_clients());
  queue.done("a");
  check();
  EXPECT_FALSE(queue.has_clients());
}

TEST(RequestQueue, FindsClientsThatDoNotReadTheirReplies) {
  RequestQueue queue({});
  const auto reads = queue.unread_of(from("reads", 1).from);
  const auto stalls = queue.unread_of(from("stalls", 2).from);
  reads->replies = stalls->replies = 1;
  std::uint64_t taken = 0;
  std::vector<int> stalled;
  const Clock::time_point start = Clock::now();
  for (int second = 0; second < 4; ++second) {
    queue.check_clients(
        start + std::chrono::seconds(second), std::chrono::seconds(3),
        [&](const link::ConnectionId& client) { return client.descriptor == 1 ? ++taken : 0; },
        [&](const link::ConnectionId& client) { stalled.push_back(client.descriptor); });
  }
  EXPECT_THAT(stalled, ElementsAre(2));
}

using testing::RawPeer;
using testing::soon;
using std::chrono_literals::operator""ms;

class LockstepServerTest : public ::testing::Test {
 protected:
  LockstepServerTest() {
    server = testing::at_free_port([&](const link::Endpoint& at) {
      endpoint = at;
      return std::make_unique<Server>(context, options(at), errors);
    });
  }
  /// Connections come as fast as they can here.
  static ServerOptions options(const link::Endpoint& at) {
    return {.endpoint = at, .limits = {.connections_per_s = 1'000'000}};
  }
  link::Socket client() {
    link::Socket socket(context, {.kind = link::SocketKind::request});
    socket.connect(endpoint);
    return socket;
  }
  /// Answers what there is with the number of the request.
  void serve() {
    while (const std::optional<Received> received = server->receive()) {
      server->reply_description(received->to, std::to_string(received->to.id));
    }
  }
  /// Whether this request of the client is answered with its own reply.
  bool is_answered(link::Socket& asking, std::uint64_t id) {
    asking.send(encode(Request(Describe{id})));
    std::vector<std::string> parts;
    const auto has_reply = [&] {
      while (const std::optional<link::Message> part = asking.receive()) {
        parts.emplace_back(reinterpret_cast<const char*>(part->bytes().data()),
                           part->bytes().size());
        if (part->is_last()) return true;
      }
      return false;
    };
    const bool is_replied = soon([&] {  // it pauses between its attempts
      for (int i = 0; i < 1000; ++i) {
        serve();
        if (has_reply()) return true;
        link::wait_for({&server->socket(), &asking}, -1, 10ms);
      }
      return false;
    });
    return is_replied && parts.size() == 2 && parts[1] == std::to_string(id);
  }

  std::vector<std::string> said;
  link::ErrorLog errors{
      {.log = [this](Severity, std::string_view t) { said.emplace_back(t); }, .progress = {}}};
  link::Context context;
  link::Endpoint endpoint;
  std::unique_ptr<Server> server;
};

TEST_F(LockstepServerTest, LosesNoneOf10000RepliesAmongPeersThatSendGarbage) {
  const std::vector<testing::Garbage> garbage = testing::garbage();
  std::vector<link::Socket> steady;
  for (int k = 0; k < 3; ++k) steady.push_back(client());
  std::vector<RawPeer> open;  // some stay for a while
  for (std::uint64_t id = 0; id < 10'000; ++id) {
    if (id % 5 == 0) {
      open.push_back(testing::stranger(endpoint, garbage[id / 5 % garbage.size()]));
      if (open.size() == 10) open.clear();
    }
    if (id % 20 == 0) {
      link::Socket fresh = client();
      ASSERT_TRUE(is_answered(fresh, id));
    } else {
      ASSERT_TRUE(is_answered(steady[id % steady.size()], id));
    }
  }
  EXPECT_GE(server->counts().received, 10'000U);
}

/// A DEALER that sends requests and reads no replies.
class Flooder {
 public:
  explicit Flooder(const link::Endpoint& at) : peer_(at) { EXPECT_TRUE(peer_.shake("DEALER")); }
  void send() {
    const std::vector<std::byte> request = encode(Request(Describe{7}));
    const std::string body(reinterpret_cast<const char*>(request.data()), request.size());
    std::string many;
    for (int k = 0; k < 1000; ++k) {
      many += testing::zmtp_part("", true) + testing::zmtp_part(body, false);
    }
    peer_.send(many);
  }

 private:
  RawPeer peer_;
};

TEST_F(LockstepServerTest, ServesOthersWhileOneClientFloodsItAndReadsNothing) {
  Flooder flooder(endpoint);
  link::Socket asking = client();
  for (std::uint64_t id = 100; id < 300; ++id) {
    flooder.send();
    ASSERT_TRUE(is_answered(asking, id));
  }
  EXPECT_GT(server->counts().refused, 0U);
  EXPECT_GT(errors.counts().at("requests refused"), 0U);
}

TEST_F(LockstepServerTest, DropsTheRequestsOfAClientThatHasLeft) {
  link::Socket asking = client();
  ASSERT_TRUE(is_answered(asking, 1));
  std::optional<Received> received;
  {
    link::Socket leaves = client();
    leaves.send(encode(Request(Describe{2})));
    ASSERT_TRUE(soon([&] { return (received = server->receive()).has_value(); }));
    EXPECT_TRUE(server->is_wanted(received->to));
  }
  EXPECT_TRUE(soon([&] { return !server->is_wanted(received->to); }));
  server->drop(received->to);
  EXPECT_TRUE(is_answered(asking, 3));
}

TEST_F(LockstepServerTest, ReservesMemoryForRepliesUpToTheLimit) {
  constexpr std::int64_t kMib = 1 << 20;
  link::Socket first = client();
  link::Socket second = client();
  std::vector<Received> received;
  for (link::Socket* asking : {&first, &second}) {
    asking->send(encode(Request(Describe{1})));
    ASSERT_TRUE(soon([&] {
      std::optional<Received> one = server->receive();
      if (one) received.push_back(std::move(*one));
      return one.has_value();
    }));
  }
  EXPECT_TRUE(server->reserve(received[0].to, 1500 * kMib));
  EXPECT_TRUE(server->reserve(received[0].to, 1500 * kMib));  // once
  EXPECT_FALSE(server->reserve(received[1].to, 600 * kMib));
  server->reply_description(received[0].to, "done");
  EXPECT_TRUE(soon([&] { return server->reserve(received[1].to, 600 * kMib); }));
  server->drop(received[1].to);
}

}  // namespace

}  // namespace glidar::lockstep
