// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace glidar::app {

/// Prints the IMU presets as a table, or as JSON.
void list_imus(bool as_json);

/// The file of an IMU preset with this name, in capitals or not.
std::optional<std::filesystem::path> imu_preset_named(const std::string& name);

/// Prints an IMU with the sources of its numbers, or as JSON.
void print_imu(const std::filesystem::path& file, bool as_json);

}  // namespace glidar::app
