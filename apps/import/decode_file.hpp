// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/decoder/decoder_process.hpp>

#include <filesystem>
#include <string>

namespace glidar::import {

/// Reads a file or folder of this kind (DecoderKind::name) and writes its records to the answer and
/// the shared memory, the last of which is its end or the error. The control has the requests of
/// the parent. False: the kind is unknown.
bool decode_file(const std::string& kind, const std::filesystem::path& path, const HelperFds& fds);

}  // namespace glidar::import
