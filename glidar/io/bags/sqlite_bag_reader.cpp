// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/bags/sqlite_bag_reader.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/bags/bag_storage.hpp>
#include <glidar/io/bags/sqlite.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

namespace glidar::bags {
namespace {

/// Throws Error when a file beside the database has content: messages that a program did not yet
/// move into it, or must take back. Reading them would write files beside the bag.
void require_no_log(const std::filesystem::path& path) {
  for (const char* suffix : {"-wal", "-journal"}) {
    const std::filesystem::path log = path.string() + suffix;
    std::error_code error;
    const std::uintmax_t size = std::filesystem::file_size(log, error);
    if (error || size == 0) continue;
    throw Error({log.string(), fmt::format("{} bytes that are not yet in the bag", size),
                 "a bag that was completed",
                 "move a copy into the bag by: sqlite3 " + path.filename().string() +
                     " 'PRAGMA journal_mode=DELETE'"});
  }
}

/// Opens the file by our own rules first: SQLite's messages do not name what is wrong. Returns its
/// size.
std::uint64_t checked_size(const std::filesystem::path& path) {
  constexpr std::string_view kMagic = "SQLite format 3";
  BagFile file(path);
  const auto bytes = file.peek(0, std::min<std::uint64_t>(kMagic.size(), file.size()));
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (text != kMagic) reject_bag(path.string(), "no SQLite database", "a file of rosbag2");
  require_no_log(path);
  return file.size();
}

class SqliteBagReader : public BagReader, private BagData {
 public:
  SqliteBagReader(const std::filesystem::path& path, SharedBudget budget)
      : path_(path.string()),
        budget_(std::move(budget)),
        database_(path, checked_size(path), *budget_) {
    database_.allow_tables({"topics", "messages"});
    read_topics();
    // Only the index is sorted; messages are read one by one.
    order_.emplace(database_, "SELECT timestamp,id FROM messages ORDER BY timestamp,id");
    message_.emplace(database_, "SELECT topic_id,timestamp,rowid FROM messages WHERE id=?");
    selected_.assign(topics_.size(), true);
  }

  [[nodiscard]] std::span<const StoredTopic> topics() const override { return topics_; }

  void select(std::span<const std::size_t> topics) override {
    selected_.assign(topics_.size(), false);
    for (const std::size_t topic : topics) selected_.at(topic) = true;
  }

  void leave_in_file() override { leaves_in_file_ = true; }

  bool next(BagMessage& message) override {
    while (!ended_) {
      message_->reset();
      if (!order_->step()) {
        ended_ = true;
        break;
      }
      budget_->take(Budget::messages, 1, path_);
      require_rise();
      message_->bind(1, order_->number(1));
      if (!message_->step()) reject_bag(path_, "a message that the index has but not the table");
      const auto topic = numbers_.find(message_->number(0));
      if (topic == numbers_.end())
        reject_bag(path_, fmt::format("a message of the unknown topic {}", message_->number(0)));
      if (!selected_[topic->second]) continue;
      data_.select(message_->number(2));
      budget_->take(Budget::decompressed_bytes, size(), path_);
      message = {topic->second, message_->number(1), {}};
      if (leaves_in_file_) {
        message.in_file = this;
      } else {
        message.data = whole_data();
      }
      return true;
    }
    return false;
  }

 private:
  [[nodiscard]] std::size_t size() const override { return data_.size(); }

  void copy(std::size_t offset, std::span<std::byte> to) override { data_.read(offset, to); }

  std::span<const std::byte> whole_data() {
    if (buffer_.size() < size()) buffer_.resize(size());
    const std::span<std::byte> whole = std::span(buffer_).first(size());
    copy(0, whole);
    return whole;
  }

  /// A damaged table can have pages that contain each other, and rows without end.
  void read_topics() {
    Statement rows(database_, "SELECT id,name,type,serialization_format FROM topics ORDER BY id");
    std::optional<std::int64_t> last;
    while (rows.step()) {
      const std::int64_t number = rows.number(0);
      if (last && number <= *last) reject_bag(path_, "topics whose numbers do not rise");
      last = number;
      budget_->take(Budget::topics, 1, path_);
      numbers_.emplace(number, topics_.size());
      StoredTopic topic{name(rows, 1), name(rows, 2), ros::Wire::cdr, name(rows, 3) == "cdr"};
      topics_.push_back(std::move(topic));
    }
  }

  std::string name(const Statement& row, int column) {
    const std::string_view text = row.text(column);
    budget_->take_name(text.size(), path_ + ", table topics");
    return std::string(text);
  }

  void require_rise() {
    const std::pair now(order_->number(0), order_->number(1));
    if (last_ && now <= *last_) reject_bag(path_, "messages whose times and numbers do not rise");
    last_ = now;
  }

  std::string path_;
  SharedBudget budget_;
  Database database_;
  std::vector<StoredTopic> topics_;
  std::map<std::int64_t, std::size_t> numbers_;  ///< from topics.id to the index
  std::vector<bool> selected_;
  std::optional<Statement> order_;
  std::optional<Statement> message_;
  BlobColumn data_{database_, "messages", "data"};
  Bytes buffer_;  ///< of the message that was read last
  bool leaves_in_file_ = false;
  std::optional<std::pair<std::int64_t, std::int64_t>> last_;  ///< time and id
  bool ended_ = false;
};

}  // namespace

std::unique_ptr<BagReader> open_sqlite_bag(const std::filesystem::path& path, SharedBudget budget) {
  return std::make_unique<SqliteBagReader>(path, std::move(budget));
}

}  // namespace glidar::bags
