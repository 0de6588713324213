// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace glidar::import::gltf {

/// Whether it is a data URI, by its scheme, in letters of any case (RFC 3986).
bool is_data_uri(std::string_view uri);

/// The content of a data URI (RFC 2397), base64 (RFC 4648, both alphabets) or percent-encoded.
/// Nothing if it is malformed.
std::optional<std::string> data_uri_content(std::string_view uri);

}  // namespace glidar::import::gltf
