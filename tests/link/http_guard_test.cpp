// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/http_guard.hpp>

#include <gtest/gtest.h>

namespace glidar::link {
namespace {

TEST(AccessRules, AllowOnlyHostNamesThatNoForeignSiteCanHave) {
  const AccessRules rules{.hosts = {"Robot.local"}};
  for (const char* host : {"localhost", "LOCALHOST:8765", "a.localhost", "127.0.0.1:1",
                           "[::1]:8765", "192.168.1.7:8765", "robot.local:8765"}) {
    EXPECT_TRUE(is_allowed_host(host, rules)) << host;
  }
  for (const char* host :
       {"", ":8765", "attacker.example", "127.0.0.1.example", "[::1", "[]", "1.2.3",
        "[::1]attacker.example", "[127.0.0.1]attacker.example:80", "[localhost]", "127.0.0.1:x",
        "127.0.0.1:123456", "127.0.0.1:80:90", "localhost:80/x"}) {
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
        "https://app.foxglove.dev.attacker.example", "http://127.0.0.1.example",
        "http://[::1].attacker.example", "http://127.0.0.1:80/x"}) {
    EXPECT_FALSE(is_allowed_origin(origin, "robot:8765", rules)) << origin;
  }
  EXPECT_TRUE(is_allowed_origin("https://a.example", "robot", {.origins = {"https://a.example"}}));
}

int refused(const HttpHead& head, HttpClients clients, const AccessRules& rules = {}) {
  const auto refusal = HttpGuard(rules, clients).refuse(head);
  return refusal ? refusal->status : 0;
}

int change_refused(const HttpHead& head, HttpClients clients, const AccessRules& rules = {}) {
  const auto refusal = HttpGuard(rules, clients).refuse_change(head);
  return refusal ? refusal->status : 0;
}

TEST(HttpGuard, RefusesForeignHostsMethodsAndAmbiguousHeadersOnEveryServer) {
  for (const HttpClients clients : {HttpClients::programs, HttpClients::own_pages}) {
    for (const char* method : {"GET", "HEAD", "POST"})
      EXPECT_EQ(refused({method, "127.0.0.1:80"}, clients), 0) << method;
    for (const char* method : {"PUT", "DELETE", "CONNECT", "TRACE", "OPTIONS", "get", ""})
      EXPECT_EQ(refused({method, "127.0.0.1"}, clients), 405) << method;
    for (const char* host : {"evil.example", "", "127.0.0.1.evil.example", "evil.example:80"})
      EXPECT_EQ(refused({"GET", host}, clients), 403) << host;
    HttpHead twice{"GET", "127.0.0.1"};
    twice.is_ambiguous = true;
    EXPECT_EQ(refused(twice, clients), 400);
    EXPECT_EQ(refused({"GET", "127.0.0.1", "https://evil.example"}, clients), 403);
  }
}

TEST(HttpGuard, PagesHaveNoAccessToServersOfPrograms) {
  HttpHead head{"GET", "127.0.0.1"};
  for (const char* site : {"", "none"}) {
    head.fetch_site = site;
    EXPECT_EQ(refused(head, HttpClients::programs), 0) << site;
  }
  for (const char* site : {"cross-site", "same-site", "same-origin", "x"}) {
    head.fetch_site = site;
    EXPECT_EQ(refused(head, HttpClients::programs), 403) << site;
    EXPECT_EQ(refused(head, HttpClients::own_pages), 0) << site;
  }
  EXPECT_EQ(refused({"GET", "127.0.0.1", "http://127.0.0.1"}, HttpClients::programs), 403);
  EXPECT_EQ(refused({"GET", "127.0.0.1", "", "http://127.0.0.1/"}, HttpClients::programs), 403);
  EXPECT_EQ(refused({"GET", "127.0.0.1", "", "http://127.0.0.1/"}, HttpClients::own_pages), 0);
}

TEST(HttpGuard, GetChangesStatesOfServersOfProgramsAtSureHostsOnly) {
  const AccessRules rules{.hosts = {"sensor.lan"}};
  for (const char* host : {"127.0.0.1:80", "[::1]", "sensor.lan:80", "SENSOR.LAN"}) {
    EXPECT_EQ(change_refused({"GET", host}, HttpClients::programs, rules), 0) << host;
    EXPECT_EQ(change_refused({"HEAD", host}, HttpClients::programs, rules), 403) << host;
    EXPECT_EQ(change_refused({"GET", host}, HttpClients::own_pages, rules), 403) << host;
  }
  for (const char* host : {"localhost", "localhost:80", "other.lan"})
    EXPECT_EQ(change_refused({"GET", host}, HttpClients::programs, rules), 403) << host;
}

TEST(HttpGuard, PostChangesStatesForProgramsAndTheServersOwnPageOnly) {
  EXPECT_EQ(change_refused({"POST", "localhost:1"}, HttpClients::programs), 0);
  EXPECT_EQ(change_refused({"POST", "localhost:1"}, HttpClients::own_pages), 403);
  EXPECT_EQ(change_refused({"POST", "localhost:1", "http://localhost:1"}, HttpClients::own_pages),
            0);
  EXPECT_EQ(change_refused({"POST", "localhost:1", "http://localhost:2"}, HttpClients::own_pages),
            403);
}

TEST(HttpGuard, AllowsRequestsAtARateAndDoesNotCountThoseOfPages) {
  HttpGuard::Clock::time_point now{};
  HttpGuard guard({}, HttpClients::programs, {.requests_per_s = 10.0, .burst = 3.0},
                  [&] { return now; });
  const HttpHead head{"GET", "127.0.0.1"};
  for (int i = 0; i < 100; ++i) EXPECT_EQ(guard.refuse({"GET", "evil.example"})->status, 403);
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(guard.refuse(head));
  EXPECT_EQ(guard.refuse(head)->status, 429);
  now += std::chrono::milliseconds(100);
  EXPECT_FALSE(guard.refuse(head));
  EXPECT_EQ(guard.refuse(head)->status, 429);
  now += std::chrono::hours(1);
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(guard.refuse(head));
  EXPECT_EQ(guard.refuse(head)->status, 429) << "no more than a burst";
}

}  // namespace
}  // namespace glidar::link
