// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>

namespace glidar::testing {

/// Gives bytes to the sensors' interfaces for drivers. The first byte selects one: 0 HTTP of
/// Ouster, 1 PTC of Hesai, 2 commands of Livox, 3 parameters of Livox (id of the command, data), 4
/// packets of Livox, whose checksum is corrected. True when they are valid. Ends the program when a
/// promise is broken.
bool try_control_decoders(std::span<const std::byte> bytes);

}  // namespace glidar::testing
