// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/pictures/picture.hpp>

#include <array>
#include <cstdint>
#include <string_view>

namespace glidar::app {

/// The mapping of numbers to colours.
enum class ColourMap : std::uint8_t { viridis, rainbow, grey };
inline constexpr std::array<std::string_view, 3> kColourMaps = {"viridis", "rainbow", "grey"};

/// The colour of a number from 0 (dark, or blue) to 1 (bright, or red), clamped.
Colour colour_of(ColourMap map, double t);

}  // namespace glidar::app
