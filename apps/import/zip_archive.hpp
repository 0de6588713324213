// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace glidar::import {

/// The start of a file in a ZIP archive in memory, at most `max_bytes`; ignores the case of its
/// name. Empty if it is unreadable.
std::string zip_text(std::string_view archive, const std::string& name, std::size_t max_bytes);

/// A whole file in a ZIP archive, of any size that its compressed data can have (ZIP64 too). Throws
/// Refusal if it is damaged.
std::string zip_content(std::string_view archive, const std::string& name);

/// A plain ZIP archive of these files, not compressed.
std::string make_zip(const std::map<std::string, std::string>& files);

/// The names in a ZIP archive, in its order; none if it is unreadable.
std::vector<std::string> zip_names(std::string_view archive);

/// The name of a file in an archive from a reference to it: "./a%20b.dae" or "/a%20b.dae" is
/// "a b.dae".
std::string zip_name(std::string_view reference);

}  // namespace glidar::import
