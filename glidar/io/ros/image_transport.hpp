// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace glidar::ros {

/// How the images of cameras are published.
enum class ImageTransport : std::uint8_t {
  raw,         ///< depth as Image
  compressed,  ///< depth and intensity as CompressedImage
  both,
};

}  // namespace glidar::ros
