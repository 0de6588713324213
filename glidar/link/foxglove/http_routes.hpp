// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/link/foxglove/messages.hpp>
#include <glidar/link/http_guard.hpp>

#include <span>
#include <string>
#include <string_view>
#include <variant>

namespace glidar::foxglove {

/// A file of the page, which the program contains.
struct PageFile {
  std::string_view target;  ///< e.g. "/main.js"
  std::string_view content_type;
  std::string_view text;
};

/// The file of an HTTP target; nullptr if there is none.
const PageFile* find_page_file(std::string_view target);

/// All files.
std::span<const PageFile> page_files();

/// The text of a file in page/ by its name.
std::string_view page_text(std::string_view file);

/// The parts of an HTTP request that decide the answer.
struct HttpRequest {
  link::HttpHead head;
  std::string_view target;
  std::string_view content_type = {};
  std::string_view body = {};
};

struct HttpReply {
  int status = 200;
  std::string content_type;
  std::string body;
};

/// What the page can request of the caller.
struct PageServices {
  bool has_playback = false;
  bool has_picks = false;
};

/// A reply, or a request that the caller answers.
using HttpAction = std::variant<HttpReply, PlaybackCommand, Pick>;

/// GET of the page's files; POST of /api/playback and /api/pick, which only the page itself may
/// use.
HttpAction route(const HttpRequest& request, link::HttpGuard& guard, const PageServices& services);

/// Sent with every reply: scripts, styles and connections only from and to this server.
inline constexpr std::string_view kContentSecurityPolicy =
    "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; "
    "img-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

}  // namespace glidar::foxglove
