// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace glidar::app {

/// Bytes of one point in a cloud with these columns. Throws Error on an unknown name.
std::int64_t point_bytes(std::span<const std::string> columns);

/// At most so many bytes has a reply with so many clouds, which are known before they are measured.
std::int64_t reply_bytes(std::span<const std::string> columns, std::size_t points,
                         std::size_t clouds);

}  // namespace glidar::app
