// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Bags that would need much more memory or time than their size.
#include <glidar/io/bags/bag_records.hpp>

#include <glidar/io/bags/bag_formats.hpp>
#include <glidar/io/bags/bag_storage.hpp>
#include <glidar/io/bags/sqlite.hpp>

#include <support/error_text.hpp>
#include <support/test_folder.hpp>

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <iterator>

namespace glidar::bags {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::TestFolder;

/// The error of reading all messages, in the sandboxed process.
std::string read_error(const std::filesystem::path& path) {
  return error_text([&] {
    const auto bag = open_bag(path);
    for (BagMessage message; bag->next(message);) {
    }
  });
}

void append_record(Bytes& to, mcap::Op op, std::span<const std::byte> content) {
  append(to, static_cast<std::uint8_t>(op));
  append(to, std::uint64_t{content.size()});
  append(to, content);
}

/// A chunk of these records.
void append_chunk(Bytes& to, const Bytes& records, std::int64_t last_ns = 0) {
  Bytes packed;
  compress(records, Compression::zstd, packed);
  Bytes content;
  append(content, std::int64_t{0});
  append(content, last_ns);
  append(content, std::uint64_t{records.size()});
  append(content, std::uint32_t{0});
  append_sized(content, std::string_view("zstd"));
  append(content, std::uint64_t{packed.size()});
  append(content, packed);
  append_record(to, mcap::Op::chunk, content);
}

/// An MCAP file of these records.
std::filesystem::path write_mcap(const TestFolder& folder, const Bytes& records) {
  Bytes file;
  append(file, mcap::kMagic);
  append(file, records);
  append_record(file, mcap::Op::footer, Bytes(mcap::kFooterBytes));
  append(file, mcap::kMagic);
  return folder.write("run.mcap", {reinterpret_cast<const char*>(file.data()), file.size()});
}

void append_channel(Bytes& to, std::uint16_t number, const std::string& name) {
  Bytes content;
  append(content, number);
  append(content, std::uint16_t{0});
  append_sized(content, name);
  append_sized(content, std::string_view("cdr"));
  append_record(to, mcap::Op::channel, content);
}

TEST(HostileMcap, LongNamesAreRefused) {
  const TestFolder folder;
  Bytes plain;
  append_channel(plain, 1, std::string(5000, 'n'));
  EXPECT_THAT(read_error(write_mcap(folder, plain)),
              AllOf(HasSubstr("run.mcap, byte "), HasSubstr("a name of 5000 bytes")));
  Bytes chunk;
  append_chunk(chunk, plain);
  EXPECT_THAT(read_error(write_mcap(folder, chunk)), HasSubstr("a name of 5000 bytes"));
}

TEST(HostileMcap, ManyNamesInASmallFileAreRefused) {
  const TestFolder folder;
  Bytes channels;
  for (std::uint16_t i = 0; i < 1000; ++i) append_channel(channels, i, std::string(4000, 'n'));
  Bytes chunk;
  append_chunk(chunk, channels);
  EXPECT_THAT(read_error(write_mcap(folder, chunk)), HasSubstr("bytes of names"));
}

TEST(HostileMcap, PaddingThatExpandsIsRefused) {
  const TestFolder folder;
  Bytes large;
  append_record(large, mcap::Op::header, Bytes(80U << 20U));
  Bytes one;
  append_chunk(one, large);
  EXPECT_THAT(read_error(write_mcap(folder, one)), HasSubstr("a chunk of 83886089 bytes"));
  Bytes small;
  append_record(small, mcap::Op::header, Bytes(30U << 20U));
  Bytes many;
  for (int i = 0; i < 10; ++i) append_chunk(many, small);
  EXPECT_THAT(read_error(write_mcap(folder, many)), HasSubstr("decompressed bytes"));
}

TEST(HostileMcap, ChunksOfTheSameTimesAreLimitedTogether) {
  const TestFolder folder;
  Bytes content;
  append(content, std::uint16_t{1});
  append(content, std::uint32_t{0});
  append(content, std::int64_t{1});
  append(content, std::int64_t{1});
  append(content, Bytes(30U << 20U));
  Bytes message;
  append_record(message, mcap::Op::message, content);
  Bytes records;
  append_channel(records, 1, "/points");
  for (int i = 0; i < 4; ++i) append_chunk(records, message, 1);
  EXPECT_THAT(read_error(write_mcap(folder, records)), HasSubstr("whose times overlap"));
}

/// A folder of rosbag2 with one database.
class HostileDatabase : public ::testing::Test {
 protected:
  HostileDatabase() {
    folder_.write("run.rosbag2/metadata.yaml",
                  "rosbag2_bagfile_information: {storage_identifier: sqlite3, "
                  "relative_file_paths: [run.db3]}\n");
  }

  std::string error_of(const std::vector<const char*>& statements) {
    std::filesystem::remove(file());
    {
      Database database(file());
      for (const char* statement : statements) database.execute(statement);
      database.close();
    }
    return read_error(bag());
  }

  [[nodiscard]] std::filesystem::path bag() const { return folder_ / "run.rosbag2"; }
  [[nodiscard]] std::filesystem::path file() const { return bag() / "run.db3"; }

  static constexpr const char* kTopics =
      "CREATE TABLE topics(id INTEGER PRIMARY KEY,name TEXT,type TEXT,serialization_format TEXT)";
  static constexpr const char* kMessages =
      "CREATE TABLE messages(id INTEGER PRIMARY KEY,topic_id INTEGER,timestamp INTEGER,data BLOB)";
  TestFolder folder_;
};

TEST_F(HostileDatabase, TablesOfRosbag2AreRead) {
  EXPECT_EQ(error_of({kTopics, kMessages, "CREATE INDEX timestamp_idx ON messages(timestamp)",
                      "INSERT INTO topics VALUES(1,'/a','std_msgs/msg/String','cdr')",
                      "INSERT INTO messages VALUES(1,1,5,x'00')"}),
            "no error");
}

TEST_F(HostileDatabase, GeneratedColumnsAreRefused) {
  EXPECT_THAT(
      error_of({"CREATE TABLE topics(id INTEGER PRIMARY KEY,type TEXT,serialization_format TEXT,"
                "name TEXT AS (printf('%.*c',1000000,'x')))",
                kMessages, "INSERT INTO topics(type) VALUES('t')"}),
      HasSubstr("'topics.name' is generated"));
  EXPECT_THAT(error_of({kTopics,
                        "CREATE TABLE messages(id INTEGER PRIMARY KEY,topic_id INTEGER,"
                        "timestamp INTEGER,data BLOB AS (zeroblob(1000)) STORED)"}),
              HasSubstr("'messages.data' is generated"));
}

TEST_F(HostileDatabase, VirtualTablesAndViewsAreRefused) {
  for (const char* statement :
       {"CREATE VIRTUAL TABLE topics USING fts5(id,name,type,serialization_format)",
        "CREATE VIRTUAL TABLE topics USING rtree(id,name,type,serialization_format,a)",
        "CREATE VIEW topics AS SELECT 1 AS id,'a' AS name,'t' AS type,'cdr' AS "
        "serialization_format"}) {
    EXPECT_THAT(error_of({statement, kMessages}), HasSubstr("'topics' is no ordinary table"));
  }
  EXPECT_THAT(error_of({kTopics,
                        "CREATE VIEW Messages AS SELECT id,1 AS topic_id,5 AS timestamp,"
                        "zeroblob(1000000) AS data FROM topics"}),
              HasSubstr("'Messages' is no ordinary table"));
}

TEST_F(HostileDatabase, LongNamesAreRefused) {
  EXPECT_THAT(error_of({kTopics, kMessages,
                        "INSERT INTO topics VALUES(1,printf('%.*c',5000,'n'),'t','cdr')"}),
              HasSubstr("a name of 5000 bytes"));
}

TEST_F(HostileDatabase, DefaultsOfMissingColumnsAreRefused) {
  const std::vector<const char*> statements = {
      kTopics, "CREATE TABLE messages(id INTEGER PRIMARY KEY,topic_id INTEGER,timestamp INTEGER)",
      "INSERT INTO topics VALUES(1,'/a','t','cdr')", "INSERT INTO messages VALUES(1,1,5)",
      "ALTER TABLE messages ADD COLUMN data BLOB DEFAULT 'x'"};
  EXPECT_THAT(error_of(statements), HasSubstr("type null"));
}

/// Makes all children of interior pages of tables the same one.
void tangle_pages(const std::filesystem::path& file) {
  std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(stream)), {});
  constexpr std::size_t kPage = 4096;
  constexpr std::size_t kHead = 12;
  const auto two = [&](std::size_t at) {
    return std::size_t{static_cast<unsigned char>(bytes[at])} << 8U |
           static_cast<unsigned char>(bytes[at + 1]);
  };
  for (std::size_t page = kPage; page < bytes.size(); page += kPage) {
    if (bytes[page] != 5) continue;
    const std::string child = bytes.substr(page + two(page + kHead), 4);
    for (std::size_t cell = 0; cell < two(page + 3); ++cell)
      bytes.replace(page + two(page + kHead + 2 * cell), 4, child);
  }
  stream.clear();
  stream.seekp(0);
  stream << bytes;
}

TEST_F(HostileDatabase, PagesThatContainEachOtherEnd) {
  const char* numbers =
      "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i+1 FROM n WHERE i<2000)";
  const std::string topics =
      std::string(numbers) + " INSERT INTO topics SELECT i,'/a','std_msgs/msg/String','cdr' FROM n";
  ASSERT_EQ(error_of({kTopics, kMessages, topics.c_str()}), "no error");
  tangle_pages(file());
  EXPECT_THAT(read_error(bag()), HasSubstr("topics whose numbers do not rise"));
  const std::string messages =
      std::string(numbers) + " INSERT INTO messages SELECT i,1,i,x'00' FROM n";
  ASSERT_EQ(error_of({kTopics, "INSERT INTO topics VALUES(1,'/a','t','cdr')", kMessages,
                      messages.c_str()}),
            "no error");
  tangle_pages(file());
  EXPECT_THAT(read_error(bag()), HasSubstr("messages whose times and numbers do not rise"));
}

TEST_F(HostileDatabase, NoFileIsWrittenBesideTheBag) {
  const std::vector<const char*> statements = {
      "PRAGMA locking_mode=NORMAL",
      "PRAGMA journal_mode=WAL",
      kTopics,
      kMessages,
      "INSERT INTO topics VALUES(1,'/a','std_msgs/msg/String','cdr')",
      "INSERT INTO messages VALUES(1,1,5,x'00')"};
  EXPECT_EQ(error_of(statements), "no error");
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(bag()))
    names.push_back(entry.path().filename().string());
  EXPECT_THAT(names, ::testing::UnorderedElementsAre("metadata.yaml", "run.db3"));
}

TEST_F(HostileDatabase, ALogBesideTheBagIsRefused) {
  ASSERT_EQ(error_of({kTopics, kMessages}), "no error");
  for (const char* suffix : {"-wal", "-journal"}) {
    const auto log = folder_.write("run.rosbag2/run.db3" + std::string(suffix), "pages");
    EXPECT_THAT(read_error(bag()),
                AllOf(HasSubstr(log.string()), HasSubstr("5 bytes that are not")));
    std::filesystem::remove(log);
  }
}

TEST_F(HostileDatabase, AFileThatIsNamedTwiceIsRefused) {
  ASSERT_EQ(error_of({kTopics, kMessages}), "no error");
  const auto with = [&](const std::string& files) {
    folder_.write("run.rosbag2/metadata.yaml",
                  "rosbag2_bagfile_information: {storage_identifier: sqlite3, "
                  "relative_file_paths: [" +
                      files + "]}\n");
    return read_error(bag());
  };
  EXPECT_THAT(with("run.db3, run.db3"), HasSubstr("the file run.db3 twice"));
  EXPECT_THAT(with("run.db3, ./run.db3"), HasSubstr("the file run.db3 twice"));
  std::filesystem::create_hard_link(file(), bag() / "other.db3");
  EXPECT_THAT(with("run.db3, other.db3"), HasSubstr("a link to another file of the bag"));
  std::filesystem::remove(bag() / "other.db3");
  std::filesystem::create_symlink("run.db3", bag() / "other.db3");
  EXPECT_THAT(with("run.db3, other.db3"), HasSubstr("a link to another file of the bag"));
}

TEST_F(HostileDatabase, AFileOutsideTheFolderIsNotRead) {
  ASSERT_EQ(error_of({kTopics, kMessages}), "no error");
  std::filesystem::rename(file(), folder_ / "outside.db3");
  std::filesystem::create_symlink("../outside.db3", file());
  EXPECT_THAT(read_error(bag()), HasSubstr("run.db3: cannot be opened: "));
}

}  // namespace
}  // namespace glidar::bags
