// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/bags/sqlite_file.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/bags/bag_file.hpp>

#include <sqlite3.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <new>
#include <span>

namespace glidar::bags {
namespace {

/// SQLite allocates it, and knows its first member.
struct DatabaseFile {
  sqlite3_file base;
  BagFile* bag;
};

BagFile& bag_of(sqlite3_file* file) {
  return *reinterpret_cast<DatabaseFile*>(file)->bag;
}

int close_database(sqlite3_file* file) {
  delete reinterpret_cast<DatabaseFile*>(file)->bag;
  return SQLITE_OK;
}

/// Bytes beyond the end are 0, as SQLite requires.
int read_database(sqlite3_file* file, void* to, int count, sqlite3_int64 offset) {
  BagFile& bag = bag_of(file);
  const std::span<std::byte> bytes(static_cast<std::byte*>(to), static_cast<std::size_t>(count));
  const auto at = static_cast<std::uint64_t>(offset);
  const std::uint64_t there = bag.size() - std::min(at, bag.size());
  const std::size_t found = std::min<std::uint64_t>(there, bytes.size());
  try {
    if (found > 0) bag.copy(at, bytes.first(found));
  } catch (const Error&) {
    return SQLITE_IOERR_READ;
  } catch (const std::bad_alloc&) {
    return SQLITE_IOERR_NOMEM;
  }
  std::ranges::fill(bytes.subspan(found), std::byte{0});
  return found == bytes.size() ? SQLITE_OK : SQLITE_IOERR_SHORT_READ;
}

int refuse_write(sqlite3_file* /*file*/, const void* /*from*/, int /*count*/,
                 sqlite3_int64 /*offset*/) {
  return SQLITE_READONLY;
}

int refuse_size(sqlite3_file* /*file*/, sqlite3_int64 /*size*/) {
  return SQLITE_READONLY;
}

int size_of_database(sqlite3_file* file, sqlite3_int64* size) {
  *size = static_cast<sqlite3_int64>(bag_of(file).size());
  return SQLITE_OK;
}

int accept(sqlite3_file* /*file*/, int /*what*/) {
  return SQLITE_OK;
}

int find_no_lock(sqlite3_file* /*file*/, int* is_locked) {
  *is_locked = 0;
  return SQLITE_OK;
}

int know_no_control(sqlite3_file* /*file*/, int /*control*/, void* /*argument*/) {
  return SQLITE_NOTFOUND;
}

int sector_size(sqlite3_file* /*file*/) {
  return 4096;
}

int characteristics(sqlite3_file* /*file*/) {
  return SQLITE_IOCAP_IMMUTABLE;
}

sqlite3_io_methods file_methods() {
  sqlite3_io_methods methods{};
  methods.iVersion = 1;
  methods.xClose = close_database;
  methods.xRead = read_database;
  methods.xWrite = refuse_write;
  methods.xTruncate = refuse_size;
  methods.xSync = accept;
  methods.xFileSize = size_of_database;
  methods.xLock = accept;
  methods.xUnlock = accept;
  methods.xCheckReservedLock = find_no_lock;
  methods.xFileControl = know_no_control;
  methods.xSectorSize = sector_size;
  methods.xDeviceCharacteristics = characteristics;
  return methods;
}

int open_database(sqlite3_vfs* /*vfs*/, const char* name, sqlite3_file* file, int flags,
                  int* out_flags) {
  static const sqlite3_io_methods kMethods = file_methods();
  file->pMethods = nullptr;
  if (name == nullptr || (flags & SQLITE_OPEN_MAIN_DB) == 0) return SQLITE_CANTOPEN;
  try {
    reinterpret_cast<DatabaseFile*>(file)->bag = std::make_unique<BagFile>(name).release();
  } catch (const Error&) {
    return SQLITE_CANTOPEN;
  } catch (const std::bad_alloc&) {
    return SQLITE_NOMEM;
  }
  file->pMethods = &kMethods;
  if (out_flags != nullptr) *out_flags = SQLITE_OPEN_MAIN_DB | SQLITE_OPEN_READONLY;
  return SQLITE_OK;
}

int refuse_delete(sqlite3_vfs* /*vfs*/, const char* /*name*/, int /*is_synced*/) {
  return SQLITE_IOERR_DELETE;
}

int find_nothing(sqlite3_vfs* /*vfs*/, const char* /*name*/, int /*flags*/, int* is_there) {
  *is_there = 0;
  return SQLITE_OK;
}

int keep_name(sqlite3_vfs* /*vfs*/, const char* name, int size, char* to) {
  const std::size_t bytes = std::strlen(name) + 1;
  if (bytes > static_cast<std::size_t>(size)) return SQLITE_CANTOPEN;
  std::memcpy(to, name, bytes);
  return SQLITE_OK;
}

sqlite3_vfs make_vfs() {
  // SQLite needs these for what no reader does, such as random row ids
  const sqlite3_vfs* system = sqlite3_vfs_find(nullptr);
  sqlite3_vfs vfs{};
  vfs.iVersion = 1;
  vfs.szOsFile = sizeof(DatabaseFile);
  vfs.mxPathname = system->mxPathname;
  vfs.zName = "glidar-read-only";
  vfs.pAppData = system->pAppData;
  vfs.xOpen = open_database;
  vfs.xDelete = refuse_delete;
  vfs.xAccess = find_nothing;
  vfs.xFullPathname = keep_name;
  vfs.xRandomness = system->xRandomness;
  vfs.xSleep = system->xSleep;
  vfs.xCurrentTime = system->xCurrentTime;
  vfs.xGetLastError = system->xGetLastError;
  return vfs;
}

}  // namespace

const char* sqlite_read_only_vfs() {
  static sqlite3_vfs vfs = make_vfs();
  static const int registered = sqlite3_vfs_register(&vfs, 0);
  if (registered != SQLITE_OK) throw Error({"SQLite", "no memory for its layer over files"});
  return vfs.zName;
}

}  // namespace glidar::bags
