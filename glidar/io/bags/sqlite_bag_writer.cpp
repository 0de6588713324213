// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/bags/sqlite_bag_writer.hpp>

#include <glidar/core/error.hpp>

#include <string>

namespace glidar::bags {
namespace {

/// ros2/rosbag2, rosbag2_storage_sqlite3/src/rosbag2_storage_sqlite3/sqlite_storage.cpp.
constexpr const char* kTables =
    "CREATE TABLE schema(schema_version INTEGER PRIMARY KEY,ros_distro TEXT NOT NULL);"
    "CREATE TABLE metadata(id INTEGER PRIMARY KEY,metadata_version INTEGER NOT NULL,"
    "metadata TEXT NOT NULL);"
    "CREATE TABLE topics(id INTEGER PRIMARY KEY,name TEXT NOT NULL,type TEXT NOT NULL,"
    "serialization_format TEXT NOT NULL,offered_qos_profiles TEXT NOT NULL,"
    "type_description_hash TEXT NOT NULL);"
    "CREATE TABLE message_definitions(id INTEGER PRIMARY KEY,topic_type TEXT NOT NULL,"
    "encoding TEXT NOT NULL,encoded_message_definition TEXT NOT NULL,"
    "type_description_hash TEXT NOT NULL);"
    "CREATE TABLE messages(id INTEGER PRIMARY KEY,topic_id INTEGER NOT NULL,"
    "timestamp INTEGER NOT NULL,data BLOB NOT NULL);"
    "CREATE INDEX timestamp_idx ON messages (timestamp ASC);";
constexpr int kSchemaVersion = 4;

}  // namespace

SqliteBagWriter::SqliteBagWriter(const std::filesystem::path& path) : database_(path) {
  database_.execute("BEGIN");
  database_.execute(kTables);
  Statement version(database_, "INSERT INTO schema VALUES(?,?)");
  version.bind(1, kSchemaVersion);
  version.bind(2, std::string_view(kRosDistro));
  version.step();
  insert_message_.emplace(database_, "INSERT INTO messages(topic_id,timestamp,data) VALUES(?,?,?)");
}

std::size_t SqliteBagWriter::add_topic(const ros::Topic& topic) {
  Statement insert(database_, "INSERT INTO topics VALUES(?,?,?,'cdr',?,?)");
  insert.bind(1, static_cast<std::int64_t>(topics_ + 1));
  insert.bind(2, topic.name);
  insert.bind(3, topic.type->name);
  insert.bind(4, ros::qos_yaml(topic.qos));
  insert.bind(5, topic.type->type_hash);
  insert.step();
  if (defined_.insert(topic.type).second) {
    Statement define(database_,
                     "INSERT INTO message_definitions(topic_type,encoding,"
                     "encoded_message_definition,type_description_hash) "
                     "VALUES(?,'ros2msg',?,?)");
    define.bind(1, topic.type->name);
    define.bind(2, ros::definition_text(*topic.type, ros::Wire::cdr));
    define.bind(3, topic.type->type_hash);
    define.step();
  }
  return topics_++;
}

void SqliteBagWriter::write(std::size_t topic, std::int64_t time_ns,
                            std::span<const std::byte> message) {
  insert_message_->bind(1, static_cast<std::int64_t>(topic + 1));
  insert_message_->bind(2, time_ns);
  insert_message_->bind(3, message);
  insert_message_->step();
}

void SqliteBagWriter::put_metadata(const std::string& yaml) {
  Statement insert(database_, "INSERT INTO metadata(metadata_version,metadata) VALUES(?,?)");
  insert.bind(1, kMetadataVersion);
  insert.bind(2, yaml);
  insert.step();
}

void SqliteBagWriter::finish() {
  database_.execute("COMMIT");
  insert_message_.reset();
  database_.close();
}

}  // namespace glidar::bags
