// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/foxglove/http_routes.hpp>

#include <glidar/core/error.hpp>
#include <glidar/link/foxglove/page_files.hpp>

namespace glidar::foxglove {
namespace {

HttpReply plain(int status, const std::string& text) {
  return {.status = status, .content_type = "text/plain; charset=utf-8", .body = text + "\n"};
}

HttpReply get(std::string_view target) {
  const PageFile* file = find_page_file(target.substr(0, target.find('?')));
  if (file == nullptr) return plain(404, "not found");
  return {.status = 200,
          .content_type = std::string(file->content_type),
          .body = std::string(file->text)};
}

HttpAction post(const HttpRequest& request, const PageServices& services) {
  const bool is_playback = request.target == "/api/playback";
  const bool is_pick = request.target == "/api/pick";
  if (!(is_playback && services.has_playback) && !(is_pick && services.has_picks)) {
    return plain(404, "not found");
  }
  if (!is_same_origin(request.origin, request.host)) {
    return plain(403, "only the page of this server may send this request");
  }
  if (request.content_type != "application/json") return plain(415, "not application/json");
  try {
    if (is_playback) return decode_playback_command(request.body);
    return decode_pick(request.body);
  } catch (const Error& error) {
    return plain(400, error.what());
  }
}

}  // namespace

HttpAction route(const HttpRequest& request, const AccessRules& rules,
                 const PageServices& services) {
  if (!is_allowed_host(request.host, rules)) {
    return plain(403, "unknown host name; use an address, localhost or an allowed name");
  }
  if (request.method == "GET" || request.method == "HEAD") return get(request.target);
  if (request.method == "POST") return post(request, services);
  return plain(405, "GET, HEAD or POST");
}

}  // namespace glidar::foxglove
