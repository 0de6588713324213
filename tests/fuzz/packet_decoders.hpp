// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace glidar::testing {

/// Decodes packets of a sensor: the first byte selects the sensor, the rest are payloads of its
/// size.
void read_packets(const std::filesystem::path& file);

/// Decodes the datagrams of a capture file as packets of a VLP-16.
void read_capture(const std::filesystem::path& file);

}  // namespace glidar::testing
