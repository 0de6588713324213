// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/formats/cloud_file.hpp>

namespace glidar {

/// Writes cloud_from_object of the first instance without its scale, 4x4, one row per line, 17
/// digits. Throws Error when the frame has no instance.
void write_transform(const CloudFile& job, AtomicFile& file);

}  // namespace glidar
