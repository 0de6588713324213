// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/formats/cloud_file.hpp>

namespace glidar {

/// Writes a line of field names, then a line per point, with the shortest digits that represent
/// each number exactly.
void write_csv(const CloudFile& job, AtomicFile& file);

}  // namespace glidar
