// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io/formats.

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glidar {

/// The standard class of a name, in any case and with spaces, '-' or '_' between words: LAS
/// Specification 1.4 R15, table 17. 0: it has none.
std::uint8_t las_standard_class(std::string_view name);

/// The code of every class of a scene, by its id: the standard class, or a user-definable code, 63
/// plus the id, up to 255. Unlabelled objects (id 0), and classes of larger ids without a standard
/// class, are 1: unclassified.
std::vector<std::uint8_t> las_class_codes(std::span<const std::string> class_names);

/// The code of points that hit no object of a class.
inline constexpr std::uint8_t kLasUnclassified = 1;

}  // namespace glidar
