// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace glidar::import {

/// The next bytes of a text; empty at its end.
using TextSource = std::function<std::string()>;

/// A text in memory, which must outlive the source.
TextSource plain_text(std::string_view text);

/// A file in a ZIP archive in memory, ignoring case; an unreadable file has no bytes.
TextSource zip_text(std::string_view archive, const std::string& name);

/// The names in a ZIP archive, in its order; none if it is unreadable.
std::vector<std::string> zip_names(std::string_view archive);

/// The name of a file in an archive from a reference to it: "./a%20b.dae" or "/a%20b.dae" is
/// "a b.dae".
std::string zip_name(std::string_view reference);

}  // namespace glidar::import
