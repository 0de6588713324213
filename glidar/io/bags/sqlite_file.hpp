// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io/bags.

namespace glidar::bags {

/// Name of a layer of SQLite over the file system (sqlite3_vfs) that opens databases only for
/// reading, as BagFile. It creates, locks and deletes no file and finds no log beside the database.
/// It reads ahead where SQLite reads every page by a call of its own.
const char* sqlite_read_only_vfs();

}  // namespace glidar::bags
