// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace glidar::import {

/// The start of a file in a ZIP archive in memory, at most `max_bytes`; ignores the case of its
/// name. Empty if it is unreadable.
std::string zip_text(std::string_view archive, const std::string& name, std::size_t max_bytes);

/// The names in a ZIP archive, in its order; none if it is unreadable.
std::vector<std::string> zip_names(std::string_view archive);

/// The name of a file in an archive from a reference to it: "./a%20b.dae" or "/a%20b.dae" is
/// "a b.dae".
std::string zip_name(std::string_view reference);

}  // namespace glidar::import
