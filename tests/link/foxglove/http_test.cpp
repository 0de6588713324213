// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/foxglove/access_rules.hpp>
#include <glidar/link/foxglove/http_routes.hpp>
#include <glidar/link/foxglove/page_files.hpp>

#include "support/error_text.hpp"

#include <gmock/gmock.h>

#include <variant>

namespace glidar::foxglove {
namespace {

using ::testing::HasSubstr;

TEST(AccessRules, AllowOnlyHostNamesThatNoForeignSiteCanHave) {
  const AccessRules rules{.hosts = {"Robot.local"}};
  for (const char* host : {"localhost", "LOCALHOST:8765", "a.localhost", "127.0.0.1:1",
                           "[::1]:8765", "192.168.1.7:8765", "robot.local:8765"}) {
    EXPECT_TRUE(is_allowed_host(host, rules)) << host;
  }
  for (const char* host :
       {"", ":8765", "attacker.example", "127.0.0.1.example", "[::1", "[]", "1.2.3"}) {
    EXPECT_FALSE(is_allowed_host(host, rules)) << host;
  }
  EXPECT_TRUE(is_allowed_host("any.example", {.hosts = {"*"}}));
}

TEST(AccessRules, AllowProgramsThisServersPageAndKnownViewers) {
  const AccessRules rules;
  for (const char* origin : {"", "http://robot:8765", "https://app.foxglove.dev", "file://",
                             "http://localhost:8080", "http://127.0.0.1", "http://[::1]:3000"}) {
    EXPECT_TRUE(is_allowed_origin(origin, "robot:8765", rules)) << origin;
  }
  for (const char* origin :
       {"null", "https://attacker.example", "http://robot:8766", "robot:8765",
        "https://app.foxglove.dev.attacker.example", "http://127.0.0.1.example"}) {
    EXPECT_FALSE(is_allowed_origin(origin, "robot:8765", rules)) << origin;
  }
  EXPECT_TRUE(is_allowed_origin("https://a.example", "robot", {.origins = {"https://a.example"}}));
}

HttpReply reply_to(const HttpRequest& request, const PageServices& services = {true, true}) {
  return std::get<HttpReply>(route(request, {}, services));
}

TEST(HttpRoutes, ServeEveryFileOfThePage) {
  for (const PageFile& file : page_files()) {
    const HttpReply reply = reply_to({"GET", file.target, "localhost"});
    EXPECT_EQ(reply.status, 200);
    EXPECT_EQ(reply.content_type, file.content_type);
    EXPECT_THAT(reply.body, HasSubstr("SPDX-License-Identifier: BSD-3-Clause")) << file.target;
  }
  EXPECT_EQ(reply_to({"GET", "/?layout=1", "localhost"}).status, 200);
  for (const char* target : {"", "/x", "//", "/../etc/passwd", "/main.js/", "main.js"}) {
    EXPECT_EQ(reply_to({"GET", target, "localhost"}).status, 404) << target;
  }
  EXPECT_EQ(reply_to({"GET", "/", "attacker.example"}).status, 403);
  EXPECT_EQ(reply_to({"PUT", "/", "localhost"}).status, 405);
}

TEST(HttpRoutes, AcceptCommandsFromTheServersOwnPageOnly) {
  HttpRequest request{"POST",
                      "/api/playback",
                      "localhost:1",
                      "http://localhost:1",
                      "application/json",
                      R"({"command":"step"})"};
  EXPECT_EQ(std::get<PlaybackCommand>(route(request, {}, {true, true})), PlaybackCommand::step);
  EXPECT_EQ(reply_to(request, {.has_playback = false, .has_picks = true}).status, 404);
  for (const char* origin : {"", "null", "http://localhost:2", "https://app.foxglove.dev"}) {
    request.origin = origin;
    EXPECT_EQ(reply_to(request).status, 403) << origin;
  }
  request.origin = "http://localhost:1";
  request.content_type = "text/plain";
  EXPECT_EQ(reply_to(request).status, 415);
}

TEST(HttpRoutes, DecodePicks) {
  HttpRequest request{"POST",
                      "/api/pick",
                      "localhost:1",
                      "http://localhost:1",
                      "application/json",
                      R"({"topic":"/points","time_ns":"18446744073709551615","index":7})"};
  EXPECT_EQ(std::get<Pick>(route(request, {}, {true, true})),
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
