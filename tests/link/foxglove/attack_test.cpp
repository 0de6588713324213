// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Attacks on the live view's server: a client that is connected receives its messages throughout.
#include <glidar/link/foxglove/server.hpp>

#include "test_server.hpp"

#include <gmock/gmock.h>

#include <random>
#include <stdexcept>
#include <vector>

namespace glidar::foxglove {
namespace {

using testing::client_frame;
using testing::soon;
using testing::TcpPeer;
using testing::TestServer;
using testing::upgrade_request;
using testing::WebSocketPeer;

/// Bytes instead of an HTTP request.
std::vector<std::string> http_garbage() {
  std::vector<std::string> all = {
      "",
      "\r\n\r\n",
      "GET",
      "GET / HTTP/1.1\r\n\r\n",
      "GET / HTTP/9.9\r\nHost: localhost\r\n\r\n",
      "GET / HTTP/1.1\r\nHost: " + std::string(100'000, 'a') + "\r\n\r\n",
      "GET " + std::string(100'000, '/') + " HTTP/1.1\r\nHost: localhost\r\n\r\n",
      "POST /api/pick HTTP/1.1\r\nHost: localhost\r\nContent-Length: 18446744073709551615\r\n\r\n",
      "POST /api/pick HTTP/1.1\r\nHost: localhost\r\nContent-Length: -1\r\n\r\n",
      "POST /api/pick HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\n"
      "ffffffffffffffff\r\n",
      "GET / HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n\r\n",
      upgrade_request().substr(0, 60),
      upgrade_request("Sec-WebSocket-Key: x\r\n"),
      "\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03"};
  std::mt19937 chance(1);
  for (int k = 0; k < 10; ++k) {
    std::string bytes(std::size_t{1} << (k + 2), '\0');
    for (char& byte : bytes) byte = static_cast<char>(chance());
    all.push_back(bytes);
  }
  return all;
}

/// Bytes after the handshake of a WebSocket.
std::vector<std::string> frame_garbage() {
  std::vector<std::string> all = {
      "\x81",                                                            // truncated
      std::string("\x81\xff\xff\xff\xff\xff\xff\xff\xff\xff", 10),       // a length of 2^64 - 1
      std::string("\x81\xff\0\0\0\xff\xff\xff\xff\xff\0\0\0\0x", 15),    // a terabyte
      std::string("\x81\xfe\0\x10\0\0\0\0abc", 11),                      // ends early
      "\x81\x05hello",                                                   // not masked
      std::string("\xf1\x80\0\0\0\0", 6),                                // reserved bits
      std::string("\x83\x80\0\0\0\0", 6),                                // reserved opcode
      std::string("\x80\x80\0\0\0\0", 6),                                // continues nothing
      std::string("\x89\xfe\x01\0\0\0\0\0", 8) + std::string(256, 'p'),  // a long ping
      std::string("\x88\x81\0\0\0\0x", 7),                               // a close without a code
      client_frame(1, "\xff\xfe"),                                       // not UTF-8
      client_frame(1, std::string(60'000, '[')),
      client_frame(1, R"({"op":"subscribe","subscriptions":[{"id":1e99,"channelId":null}]})"),
      client_frame(2, std::string(1000, '\1')),
      client_frame(2, ""),
      client_frame(9, "ping"),
      client_frame(10, "pong"),
      client_frame(8, "")};
  std::mt19937 chance(2);
  for (int k = 0; k < 10; ++k) {
    std::string bytes(std::size_t{1} << (k + 2), '\0');
    for (char& byte : bytes) byte = static_cast<char>(chance());
    all.push_back(bytes);
  }
  return all;
}

TEST(FoxgloveAttack, GarbageInsteadOfRequestsHasNoEffectOnOthers) {
  TestServer server;
  const WebSocketPeer good(server.port());
  good.subscribe(1, server.channel);
  for (const std::string& bytes : http_garbage()) {
    const TcpPeer attacker(server.port());
    attacker.send(bytes);
    attacker.finish();
    attacker.receive_all();
    server.publish(bytes);
    EXPECT_EQ(good.message(1), bytes);
  }
  EXPECT_TRUE(server.serves());
}

TEST(FoxgloveAttack, GarbageAfterTheHandshakeHasNoEffectOnOthers) {
  TestServer server;
  const WebSocketPeer good(server.port());
  good.subscribe(1, server.channel);
  for (const std::string& bytes : frame_garbage()) {
    const WebSocketPeer attacker(server.port());
    attacker.tcp().send(bytes);
    attacker.tcp().finish();
    attacker.tcp().receive_all();
    server.publish(bytes);
    EXPECT_EQ(good.message(1), bytes);
  }
  EXPECT_TRUE(soon([&] { return server.server.counts().clients == 1; }));
}

TEST(FoxgloveAttack, ClientsThatSendOnlyErrorsAreDisconnected) {
  TestServer server;
  const WebSocketPeer attacker(server.port());
  std::string closed;
  try {
    for (int i = 0; i < 1000; ++i) attacker.send("{}");
    for (;;) attacker.receive();
  } catch (const std::runtime_error& error) {
    closed = error.what();
  }
  EXPECT_EQ(closed, "closed");
  EXPECT_TRUE(server.serves());
}

TEST(FoxgloveAttack, LargeMessagesAreRefusedBeforeTheyAreReceived) {
  TestServer server({.limits = {.http = {.body_bytes = 1000}, .received_bytes = 1000}});
  const WebSocketPeer attacker(server.port());
  attacker.tcp().send(client_frame(1, std::string(1001, 'x')));
  attacker.tcp().finish();
  attacker.tcp().receive_all();
  EXPECT_TRUE(soon([&] { return server.server.counts().clients == 0; }));
  const std::string reply = testing::http_answer(
      server.port(), "POST /api/pick HTTP/1.1\r\nHost: localhost\r\nContent-Length: 1001\r\n\r\n");
  EXPECT_EQ(reply.substr(0, 12), "HTTP/1.1 413");
}

TEST(FoxgloveAttack, TwoHundredSilentConnectionsDoNotKeepClientsOut) {
  TestServer server;
  const WebSocketPeer good(server.port());
  good.subscribe(1, server.channel);
  std::vector<TcpPeer> silent;
  for (int i = 0; i < 200; ++i) silent.emplace_back(server.port());
  EXPECT_TRUE(server.serves());
  server.publish("still here");
  while (good.message(1) != "still here") continue;
  EXPECT_EQ(silent.front().receive_all(), "");  // the oldest made room
}

TEST(FoxgloveAttack, TwoHundredClientsAreServedUpToTheLimit) {
  TestServer server({.limits = {.clients = 32}});
  const WebSocketPeer good(server.port());
  good.subscribe(1, server.channel);
  std::vector<WebSocketPeer> others;
  int refused = 0;
  for (int i = 0; i < 200; ++i) {
    try {
      others.emplace_back(server.port());
    } catch (const std::runtime_error&) {
      ++refused;
    }
  }
  EXPECT_EQ(others.size(), 31U);
  EXPECT_EQ(refused, 169);
  server.publish("still here");
  EXPECT_EQ(good.message(1), "still here");
  others.clear();
  EXPECT_TRUE(soon([&] { return server.server.counts().clients == 1; }));
  EXPECT_TRUE(server.serves());
}

TEST(FoxgloveAttack, StormsOfConnectionsLeaveNothingBehind) {
  TestServer server;
  for (int round = 0; round < 5; ++round) {
    std::vector<TcpPeer> storm;
    for (int i = 0; i < 200; ++i) {
      storm.emplace_back(server.port());
      storm.back().send(i % 2 == 0 ? upgrade_request() : testing::get_request("/main.js"));
    }
  }
  EXPECT_TRUE(soon([&] { return server.server.counts().clients == 0; }));
  EXPECT_TRUE(server.serves());
}

TEST(FoxgloveAttack, ConnectionsWithoutARequestEnd) {
  TestServer server({.limits = {.http = {.request = std::chrono::milliseconds(30)}}});
  const TcpPeer silent(server.port());
  silent.send("GET / HTT");
  EXPECT_EQ(silent.receive_all(), "");
}

}  // namespace
}  // namespace glidar::foxglove
