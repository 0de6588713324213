// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace glidar::import::gltf {

/// The content of a data URI (RFC 2397), base64 (RFC 4648, both alphabets) or percent-encoded.
/// Nothing if it is malformed.
std::optional<std::string> data_uri_content(std::string_view uri);

}  // namespace glidar::import::gltf
