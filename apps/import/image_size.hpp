// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <span>

namespace glidar::import {

struct ImageSize {
  std::uint64_t width = 0;
  std::uint64_t height = 0;
};

/// The size in the header of a PNG or binary PNM image; a missing number is 0. Versions of
/// stb_image accept different sizes, and report no size for those that they reject. Empty for other
/// formats.
std::optional<ImageSize> declared_size(std::span<const std::uint8_t> bytes);

}  // namespace glidar::import
