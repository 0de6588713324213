// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace glidar::testing {

/// Reads a model with the reader of GLIDAR's own for its name. Throws Error for what it refuses.
void read_model_file(const std::filesystem::path& file);

}  // namespace glidar::testing
