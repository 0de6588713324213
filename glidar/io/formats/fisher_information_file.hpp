// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/sensor/fisher_information.hpp>

#include <filesystem>
#include <string>

namespace glidar {

/// The information as a readable table: bounds per axis, the six directions, degeneracy.
std::string information_text(const FisherInformation& information);

/// The same as JSON, with the matrices and the convention; infinite values are null.
std::string information_json(const FisherInformation& information);

/// Writes the JSON atomically.
void write_information(const FisherInformation& information, const std::filesystem::path& path);

}  // namespace glidar
