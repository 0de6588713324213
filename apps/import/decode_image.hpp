// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <import/source_model.hpp>

#include <glidar/core/material.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace glidar::import {

/// A decoded image, or the reason why there is none.
struct Decoded {
  Texture texture;
  std::string reason;  ///< empty: decoded
};

/// Decodes PNG, JPEG, WebP, BMP, TGA, GIF, PSD, HDR or PNM to 8 bits. Checks the size before
/// allocating memory: at most 16384 pixels per side, 256 MiB decoded, and `budget` bytes. Drops an
/// alpha channel that is opaque everywhere.
Decoded decode_image(std::span<const std::uint8_t> bytes, std::uint64_t budget);

/// An image inside the model file: compressed bytes, or raw texels.
Decoded decode_embedded(EmbeddedImage image, std::uint64_t budget);

/// "data:image/png;base64,...".
Decoded decode_data_uri(const std::string& uri, std::uint64_t budget);

}  // namespace glidar::import
