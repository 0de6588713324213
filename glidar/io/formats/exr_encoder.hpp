// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

namespace glidar {

/// One channel of an OpenEXR image, row by row.
struct ExrChannel {
  std::string name;  ///< "Z", "N.X"
  std::variant<std::vector<float>, std::vector<std::uint32_t>> pixels;
};

/// An image with one part; every channel has rows x cols pixels.
struct ExrImage {
  std::uint32_t rows = 0;
  std::uint32_t cols = 0;
  std::vector<ExrChannel> channels;
  std::string comments;  ///< attribute `comments` of the header
};

/// False in builds without OpenEXR.
bool has_openexr();

/// The bytes of a file of scan lines, ZIP compressed in blocks of 16 rows; they do not depend on
/// the time or the number of threads. `path` appears in errors. Throws Error when OpenEXR
/// refuses, and in builds without it.
std::string encode_exr(const ExrImage& image, const std::filesystem::path& path);

}  // namespace glidar
