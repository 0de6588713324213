// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

namespace glidar::import {

/// Descriptors for the records and the requests of the parent.
struct DecodeStreams {
  int answer = 0;
  int control = 0;
};

/// Reads a file or folder of this kind (DecoderKind::name) and writes its records, the last of
/// which is its end or the error. False: the kind is unknown.
bool decode_file(const std::string& kind, const std::filesystem::path& path,
                 const DecodeStreams& streams);

}  // namespace glidar::import
