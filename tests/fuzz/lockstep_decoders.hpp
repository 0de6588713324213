// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>

namespace glidar::testing {

/// Gives bytes to the decoder of lock-step requests; true when they are one. Ends the program when
/// the decoder breaks a promise.
bool try_lockstep_decoders(std::span<const std::byte> bytes);

}  // namespace glidar::testing
