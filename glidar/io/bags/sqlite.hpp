// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io/bags: a thin layer over SQLite that throws Error.

#include <glidar/io/files/input_file.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

struct sqlite3;
struct sqlite3_blob;
struct sqlite3_stmt;

namespace glidar::bags {

class Database {
 public:
  /// A new one, without journal and syncs: a file that is renamed when it is complete.
  explicit Database(const std::filesystem::path& path);
  /// One of others, for reading. No file is written or locked, and a log beside it is not read. No
  /// value is longer than the file. The steps of statements count in the budget, which must
  /// outlive the database: they end also where pages contain each other.
  Database(const std::filesystem::path& path, std::uint64_t file_bytes, InputBudget& budget);

  /// From now on statements can only read these tables, and call no functions. Throws Error unless
  /// they are ordinary: no virtual tables, views or generated columns.
  void allow_tables(const std::vector<std::string>& names);

  void execute(const char* sql);
  /// Closes the database. Throws Error when that fails.
  void close();
  [[nodiscard]] sqlite3* get() const { return database_.get(); }
  [[noreturn]] void fail() const;

 private:
  struct Closer {
    void operator()(sqlite3* database) const;
  };
  void open(const std::string& name, int flags, const char* vfs);
  void require_no_generated_columns(const std::string& table) const;

  std::string path_;
  InputBudget* budget_ = nullptr;                     ///< of a database that is read
  std::unique_ptr<std::vector<std::string>> tables_;  ///< allowed ones; SQLite has its address
  std::unique_ptr<sqlite3, Closer> database_;
};

/// Limits the memory of SQLite in this process.
void limit_sqlite_memory(std::uint64_t bytes);

/// A prepared statement. Parameters count from 1, columns from 0.
class Statement {
 public:
  Statement(const Database& database, std::string_view sql);

  void bind(int parameter, std::int64_t number);
  void bind(int parameter, std::string_view text);
  /// Without a copy: the bytes must stay until the next step() has returned.
  void bind(int parameter, std::span<const std::byte> bytes);
  /// True: there is a row; false: the end, after which it can run again.
  bool step();
  void reset();

  [[nodiscard]] std::int64_t number(int column) const;
  /// Valid until the next step() or reset().
  [[nodiscard]] std::string_view text(int column) const;

 private:
  void check(int code) const;
  struct Finaliser {
    void operator()(sqlite3_stmt* statement) const;
  };
  const Database* database_;
  std::unique_ptr<sqlite3_stmt, Finaliser> statement_;
};

/// The values of one column that are blobs or texts, row by row. They are read from the file's
/// pages to where they are needed, without a copy in between.
class BlobColumn {
 public:
  /// Both names must outlive it.
  BlobColumn(const Database& database, const char* table, const char* column)
      : database_(&database), table_(table), column_(column) {}

  /// Selects a row by its rowid. Throws Error when it has no such value.
  void select(std::int64_t row);
  [[nodiscard]] std::size_t size() const;
  /// Bytes of the selected value, which must have them.
  void read(std::size_t offset, std::span<std::byte> to) const;

 private:
  void check(int code) const;
  struct Closer {
    void operator()(sqlite3_blob* blob) const;
  };
  const Database* database_;
  const char* table_;
  const char* column_;
  std::unique_ptr<sqlite3_blob, Closer> blob_;
};

}  // namespace glidar::bags
