// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/bags/sqlite_bag_reader.hpp>

#include <glidar/io/bags/bag_file.hpp>
#include <glidar/io/bags/byte_reader.hpp>
#include <glidar/io/bags/sqlite.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>

namespace glidar::bags {
namespace {

/// Opens the file by our own rules first: SQLite's messages do not name what is wrong.
const std::filesystem::path& checked(const std::filesystem::path& path) {
  constexpr std::string_view kMagic = "SQLite format 3";
  BagFile file(path);
  const auto bytes = file.peek(0, std::min<std::uint64_t>(kMagic.size(), file.size()));
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (text != kMagic) reject_bag(path.string(), "no SQLite database", "a file of rosbag2");
  return path;
}

class SqliteBagReader : public BagReader {
 public:
  explicit SqliteBagReader(const std::filesystem::path& path)
      : path_(path.string()), database_(checked(path), Database::Mode::read) {
    Statement topics(database_, "SELECT id,name,type,serialization_format FROM topics ORDER BY id");
    while (topics.step()) {
      numbers_.emplace(topics.number(0), topics_.size());
      topics_.push_back({topics.text(1), topics.text(2), ros::Wire::cdr, topics.text(3) == "cdr"});
    }
    // Only the index is sorted; messages are read one by one.
    order_.emplace(database_, "SELECT id FROM messages ORDER BY timestamp,id");
    message_.emplace(database_, "SELECT topic_id,timestamp,data FROM messages WHERE id=?");
    selected_.assign(topics_.size(), true);
  }

  [[nodiscard]] std::span<const StoredTopic> topics() const override { return topics_; }

  void select(std::span<const std::size_t> topics) override {
    selected_.assign(topics_.size(), false);
    for (const std::size_t topic : topics) selected_.at(topic) = true;
  }

  bool next(BagMessage& message) override {
    while (!ended_) {
      message_->reset();
      if (!order_->step()) {
        ended_ = true;
        break;
      }
      message_->bind(1, order_->number(0));
      if (!message_->step()) reject_bag(path_, "a message that the index has but not the table");
      const auto topic = numbers_.find(message_->number(0));
      if (topic == numbers_.end())
        reject_bag(path_, fmt::format("a message of the unknown topic {}", message_->number(0)));
      if (!selected_[topic->second]) continue;
      message = {topic->second, message_->number(1), message_->bytes(2)};
      return true;
    }
    return false;
  }

 private:
  std::string path_;
  Database database_;
  std::vector<StoredTopic> topics_;
  std::map<std::int64_t, std::size_t> numbers_;  ///< from topics.id to the index
  std::vector<bool> selected_;
  std::optional<Statement> order_;
  std::optional<Statement> message_;
  bool ended_ = false;
};

}  // namespace

std::unique_ptr<BagReader> open_sqlite_bag(const std::filesystem::path& path) {
  return std::make_unique<SqliteBagReader>(path);
}

}  // namespace glidar::bags
