// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/foxglove/protocol.hpp>

#include "support/error_text.hpp"

#include <gmock/gmock.h>

#include <variant>

namespace glidar::foxglove {
namespace {

using ::testing::HasSubstr;

HttpReply reply_to(const HttpRequest& request, const PageServices& services = {true, true}) {
  link::HttpGuard guard({}, link::HttpClients::own_pages);
  return std::get<HttpReply>(route(request, guard, services));
}

TEST(HttpRoutes, ServeEveryFileOfThePage) {
  for (const PageFile& file : page_files()) {
    const HttpReply reply = reply_to({{"GET", "localhost"}, file.target});
    EXPECT_EQ(reply.status, 200);
    EXPECT_EQ(reply.content_type, file.content_type);
    EXPECT_THAT(reply.body, HasSubstr("SPDX-License-Identifier: BSD-3-Clause")) << file.target;
  }
  EXPECT_EQ(reply_to({{"GET", "localhost"}, "/?layout=1"}).status, 200);
  for (const char* target : {"", "/x", "//", "/../etc/passwd", "/main.js/", "main.js"}) {
    EXPECT_EQ(reply_to({{"GET", "localhost"}, target}).status, 404) << target;
  }
  EXPECT_EQ(reply_to({{"GET", "attacker.example"}, "/"}).status, 403);
  EXPECT_EQ(reply_to({{"PUT", "localhost"}, "/"}).status, 405);
}

TEST(HttpRoutes, AcceptCommandsFromTheServersOwnPageOnly) {
  link::HttpGuard guard({}, link::HttpClients::own_pages);
  HttpRequest request{{"POST", "localhost:1", "http://localhost:1"},
                      "/api/playback",
                      "application/json",
                      R"({"command":"step"})"};
  EXPECT_EQ(std::get<PlaybackCommand>(route(request, guard, {true, true})), PlaybackCommand::step);
  EXPECT_EQ(reply_to(request, {.has_playback = false, .has_picks = true}).status, 404);
  for (const char* origin : {"", "null", "http://localhost:2", "https://app.foxglove.dev"}) {
    request.head.origin = origin;
    EXPECT_EQ(reply_to(request).status, 403) << origin;
  }
  request.head.origin = "http://localhost:1";
  request.content_type = "text/plain";
  EXPECT_EQ(reply_to(request).status, 415);
}

TEST(HttpRoutes, DecodePicks) {
  link::HttpGuard guard({}, link::HttpClients::own_pages);
  HttpRequest request{{"POST", "localhost:1", "http://localhost:1"},
                      "/api/pick",
                      "application/json",
                      R"({"topic":"/points","time_ns":"18446744073709551615","index":7})"};
  EXPECT_EQ(std::get<Pick>(route(request, guard, {true, true})),
            (Pick{"/points", 18446744073709551615U, 7}));
  for (const char* body :
       {"", "{}", R"({"topic":"/points","time_ns":1,"index":7})",
        R"({"topic":"/points","time_ns":"-1","index":7})",
        R"({"topic":"/points","time_ns":"","index":7})",
        R"({"topic":"/points","time_ns":"18446744073709551616","index":7})",
        R"({"topic":"/points","time_ns":"1","index":4294967296})", R"({"command":"stop"})"}) {
    request.body = body;
    EXPECT_EQ(reply_to(request).status, 400) << body;
  }
}

TEST(PageMessages, StateTheTimesOfAReplay) {
  EXPECT_EQ(playback_state_text({.is_playing = false, .time_ns = 5, .first_ns = 1, .last_ns = 9}),
            R"({"first_ns":"1","last_ns":"9","playing":false,"time_ns":"5"})");
  EXPECT_THAT(error_text([] { decode_playback_command(R"({"command":"stop"})"); }),
              HasSubstr("play, pause, step"));
}

}  // namespace
}  // namespace glidar::foxglove
