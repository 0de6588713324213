// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>

namespace glidar::testing {

/// Gives bytes to the decoders of the live view: messages of Foxglove clients, HTTP requests of the
/// page, and headers. True when they are a message of a client. Ends the program when a decoder
/// breaks a promise.
bool try_foxglove_decoders(std::span<const std::byte> bytes);

}  // namespace glidar::testing
