// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/foxglove/access_rules.hpp>

#include <arpa/inet.h>
#include <netinet/in.h>

#include <algorithm>
#include <array>

namespace glidar::foxglove {
namespace {

std::string in_lower_case(std::string_view text) {
  std::string lower(text);
  for (char& letter : lower) {
    if (letter >= 'A' && letter <= 'Z') letter = static_cast<char>(letter - 'A' + 'a');
  }
  return lower;
}

bool is_listed(const std::vector<std::string>& list, std::string_view text) {
  return std::any_of(list.begin(), list.end(), [&](const std::string& entry) {
    return entry == "*" || in_lower_case(entry) == text;
  });
}

/// "localhost" of "localhost:8765", "::1" of "[::1]:8765"; empty if invalid.
std::string host_name(std::string_view host) {
  if (host.starts_with('[')) {
    const std::size_t end = host.find(']');
    return end == std::string_view::npos ? std::string() : std::string(host.substr(1, end - 1));
  }
  return in_lower_case(host.substr(0, host.find(':')));
}

bool is_numeric(const std::string& name) {
  std::array<unsigned char, sizeof(in6_addr)> address{};
  return inet_pton(AF_INET, name.c_str(), address.data()) == 1 ||
         inet_pton(AF_INET6, name.c_str(), address.data()) == 1;
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

bool is_same_origin(std::string_view origin, std::string_view host) {
  const std::string_view from = authority(origin);
  return !from.empty() && in_lower_case(from) == in_lower_case(host);
}

bool is_allowed_origin(std::string_view origin, std::string_view host, const AccessRules& rules) {
  if (origin.empty() || is_same_origin(origin, host)) return true;
  return is_on_this_machine(host_name(authority(origin))) ||
         is_listed(rules.origins, in_lower_case(origin));
}

}  // namespace glidar::foxglove
