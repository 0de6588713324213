// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string_view>

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

}  // namespace glidar::foxglove
