// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io/bags: a thin layer over SQLite that throws Error.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

struct sqlite3;
struct sqlite3_stmt;

namespace glidar::bags {

class Database {
 public:
  enum class Mode : std::uint8_t { create, read };
  /// Without journal and syncs when it is created: a file that is renamed when it is complete.
  /// Reading refuses views, triggers and damaged cells.
  Database(const std::filesystem::path& path, Mode mode);

  void execute(const char* sql);
  /// Closes the database. Throws Error when that fails.
  void close();
  [[nodiscard]] sqlite3* get() const { return database_.get(); }
  [[noreturn]] void fail() const;

 private:
  struct Closer {
    void operator()(sqlite3* database) const;
  };
  std::string path_;
  Mode mode_;
  std::unique_ptr<sqlite3, Closer> database_;
};

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
  [[nodiscard]] std::string text(int column) const;
  /// Valid until the next step() or reset().
  [[nodiscard]] std::span<const std::byte> bytes(int column) const;

 private:
  void check(int code) const;
  struct Finaliser {
    void operator()(sqlite3_stmt* statement) const;
  };
  const Database* database_;
  std::unique_ptr<sqlite3_stmt, Finaliser> statement_;
};

}  // namespace glidar::bags
