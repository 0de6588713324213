// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/http_guard.hpp>

#include <glidar/core/text.hpp>

#include <arpa/inet.h>
#include <netinet/in.h>

#include <algorithm>
#include <utility>

namespace glidar::link {
namespace {

bool is_listed(const std::vector<std::string>& list, std::string_view text) {
  return std::any_of(list.begin(), list.end(), [&](const std::string& entry) {
    return entry == "*" || lower_case(entry) == text;
  });
}

bool is_ipv6(const std::string& name) {
  in6_addr address{};
  return inet_pton(AF_INET6, name.c_str(), &address) == 1;
}

bool is_numeric(const std::string& name) {
  in_addr address{};
  return inet_pton(AF_INET, name.c_str(), &address) == 1 || is_ipv6(name);
}

/// Empty, or a colon and a port, which may be empty (RFC 3986, 3.2.3).
bool is_port(std::string_view text) {
  constexpr std::size_t kMaxDigits = 5;
  return text.empty() || (text.starts_with(':') && text.size() <= 1 + kMaxDigits &&
                          text.find_first_not_of("0123456789", 1) == std::string_view::npos);
}

/// "localhost" of "localhost:8765", "::1" of "[::1]:8765"; empty if invalid.
std::string host_name(std::string_view host) {
  if (host.starts_with('[')) {
    const std::size_t end = host.find(']');
    if (end == std::string_view::npos || !is_port(host.substr(end + 1))) return "";
    const std::string name(host.substr(1, end - 1));
    return is_ipv6(name) ? name : "";
  }
  const std::size_t end = std::min(host.find(':'), host.size());
  return is_port(host.substr(end)) ? lower_case(host.substr(0, end)) : "";
}

bool is_localhost(const std::string& name) {
  return name == "localhost" || name.ends_with(".localhost");  // RFC 6761, 6.3
}

/// What follows "http://" or "https://"; empty for other origins.
std::string_view authority(std::string_view origin) {
  for (const std::string_view scheme : {"http://", "https://"}) {
    if (origin.starts_with(scheme)) return origin.substr(scheme.size());
  }
  return {};
}

bool is_on_this_machine(const std::string& name) {
  return is_localhost(name) || name == "::1" || (name.starts_with("127.") && is_numeric(name));
}

/// Whether a page of this origin was loaded from this server.
bool is_same_origin(std::string_view origin, std::string_view host) {
  const std::string_view from = authority(origin);
  return !from.empty() && lower_case(from) == lower_case(host);
}

/// Browsers mark what pages send; "none" is an address that the user has typed.
bool is_from_page(const HttpHead& head) {
  return !head.origin.empty() || !head.referer.empty() ||
         !(head.fetch_site.empty() || head.fetch_site == "none");
}

}  // namespace

std::vector<std::string> default_origins() {
  return {"https://app.foxglove.dev", "https://studio.foxglove.dev",
          "https://lichtblick-suite.github.io", "file://"};
}

bool is_allowed_host(std::string_view host, const AccessRules& rules) {
  const std::string name = host_name(host);
  if (name.empty()) return false;
  return is_localhost(name) || is_numeric(name) || is_listed(rules.hosts, name);
}

bool is_allowed_origin(std::string_view origin, std::string_view host, const AccessRules& rules) {
  if (origin.empty() || is_same_origin(origin, host)) return true;
  return is_on_this_machine(host_name(authority(origin))) ||
         is_listed(rules.origins, lower_case(origin));
}

HttpGuard::HttpGuard(AccessRules rules, HttpClients clients, const HttpLimits& limits,
                     std::function<Clock::time_point()> now)
    : rules_(std::move(rules)),
      clients_(clients),
      limits_(limits),
      now_(std::move(now)),
      tokens_(limits.burst),
      last_(now_()) {}

std::optional<HttpRefusal> HttpGuard::refuse(const HttpHead& head) {
  if (head.is_ambiguous) return HttpRefusal{400, "a header that is given twice"};
  if (!is_allowed_host(head.host, rules_))
    return HttpRefusal{403, "unknown host name; use an address, localhost or an allowed name"};
  if (clients_ == HttpClients::programs && is_from_page(head))
    return HttpRefusal{403, "web pages have no access"};
  if (!is_allowed_origin(head.origin, head.host, rules_))
    return HttpRefusal{403, "pages of this origin have no access"};
  if (head.method != "GET" && head.method != "HEAD" && head.method != "POST")
    return HttpRefusal{405, "GET, HEAD or POST"};
  if (!take_token()) return HttpRefusal{429, "too many requests; try again later"};
  return std::nullopt;
}

std::optional<HttpRefusal> HttpGuard::refuse_change(const HttpHead& head) const {
  if (head.method == "POST") {
    if (clients_ == HttpClients::programs || is_same_origin(head.origin, head.host))
      return std::nullopt;
    return HttpRefusal{403, "only the page of this server may send this request"};
  }
  const std::string name = host_name(head.host);
  const bool is_sure = is_numeric(name) || is_listed(rules_.hosts, name);
  if (head.method == "GET" && clients_ == HttpClients::programs && is_sure) return std::nullopt;
  return HttpRefusal{403,
                     "it changes the sensor; send GET with a numeric or allowed host, or POST"};
}

/// A token bucket: every allowed request takes a token, and time brings new ones.
bool HttpGuard::take_token() {
  const Clock::time_point now = now_();
  const double seconds = std::chrono::duration<double>(now - std::exchange(last_, now)).count();
  tokens_ = std::min(limits_.burst, tokens_ + seconds * limits_.requests_per_s);
  if (tokens_ < 1.0) return false;
  tokens_ -= 1.0;
  return true;
}

}  // namespace glidar::link
