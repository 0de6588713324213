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

/// Upper bound of the size of a reply, known before its clouds are measured.
std::int64_t reply_bytes(std::span<const std::string> columns, std::size_t points,
                         std::size_t clouds);

}  // namespace glidar::app
