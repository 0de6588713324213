// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Servers, and attacks on them: clients are answered throughout.
#include <glidar/link/control/control_server.hpp>

#include "control_fixture.hpp"

#include <glidar/core/error.hpp>
#include <glidar/link/control/tcp_service.hpp>
#include <glidar/link/udp/packet_sender.hpp>

#include "link/foxglove/web_peers.hpp"
#include "support/waiting.hpp"

#include <gmock/gmock.h>

#include <random>
#include <vector>

namespace glidar::control {
namespace {

using ::testing::ElementsAre;
using testing::get_request;
using ::testing::HasSubstr;
using testing::http_answer;
using testing::ptc_request;
using ::testing::StartsWith;
using testing::TcpPeer;

struct HttpServer {
  testing::Destinations destinations;
  link::ErrorLog errors{{}};
  std::unique_ptr<ControlServer> server =
      serve_ouster(testing::ouster_options(destinations), {.host = "127.0.0.1", .port = 0}, errors);

  [[nodiscard]] std::uint16_t port() const { return server->port(); }
  [[nodiscard]] bool serves() const {
    return http_answer(port(), get_request("/api/v1/sensor/metadata")).find("beam_intrinsics") !=
           std::string::npos;
  }
};

struct PtcServer {
  testing::Destinations destinations;
  link::ErrorLog errors{{}};
  std::unique_ptr<ControlServer> server =
      serve_hesai(testing::ptc_sensor(destinations), {.host = "127.0.0.1", .port = 0}, errors);

  [[nodiscard]] std::uint16_t port() const { return server->port(); }
  [[nodiscard]] bool serves() const {
    const TcpPeer peer(port());
    peer.send(ptc_request(0x23));
    return peer.receive(13) == std::string("\x47\x74\x23\0\0\0\0\x05\0\0\0\x0e\x10", 13);
  }
};

/// The command of old firmware that sends packets to the client.
std::string set_destination(const std::string& host, const std::string& header) {
  return "GET /api/v1/sensor/cmd/set_udp_dest_auto HTTP/1.1\r\nHost: " + host + "\r\n" + header +
         "\r\n\r\n";
}

/// Bytes that are requests of neither protocol.
std::vector<std::string> garbage() {
  std::vector<std::string> all = {
      "\r\n\r\n",
      "GET",
      "GET / HTTP/9.9\r\nHost: a\r\n\r\n",
      "GET / HTTP/1.1\r\nHost: " + std::string(100'000, 'a') + "\r\n\r\n",
      "GET " + std::string(100'000, '/') + " HTTP/1.1\r\n\r\n",
      "POST /api/v1/sensor/config HTTP/1.1\r\nContent-Length: 18446744073709551615\r\n\r\n",
      "POST /api/v1/sensor/config HTTP/1.1\r\nContent-Length: -1\r\n\r\n",
      "POST /api/v1/sensor/config HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\n"
      "ffffffffffffffff\r\n",
      "POST /api/v1/sensor/config HTTP/1.1\r\nContent-Length: 100\r\n\r\n{",
      std::string("\x47\x74\x05\0\xff\xff\xff\xff", 8),
      std::string("\x47\x74\x05\0\0\0\x04\0", 8),
      std::string("\x47\x74", 2)};
  std::mt19937 chance(1);
  for (int k = 0; k < 12; ++k) {
    std::string bytes(std::size_t{1} << (k + 2), '\0');
    for (char& byte : bytes) byte = static_cast<char>(chance());
    all.push_back(bytes);
  }
  return all;
}

TEST(OusterServer, AnswersOneRequestPerConnection) {
  const HttpServer http;
  const std::string answer = http_answer(http.port(), get_request("/api/v1/user/data"));
  EXPECT_THAT(answer, StartsWith("HTTP/1.1 200 OK\r\n"));
  EXPECT_THAT(answer, HasSubstr("Content-Length: 2\r\n"));
  EXPECT_TRUE(answer.ends_with("\r\n\r\n\"\""));
  EXPECT_THAT(http_answer(http.port(), get_request("/")), StartsWith("HTTP/1.1 404"));
  const std::string head =
      http_answer(http.port(), "HEAD /api/v1/user/data HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_TRUE(head.ends_with("Content-Length: 2\r\n\r\n"));
}

TEST(OusterServer, AnswersRequestsThatArriveByteByByte) {
  const HttpServer http;
  const TcpPeer peer(http.port());
  const std::string body = R"({"udp_port_lidar":7600})";
  for (const char byte :
       "POST /api/v1/sensor/config HTTP/1.1\r\nHost: localhost\r\nContent-Length: " +
           std::to_string(body.size()) + "\r\n\r\n" + body)
    peer.send(std::string(1, byte));
  EXPECT_THAT(peer.receive_all(), StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(http.destinations.all(),
              ElementsAre("7502 to 10.0.0.9:7600", "7503 to 10.0.0.9:7503"));
}

TEST(OusterServer, WebPagesHaveNoAccess) {
  const HttpServer http;
  for (const char* header : {"Origin: http://127.0.0.1", "Sec-Fetch-Site: cross-site",
                             "Referer: http://evil.example/"}) {
    EXPECT_THAT(http_answer(http.port(), set_destination("127.0.0.1", header)),
                StartsWith("HTTP/1.1 403"))
        << header;
  }
  EXPECT_TRUE(http.destinations.all().empty());
  EXPECT_THAT(http_answer(http.port(),
                          "GET /api/v1/user/data HTTP/1.1\r\nHost: localhost\r\n"
                          "Sec-Fetch-Site: none\r\n\r\n"),
              StartsWith("HTTP/1.1 200"));
}

TEST(OusterServer, ForeignHostsHaveNoAccess) {
  const HttpServer http;
  for (const char* target : {"metadata", "config", "cmd/set_udp_dest_auto"}) {
    EXPECT_THAT(http_answer(http.port(),
                            get_request("/api/v1/sensor/" + std::string(target), "evil.example")),
                StartsWith("HTTP/1.1 403"))
        << target;
  }
  EXPECT_THAT(http_answer(http.port(), "GET /api/v1/user/data HTTP/1.1\r\n\r\n"),
              StartsWith("HTTP/1.1 403"))
      << "no host";
  EXPECT_THAT(http_answer(http.port(), set_destination("127.0.0.1", "Host: evil.example")),
              StartsWith("HTTP/1.1 400"))
      << "two hosts";
  EXPECT_TRUE(http.destinations.all().empty());
}

TEST(OusterServer, GetChangesTheDestinationAtANumericHostOnly) {
  const HttpServer http;
  EXPECT_THAT(http_answer(http.port(), set_destination("localhost", "Accept: */*")),
              StartsWith("HTTP/1.1 403"));
  EXPECT_TRUE(http.destinations.all().empty());
  EXPECT_THAT(http_answer(http.port(), set_destination("127.0.0.1", "Accept: */*")),
              StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(http.destinations.all(),
              ElementsAre("7502 to 127.0.0.1:7502", "7503 to 127.0.0.1:7503"));
}

TEST(OusterServer, LargeRequestsAreRefused) {
  const HttpServer http;
  EXPECT_THAT(http_answer(http.port(), get_request("/", std::string(9000, 'a'))),
              StartsWith("HTTP/1.1 413"));
  EXPECT_THAT(http_answer(http.port(),
                          "POST /api/v1/sensor/config HTTP/1.1\r\nContent-Length: 16385\r\n\r\n"),
              StartsWith("HTTP/1.1 413"));
}

TEST(OusterServer, GarbageHasNoEffectOnOthers) {
  const HttpServer http;
  for (const std::string& bytes : garbage()) {
    const TcpPeer attacker(http.port());
    attacker.send(bytes);
    attacker.finish();
    attacker.receive_all();
    EXPECT_TRUE(http.serves());
  }
}

TEST(OusterServer, TwoHundredSilentClientsDoNotKeepOthersOut) {
  const HttpServer http;
  std::vector<TcpPeer> silent;
  for (int i = 0; i < 200; ++i) silent.emplace_back(http.port());
  EXPECT_TRUE(http.serves());
  EXPECT_EQ(silent.front().receive_all(), "");  // the oldest made room
}

TEST(OusterServer, StormsOfConnectionsLeaveItServing) {
  const HttpServer http;
  for (int round = 0; round < 5; ++round) {
    std::vector<TcpPeer> storm;
    for (int i = 0; i < 200; ++i) {
      storm.emplace_back(http.port());
      storm.back().send(i % 2 == 0 ? "GET /api" : get_request("/api/v1/sensor/metadata"));
    }
  }
  EXPECT_TRUE(http.serves());
}

TEST(OusterServer, ReportsAPortInUse) {
  const HttpServer http;
  testing::Destinations other;
  link::ErrorLog errors({});
  EXPECT_THROW(serve_ouster(testing::ouster_options(other),
                            {.host = "127.0.0.1", .port = http.port()}, errors),
               Error);
}

TEST(HesaiServer, AnswersManyRequestsOfAConnection) {
  const PtcServer ptc;
  const TcpPeer peer(ptc.port());
  for (int i = 0; i < 3; ++i) peer.send(ptc_request(0x07) + ptc_request(0x09));
  for (int i = 0; i < 3; ++i) {
    EXPECT_THAT(peer.receive(128), StartsWith(std::string("\x47\x74\x07\0\0\0\0\x78", 8)));
    EXPECT_THAT(peer.receive(62), StartsWith(std::string("\x47\x74\x09\0\0\0\0\x36", 8)));
  }
}

TEST(HesaiServer, GarbageHasNoEffectOnOthers) {
  const PtcServer ptc;
  const TcpPeer good(ptc.port());
  for (const std::string& bytes : garbage()) {
    const TcpPeer attacker(ptc.port());
    attacker.send(bytes);
    attacker.finish();
    attacker.receive_all();
    good.send(ptc_request(0x23));
    EXPECT_EQ(good.receive(13).size(), 13U);
  }
}

TEST(HesaiServer, ClientsThatSendRequestsStayWhenOthersAreSilent) {
  const PtcServer ptc;
  const TcpPeer good(ptc.port());
  std::vector<TcpPeer> silent;
  for (int i = 0; i < 300; ++i) {
    silent.emplace_back(ptc.port());
    good.send(ptc_request(0x23));
    ASSERT_EQ(good.receive(13).size(), 13U);
  }
  EXPECT_TRUE(ptc.serves());
}

/// Echoes lines.
class Echo final : public Conversation {
 public:
  Step receive(std::string_view bytes) override {
    const std::size_t end = bytes.find('\n');
    if (end == std::string_view::npos) return {};
    return {.consumed = end + 1, .answer = std::string(bytes.substr(0, end + 1))};
  }
};

TEST(TcpService, EndsRequestsThatAreNotCompleteInTime) {
  link::ErrorLog errors({});
  const TcpService service(
      {.at = {.host = "127.0.0.1", .port = 0},
       .what = "echo",
       .request = std::chrono::milliseconds(30)},
      [](const std::string&) { return std::make_unique<Echo>(); }, errors);
  const TcpPeer slow(service.port());
  slow.send("GET");
  EXPECT_EQ(slow.receive_all(), "");
  EXPECT_EQ(errors.counts().at("echo"), 1U);
}

TEST(TcpService, EndsClientsThatDoNotReadTheirAnswers) {
  link::ErrorLog errors({});
  const TcpService service(
      {.at = {.host = "127.0.0.1", .port = 0},
       .what = "echo",
       .request = std::chrono::milliseconds(200)},
      [](const std::string&) { return std::make_unique<Echo>(); }, errors);
  const TcpPeer deaf(service.port(), 4096);
  const std::string line = std::string(30'000, 'x') + "\n";
  while (deaf.send(line)) continue;  // until the server closes
  EXPECT_TRUE(testing::soon([&] { return !errors.counts().empty(); }));
}

TEST(LivoxServer, AnswersSearchesAndCommandsFromItsAddress) {
  testing::Destinations destinations;
  link::ErrorLog errors({});
  LivoxSensor sensor = testing::livox_sensor(destinations);
  const auto server =
      serve_livox(sensor, {.host = "127.0.0.3", .port = 0}, errors, /*search_port=*/0);
  EXPECT_NE(server->port(), 0);
  const UniqueFd client(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  const timeval wait{.tv_sec = std::chrono::seconds(testing::kMaxWait).count(), .tv_usec = 0};
  ::setsockopt(client.get(), SOL_SOCKET, SO_RCVTIMEO, &wait, sizeof wait);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(server->port());
  to.sin_addr.s_addr = ::inet_addr("127.0.0.3");
  const auto send = [&](const std::vector<std::byte>& bytes) {
    ::sendto(client.get(), bytes.data(), bytes.size(), 0, reinterpret_cast<sockaddr*>(&to),
             sizeof to);
  };
  std::mt19937 chance(1);
  for (std::size_t size = 0; size < 2000; size += 50) {  // garbage first
    std::vector<std::byte> bytes(size);
    for (std::byte& byte : bytes) byte = static_cast<std::byte>(chance());
    send(bytes);
  }
  send(encode(LivoxCommand{
      5,
      0x0101,
      false,
      false,
      {std::byte{1}, std::byte{0}, std::byte{0}, std::byte{0}, std::byte{0x10}, std::byte{0x80}}}));
  std::vector<std::byte> answer(2000);
  sockaddr_in from{};
  socklen_t size = sizeof from;
  const ssize_t got = ::recvfrom(client.get(), answer.data(), answer.size(), 0,
                                 reinterpret_cast<sockaddr*>(&from), &size);
  ASSERT_EQ(got, 24 + 3 + 5);
  EXPECT_EQ(from.sin_port, to.sin_port);
  EXPECT_EQ(from.sin_addr.s_addr, to.sin_addr.s_addr);
  EXPECT_GE(errors.counts().at("commands of the sensor"), 1U);
  EXPECT_THROW(serve_livox(sensor, {.host = "0.0.0.0", .port = 0}, errors, 0), Error);
}

}  // namespace
}  // namespace glidar::control
