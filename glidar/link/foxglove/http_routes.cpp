// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/foxglove/http_routes.hpp>

#include <glidar/core/error.hpp>

#include <algorithm>
#include <vector>

namespace glidar::foxglove {
namespace {

std::vector<PageFile> list_page_files() {
  constexpr std::string_view kHtml = "text/html; charset=utf-8";
  constexpr std::string_view kScript = "text/javascript; charset=utf-8";
  std::vector<PageFile> files = {{"/", kHtml, page_text("index.html")},
                                 {"/style.css", "text/css; charset=utf-8", page_text("style.css")},
                                 {"/icon.svg", "image/svg+xml", page_text("icon.svg")}};
  for (const std::string_view target :
       {"/main.js", "/connection.js", "/cdr.js", "/ros_messages.js", "/cloud.js", "/colours.js",
        "/transforms.js", "/vectors.js", "/scene.js", "/shaders.js", "/view.js", "/controls.js",
        "/images.js", "/panels.js", "/picking.js", "/playback.js"}) {
    files.push_back({target, kScript, page_text(target.substr(1))});
  }
  return files;
}

}  // namespace

std::span<const PageFile> page_files() {
  static const std::vector<PageFile> files = list_page_files();
  return files;
}

const PageFile* find_page_file(std::string_view target) {
  const auto files = page_files();
  const auto found = std::find_if(files.begin(), files.end(),
                                  [&](const PageFile& file) { return file.target == target; });
  return found == files.end() ? nullptr : &*found;
}

namespace {

HttpReply plain(int status, const std::string& text) {
  return {.status = status, .content_type = "text/plain; charset=utf-8", .body = text + "\n"};
}

HttpReply plain(const link::HttpRefusal& refusal) {
  return plain(refusal.status, std::string(refusal.text));
}

HttpReply get(std::string_view target) {
  const PageFile* file = find_page_file(target.substr(0, target.find('?')));
  if (file == nullptr) return plain(404, "not found");
  return {.status = 200,
          .content_type = std::string(file->content_type),
          .body = std::string(file->text)};
}

HttpAction post(const HttpRequest& request, const link::HttpGuard& guard,
                const PageServices& services) {
  const bool is_playback = request.target == "/api/playback";
  const bool is_pick = request.target == "/api/pick";
  if (!(is_playback && services.has_playback) && !(is_pick && services.has_picks)) {
    return plain(404, "not found");
  }
  if (const auto refusal = guard.refuse_change(request.head)) return plain(*refusal);
  if (request.content_type != "application/json") return plain(415, "not application/json");
  try {
    if (is_playback) return decode_playback_command(request.body);
    return decode_pick(request.body);
  } catch (const Error& error) {
    return plain(400, error.what());
  }
}

}  // namespace

HttpAction route(const HttpRequest& request, link::HttpGuard& guard, const PageServices& services) {
  if (const auto refusal = guard.refuse(request.head)) return plain(*refusal);
  return request.head.method == "POST" ? post(request, guard, services) : get(request.target);
}

}  // namespace glidar::foxglove
