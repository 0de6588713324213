// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>

namespace glidar::testing {

/// Gives the bytes to every decoder of the original GLIDAR protocol and checks what it promises of
/// a message it takes: that it writes the same bytes again, and holds nothing but numbers. Returns
/// whether any took it; aborts when a promise is broken.
bool try_woods2016_decoders(std::span<const std::byte> bytes);

}  // namespace glidar::testing
