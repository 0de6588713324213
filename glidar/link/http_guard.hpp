// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Protection of every HTTP server against web sites that the user of this machine visits: browsers
/// connect to servers on the user's own machine on behalf of any site, and state the site in the
/// header Origin (RFC 6454), Referer or Sec-Fetch-Site. By DNS rebinding, a site can give its own
/// name an address of this machine; then the header Host has that name, and nothing else reveals
/// it.
namespace glidar::link {

/// Web sites of Foxglove and Lichtblick; file:// is the origin of desktop programs, which browsers
/// do not let a web site claim.
std::vector<std::string> default_origins();

struct AccessRules {
  /// Origins, such as "https://example.org", whose pages may read the stream; "*": all.
  std::vector<std::string> origins = default_origins();
  /// Host names of this machine, beside localhost and numeric addresses; "*": all.
  std::vector<std::string> hosts = {};
};

/// Limits of one server. Requests beyond them are refused; the server continues.
struct HttpLimits {
  std::uint32_t header_bytes = 8192;
  std::size_t body_bytes = std::size_t{64} << 10U;
  std::size_t connections = 128;  ///< without a complete request; the oldest one makes room
  std::chrono::milliseconds request{10'000};  ///< from the connection to the complete request
  double requests_per_s = 500.0;              ///< allowed requests, in the mean
  double burst = 2000.0;                      ///< and at once
};

/// The parts of a request that decide who sent it.
struct HttpHead {
  std::string_view method;
  std::string_view host;
  std::string_view origin = {};
  std::string_view referer = {};
  std::string_view fetch_site = {};  ///< Sec-Fetch-Site
  bool is_ambiguous = false;         ///< one of these headers occurs twice
};

/// Whom a server answers.
enum class HttpClients : std::uint8_t {
  programs,   ///< no pages
  own_pages,  ///< also its own pages, and for reading those of AccessRules::origins
};

/// An answer instead of the requested one.
struct HttpRefusal {
  int status = 403;
  std::string_view text;
  bool operator==(const HttpRefusal&) const = default;
};

/// Decides about the requests of a server. Not thread-safe.
class HttpGuard {
 public:
  using Clock = std::chrono::steady_clock;

  HttpGuard(AccessRules rules, HttpClients clients, const HttpLimits& limits = {},
            std::function<Clock::time_point()> now = Clock::now);

  /// Why a request is not served at all; empty: it may read.
  [[nodiscard]] std::optional<HttpRefusal> refuse(const HttpHead& head);
  /// Why it may not change a state; for requests that refuse() lets pass. POST of pages needs this
  /// server's own page. GET may change only where a sensor's protocol has such commands: without
  /// pages, and with a numeric or allowed host.
  [[nodiscard]] std::optional<HttpRefusal> refuse_change(const HttpHead& head) const;
  [[nodiscard]] const HttpLimits& limits() const { return limits_; }

 private:
  bool take_token();

  AccessRules rules_;
  HttpClients clients_;
  HttpLimits limits_;
  std::function<Clock::time_point()> now_;
  double tokens_;  ///< of a token bucket: requests that may follow at once
  Clock::time_point last_;
};

/// Whether the header Host names this machine: a numeric address, localhost or an allowed name.
bool is_allowed_host(std::string_view host, const AccessRules& rules);

/// Whether a client with this origin may read: programs, which state none, pages of this server,
/// pages of other servers on this machine, and allowed origins.
bool is_allowed_origin(std::string_view origin, std::string_view host, const AccessRules& rules);

}  // namespace glidar::link
