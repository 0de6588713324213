// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

/// Protection against web sites that the user of this machine visits: browsers connect to servers
/// on the user's own machine on behalf of any site, and state the site in the header Origin (RFC
/// 6454). By DNS rebinding, a site can give its own name an address of this machine; then the
/// header Host has that name.
namespace glidar::foxglove {

/// Web sites of Foxglove and Lichtblick; file:// is the origin of desktop programs, which browsers
/// do not let a web site claim.
std::vector<std::string> default_origins();

struct AccessRules {
  /// Origins, such as "https://example.org", whose pages may read the stream; "*": all.
  std::vector<std::string> origins = default_origins();
  /// Host names of this machine, beside localhost and numeric addresses; "*": all.
  std::vector<std::string> hosts = {};
};

/// Whether the header Host names this machine: a numeric address, localhost or an allowed name.
bool is_allowed_host(std::string_view host, const AccessRules& rules);

/// Whether a page of this origin was loaded from this server.
bool is_same_origin(std::string_view origin, std::string_view host);

/// Whether a client with this origin may read the stream: programs, which state none, pages of this
/// server, pages of other servers on this machine, and allowed origins.
bool is_allowed_origin(std::string_view origin, std::string_view host, const AccessRules& rules);

}  // namespace glidar::foxglove
