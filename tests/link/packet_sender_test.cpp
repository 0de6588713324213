// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/packets/sensor_packets.hpp>
#include <glidar/link/udp/packet_sender.hpp>

#include "io/packets/packet_fixture.hpp"
#include "support/error_text.hpp"
#include "support/parameter_name.hpp"
#include "support/waiting.hpp"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <stdexcept>

namespace glidar::link {
namespace {

using std::chrono::milliseconds;
using testing::FlatReturn;
using ::testing::HasSubstr;

/// A UDP socket at a free port of this machine.
class Receiver {
 public:
  Receiver() : descriptor_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    const timeval wait{.tv_sec = std::chrono::seconds(testing::kMaxWait).count(), .tv_usec = 0};
    ::setsockopt(descriptor_.get(), SOL_SOCKET, SO_RCVTIMEO, &wait, sizeof wait);
    sockaddr_in at{};
    at.sin_family = AF_INET;
    at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof at;
    if (::bind(descriptor_.get(), reinterpret_cast<const sockaddr*>(&at), sizeof at) != 0 ||
        ::getsockname(descriptor_.get(), reinterpret_cast<sockaddr*>(&at), &size) != 0) {
      throw std::runtime_error("cannot bind");
    }
    port_ = ntohs(at.sin_port);
  }
  [[nodiscard]] std::uint16_t port() const { return port_; }
  [[nodiscard]] std::vector<std::byte> receive() const {
    std::vector<std::byte> payload(65'536);
    const ssize_t size = ::recv(descriptor_.get(), payload.data(), payload.size(), 0);
    if (size < 0) throw std::runtime_error("nothing received");
    payload.resize(static_cast<std::size_t>(size));
    return payload;
  }
  /// The port that the next packet comes from.
  [[nodiscard]] std::uint16_t source_port() const {
    sockaddr_in from{};
    socklen_t size = sizeof from;
    std::byte payload{};
    if (::recvfrom(descriptor_.get(), &payload, sizeof payload, 0,
                   reinterpret_cast<sockaddr*>(&from), &size) < 0)
      throw std::runtime_error("nothing received");
    return ntohs(from.sin_port);
  }

 private:
  UniqueFd descriptor_;
  std::uint16_t port_ = 0;
};

UdpPacket packet_at(std::int64_t stamp_ns, std::uint8_t content, std::uint16_t port = 2368) {
  return {stamp_ns, port, port, {std::byte{content}}};
}

struct Receiving {
  Receiver receiver;
  ErrorLog errors{{}};
  [[nodiscard]] PacketRoute route() const {
    return {.host = "127.0.0.1", .ports = {{2368, receiver.port()}, {7502, receiver.port()}}};
  }
};

class PacketSenderOf : public ::testing::TestWithParam<const char*> {};

TEST_P(PacketSenderOf, ReceivedPacketsAreTheFrameWithinTheUnit) {
  const Sensor sensor = testing::packet_sensor(GetParam(), false);
  const DecodedFrame made = testing::room_frame(sensor, 0);
  std::vector<UdpPacket> packets;
  SensorPackets encoder(sensor);
  encoder.encode(made.frame, made.beams, packets);
  encoder.finish(packets);
  std::erase_if(packets, [](const UdpPacket& packet) { return packet.port == 8308; });
  Receiving receiving;
  PacketSender sender(receiving.route(), 0.0, receiving.errors);
  std::vector<DecodedFrame> frames;
  const auto decoder = make_packet_decoder(sensor);
  for (UdpPacket& packet :
       packets) {  // one by one: the system drops what a receiver has no room for
    const UdpPacket sent = packet;
    sender.send({std::move(packet)}, 0);
    decoder->decode({sent.stamp_ns, sent.port, sent.port, receiving.receiver.receive()}, frames);
  }
  decoder->finish(frames);
  std::vector<FlatReturn> truth;
  std::vector<FlatReturn> found;
  testing::flatten(made, truth);
  for (const DecodedFrame& frame : frames) testing::flatten(frame, found);
  testing::sort_returns(truth);
  testing::sort_returns(found);
  ASSERT_EQ(found.size(), truth.size());
  constexpr double kUnit_m = 0.004;  // the coarsest
  for (std::size_t i = 0; i < truth.size(); ++i) {
    ASSERT_EQ(found[i].ring, truth[i].ring);
    ASSERT_NEAR(found[i].range_m, truth[i].range_m, 0.5001 * kUnit_m);
  }
}

INSTANTIATE_TEST_SUITE_P(Presets, PacketSenderOf, ::testing::Values("VLP-16", "OS1-32", "XT32"),
                         testing::parameter_name<const char*>);

TEST(PacketSender, SendsEveryPacketInOrderAndNotBeforeItsTime) {
  Receiving receiving;
  PacketSender sender(receiving.route(), 2.0, receiving.errors);
  constexpr std::int64_t kPeriod_ns = 200'000'000;
  std::vector<UdpPacket> packets;
  for (std::uint8_t i = 0; i < 10; ++i) packets.push_back(packet_at(1000 + i * kPeriod_ns / 10, i));
  const auto begin = PacketSender::Clock::now();
  sender.send(packets, 1000);
  for (std::uint8_t i = 0; i < 10; ++i) {
    ASSERT_EQ(receiving.receiver.receive().at(0), std::byte{i});
    EXPECT_GE(PacketSender::Clock::now() - begin, std::chrono::nanoseconds(i * kPeriod_ns / 20));
  }
}

TEST(PacketSender, FinishSendsPacketsThatAreDueLater) {
  Receiving receiving;
  PacketSender sender(receiving.route(), 1.0, receiving.errors);
  constexpr std::int64_t kHour_ns = 3'600'000'000'000;
  sender.send({packet_at(kHour_ns, 1), packet_at(2 * kHour_ns, 2)}, 0);
  sender.finish(milliseconds(0));
  EXPECT_EQ(sender.sent(), 2U);
  EXPECT_EQ(receiving.receiver.receive().at(0), std::byte{1});
  EXPECT_EQ(receiving.receiver.receive().at(0), std::byte{2});
}

TEST(PacketSender, EachKindOfPacketHasItsPort) {
  Receiving data;
  const Receiver positions;
  PacketRoute route = data.route();
  route.ports[8308] = positions.port();
  PacketSender sender(route, 0.0, data.errors);
  sender.send({packet_at(0, 1, 8308), packet_at(0, 2, 2368)}, 0);
  EXPECT_EQ(positions.receive().at(0), std::byte{1});
  EXPECT_EQ(data.receiver.receive().at(0), std::byte{2});
}

TEST(PacketSender, RedirectedPacketsReachTheNewReceiver) {
  Receiving first;
  const Receiver second;
  PacketSender sender(first.route(), 0.0, first.errors);
  sender.send({packet_at(0, 1)}, 0);
  EXPECT_EQ(first.receiver.receive().at(0), std::byte{1});
  sender.redirect(2368, "127.0.0.1", second.port());
  sender.send({packet_at(0, 2), packet_at(0, 3, 7502)}, 0);
  EXPECT_EQ(second.receive().at(0), std::byte{2});
  EXPECT_EQ(first.receiver.receive().at(0), std::byte{3});
  EXPECT_THAT(error_text([&] { sender.redirect(2368, "no such host", 1); }),
              HasSubstr("cannot find the address"));
}

TEST(PacketSender, SendsFromTheAddressAndPortOfTheSensor) {
  Receiving receiving;
  const std::uint16_t port = Receiver().port();  // free now
  PacketRoute route = receiving.route();
  route.source = "127.0.0.1";
  route.source_ports = {port};
  PacketSender sender(route, 0.0, receiving.errors);
  UdpPacket packet = packet_at(0, 1);
  packet.source_port = port;
  sender.send({packet}, 0);
  EXPECT_EQ(receiving.receiver.source_port(), port);
  EXPECT_THAT(error_text([&] { PacketSender(route, 0.0, receiving.errors); }),
              HasSubstr("cannot use this address"));
}

TEST(PacketSender, ReportsPacketsThatCannotBeSent) {
  Receiving receiving;
  PacketSender sender(receiving.route(), 0.0, receiving.errors);
  UdpPacket large = packet_at(0, 1);
  large.payload.resize(70'000);
  sender.send({large, packet_at(0, 2)}, 0);
  EXPECT_EQ(receiving.receiver.receive().at(0), std::byte{2});
  EXPECT_EQ(receiving.errors.counts().at("packets by UDP"), 1U);
}

TEST(PacketSender, RefusesHostsThatAreNotKnown) {
  ErrorLog errors({});
  EXPECT_THAT(error_text([&] { PacketSender({.host = "no such host", .ports = {}}, 0.0, errors); }),
              HasSubstr("cannot find the address"));
}

}  // namespace
}  // namespace glidar::link
