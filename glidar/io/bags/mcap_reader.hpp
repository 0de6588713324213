// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io/bags.

#include <glidar/io/bags/chunk_merger.hpp>

namespace glidar::bags {

/// Opens an MCAP file with or without chunks, indexes and summary; what it reads counts in the
/// budget. Throws Error when it is damaged or has no footer, because a program ended before it was
/// complete.
std::unique_ptr<BagReader> open_mcap(const std::filesystem::path& path, SharedBudget budget);

}  // namespace glidar::bags
