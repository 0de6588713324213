// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/bags/sqlite.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/text.hpp>
#include <glidar/io/bags/bag_storage.hpp>

#include <fmt/format.h>
#include <sqlite3.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <memory>
#include <new>
#include <span>
#include <utility>

namespace glidar::bags {

namespace {

constexpr int kStepsBetween = 1000;  // calls of the progress handler
constexpr std::uint64_t kMinLength = 100'000;
constexpr std::uint64_t kMaxLength = 1'000'000'000;  // SQLite's own

/// rosbag2 needs far less.
constexpr std::array<std::pair<int, int>, 6> kLimits = {{{SQLITE_LIMIT_SQL_LENGTH, 100'000},
                                                         {SQLITE_LIMIT_COLUMN, 100},
                                                         {SQLITE_LIMIT_EXPR_DEPTH, 100},
                                                         {SQLITE_LIMIT_ATTACHED, 0},
                                                         {SQLITE_LIMIT_TRIGGER_DEPTH, 1},
                                                         {SQLITE_LIMIT_WORKER_THREADS, 0}}};

bool is_one_of_tables(const std::vector<std::string>& names, const char* name) {
  return name != nullptr && std::any_of(names.begin(), names.end(), [&](const std::string& one) {
           return sqlite3_stricmp(one.c_str(), name) == 0;
         });
}

/// Ends the statement when the budget, `context`, is used up.
extern "C" int glidar_count_sqlite_steps(void* context) {
  InputBudget& budget = *static_cast<InputBudget*>(context);
  return budget.try_take(Budget::steps, kStepsBetween) ? 0 : 1;
}

/// Allows selecting columns of the tables in `context`. `inner`: the view or trigger that does it.
extern "C" int glidar_authorize_sqlite(void* context, int action, const char* table,
                                       const char* /*column*/, const char* /*database*/,
                                       const char* inner) {
  if (action == SQLITE_SELECT) return SQLITE_OK;
  const auto& tables = *static_cast<const std::vector<std::string>*>(context);
  const bool is_allowed =
      action == SQLITE_READ && inner == nullptr && is_one_of_tables(tables, table);
  return is_allowed ? SQLITE_OK : SQLITE_DENY;
}

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

/// Name of a layer of SQLite over the file system (sqlite3_vfs) that opens databases only for
/// reading, as BagFile. It creates, locks and deletes no file and finds no log beside the database.
/// It reads ahead where SQLite reads every page by a call of its own.
const char* sqlite_read_only_vfs() {
  static sqlite3_vfs vfs = make_vfs();
  static const int registered = sqlite3_vfs_register(&vfs, 0);
  if (registered != SQLITE_OK) throw Error({"SQLite", "no memory for its layer over files"});
  return vfs.zName;
}

}  // namespace

void limit_sqlite_memory(std::uint64_t bytes) {
  sqlite3_hard_heap_limit64(static_cast<sqlite3_int64>(bytes));
}

void Database::Closer::operator()(sqlite3* database) const {
  sqlite3_close_v2(database);
}

void Statement::Finaliser::operator()(sqlite3_stmt* statement) const {
  sqlite3_finalize(statement);
}

void Database::open(const std::string& name, int flags, const char* vfs) {
  sqlite3* opened = nullptr;
  const int code = sqlite3_open_v2(name.c_str(), &opened, flags, vfs);
  database_.reset(opened);
  if (code != SQLITE_OK) fail();
}

Database::Database(const std::filesystem::path& path) : path_(path.string()) {
  open(path_, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE, nullptr);
  execute("PRAGMA journal_mode=OFF");
  execute("PRAGMA synchronous=OFF");
  execute("PRAGMA locking_mode=EXCLUSIVE");
}

// sqlite.org/security.html, for databases from others
Database::Database(const std::filesystem::path& path, std::uint64_t file_bytes, InputBudget& budget)
    : path_(path.string()), budget_(&budget) {
  open(path_, SQLITE_OPEN_READONLY, sqlite_read_only_vfs());
  sqlite3* database = database_.get();
  sqlite3_db_config(database, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_db_config(database, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
  sqlite3_db_config(database, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
  sqlite3_db_config(database, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  for (const auto& [limit, value] : kLimits) sqlite3_limit(database, limit, value);
  sqlite3_limit(database, SQLITE_LIMIT_LENGTH,
                static_cast<int>(std::clamp(file_bytes, kMinLength, kMaxLength)));
  sqlite3_progress_handler(database, kStepsBetween, glidar_count_sqlite_steps, budget_);
  execute("PRAGMA cell_size_check=ON");
  execute("PRAGMA temp_store=MEMORY");
}

void Database::allow_tables(const std::vector<std::string>& names) {
  Statement schema(*this, "SELECT type,name,rootpage,sql FROM sqlite_schema");
  while (schema.step()) {
    const std::string name(schema.text(1));
    const bool is_wanted = is_one_of_tables(names, name.c_str());
    if (!is_wanted || schema.text(0) == "index") continue;
    // SQLite itself writes the two words so, and 0 for the page of a virtual table
    const bool is_ordinary = schema.text(0) == "table" && schema.number(2) > 0 &&
                             schema.text(3).starts_with("CREATE TABLE ");
    if (!is_ordinary)
      reject_bag(path_, "'" + excerpt(name) + "' is no ordinary table", "the tables of rosbag2");
    require_no_generated_columns(name);
  }
  tables_ = std::make_unique<std::vector<std::string>>(names);
  sqlite3_set_authorizer(database_.get(), glidar_authorize_sqlite, tables_.get());
}

void Database::require_no_generated_columns(const std::string& table) const {
  constexpr int kHidden = 1;
  Statement columns(*this, "SELECT name,hidden FROM pragma_table_xinfo(?)");
  columns.bind(1, std::string_view(table));
  while (columns.step()) {
    if (columns.number(kHidden) == 0) continue;
    reject_bag(path_, "'" + excerpt(table) + "." + excerpt(columns.text(0)) + "' is generated",
               "columns that are stored");
  }
}

void Database::execute(const char* sql) {
  if (sqlite3_exec(database_.get(), sql, nullptr, nullptr, nullptr) != SQLITE_OK) fail();
}

void Database::close() {
  if (sqlite3_close(database_.get()) != SQLITE_OK) fail();
  static_cast<void>(database_.release());
}

void Database::fail() const {
  const char* reason = database_ ? sqlite3_errmsg(database_.get()) : "out of memory";
  if (budget_ != nullptr) {
    const bool is_stopped = database_ && sqlite3_errcode(database_.get()) == SQLITE_INTERRUPT;
    if (is_stopped) budget_->fail(Budget::steps, path_);
    throw Error({path_, std::string("cannot be read by SQLite: ") + reason, "a complete bag",
                 "copy the bag again: it may be damaged"});
  }
  const bool is_limited = database_ && sqlite3_system_errno(database_.get()) == EFBIG;
  throw Error({path_, std::string("cannot be written by SQLite: ") + reason, "",
               is_limited ? "raise the limit on the size of files (ulimit -f)"
                          : "free space on the disk, or write to another folder"});
}

Statement::Statement(const Database& database, std::string_view sql) : database_(&database) {
  sqlite3_stmt* prepared = nullptr;
  check(sqlite3_prepare_v2(database.get(), sql.data(), static_cast<int>(sql.size()), &prepared,
                           nullptr));
  statement_.reset(prepared);
}

void Statement::check(int code) const {
  if (code != SQLITE_OK) database_->fail();
}

void Statement::bind(int parameter, std::int64_t number) {
  check(sqlite3_bind_int64(statement_.get(), parameter, number));
}

void Statement::bind(int parameter, std::string_view text) {
  check(sqlite3_bind_text(statement_.get(), parameter, text.data(), static_cast<int>(text.size()),
                          SQLITE_TRANSIENT));
}

void Statement::bind(int parameter, std::span<const std::byte> bytes) {
  check(
      sqlite3_bind_blob64(statement_.get(), parameter, bytes.data(), bytes.size(), SQLITE_STATIC));
}

bool Statement::step() {
  const int code = sqlite3_step(statement_.get());
  if (code == SQLITE_ROW) return true;
  reset();  // also after an error, which stays that of the database
  if (code != SQLITE_DONE) database_->fail();
  return false;
}

void Statement::reset() {
  sqlite3_reset(statement_.get());
}

std::int64_t Statement::number(int column) const {
  return sqlite3_column_int64(statement_.get(), column);
}

std::string_view Statement::text(int column) const {
  const unsigned char* text = sqlite3_column_text(statement_.get(), column);
  if (text == nullptr) return {};
  return {reinterpret_cast<const char*>(text),
          static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column))};
}

void BlobColumn::Closer::operator()(sqlite3_blob* blob) const {
  sqlite3_blob_close(blob);
}

void BlobColumn::check(int code) const {
  if (code != SQLITE_OK) database_->fail();
}

void BlobColumn::select(std::int64_t row) {
  if (blob_) {
    check(sqlite3_blob_reopen(blob_.get(), row));
    return;
  }
  sqlite3_blob* opened = nullptr;
  const int code = sqlite3_blob_open(database_->get(), "main", table_, column_, row, 0, &opened);
  blob_.reset(opened);
  check(code);
}

std::size_t BlobColumn::size() const {
  return static_cast<std::size_t>(sqlite3_blob_bytes(blob_.get()));
}

void BlobColumn::read(std::size_t offset, std::span<std::byte> to) const {
  check(sqlite3_blob_read(blob_.get(), to.data(), static_cast<int>(to.size()),
                          static_cast<int>(offset)));
}

}  // namespace glidar::bags
