// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io: the list that remove_unfinished_files() (atomic_file.hpp) works through.

#include <string>

namespace glidar {

/// Lists a temporary file, or a folder of such files, which must be listed before them. Returns its
/// slot; -1 when the list is full or the path is too long.
int list_unfinished(const std::string& path);

/// Takes a file from the list; a slot of -1 is ignored.
void unlist_unfinished(int slot);

}  // namespace glidar
