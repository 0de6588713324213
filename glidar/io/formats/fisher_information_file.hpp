// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/sensor/fisher_information.hpp>

#include <filesystem>
#include <string>

namespace glidar {

/// The information as a table for people: bounds by axis, the six directions, what is degenerate.
std::string information_text(const FisherInformation& information);

/// The same as JSON, with the matrices and the convention; what is infinite is null.
std::string information_json(const FisherInformation& information);

/// Writes the JSON, whole or not at all.
void write_information(const FisherInformation& information, const std::filesystem::path& path);

}  // namespace glidar
