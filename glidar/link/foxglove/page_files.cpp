// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/foxglove/page_files.hpp>

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

}  // namespace glidar::foxglove
