// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/formats/cloud_file.hpp>

#include <filesystem>
#include <string>

namespace glidar {

/// The JSON sidecar of a cloud at `path`; docs/files/sidecars.md lists its fields.
std::string sidecar_text(const CloudFile& job, const std::filesystem::path& path);

}  // namespace glidar
