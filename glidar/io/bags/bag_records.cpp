// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/bags/bag_records.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/bags/bag_storage.hpp>

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

namespace glidar::bags {
namespace {

/// The payload of a topic: whether it is of ROS, and of ROS 1, then its name and its type.
Bytes topic_payload(const StoredTopic& topic) {
  Bytes payload;
  append(payload, static_cast<std::uint8_t>(topic.is_ros));
  append(payload, static_cast<std::uint8_t>(topic.wire == ros::Wire::ros1));
  append_sized(payload, topic.name.bytes());
  append_sized(payload, topic.type.bytes());
  return payload;
}

/// Which topics are wanted. Not all bytes may arrive at once.
std::vector<std::size_t> receive_selection(std::size_t topics, int control) {
  Bytes wanted(topics);
  for (std::size_t filled = 0; filled < wanted.size();) {
    const ssize_t got = ::read(control, wanted.data() + filled, wanted.size() - filled);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) throw Error({"bag", "no topics are requested"});
    filled += static_cast<std::size_t>(got);
  }
  std::vector<std::size_t> selected;
  for (std::size_t i = 0; i < topics; ++i) {
    if (wanted[i] != std::byte{0}) selected.push_back(i);
  }
  return selected;
}

class ReceivedBag : public BagReader {
 public:
  explicit ReceivedBag(DecoderRun run) : run_(std::move(run)), budget_(run_.input_bytes) {
    RecordReader& records = run_.records;
    for (Record record = records.next(); record.kind != RecordKind::ready;
         record = records.next()) {
      if (record.kind != RecordKind::topic) records.reject("no topics first");
      add_topic(record);
    }
    wanted_.assign(topics_.size(), std::byte{1});
  }

  [[nodiscard]] std::span<const StoredTopic> topics() const override { return topics_; }

  void select(std::span<const std::size_t> topics) override {
    wanted_.assign(topics_.size(), std::byte{0});
    for (const std::size_t topic : topics) wanted_.at(topic) = std::byte{1};
  }

  bool next(BagMessage& message) override {
    if (!is_requested_) run_.request(wanted_);
    is_requested_ = true;
    if (has_ended_) return false;
    const Record record = run_.records.next();
    has_ended_ = record.kind == RecordKind::end;
    if (has_ended_) return false;
    if (record.kind != RecordKind::item || record.index >= topics_.size() ||
        wanted_[record.index] == std::byte{0})
      run_.records.reject(fmt::format("a message of topic {}", record.index));
    budget_.take(Budget::messages, 1, run_.records.place());
    budget_.take(Budget::decompressed_bytes, record.payload.size(), run_.records.place());
    message = {record.index, record.stamp_ns, record.payload};
    return true;
  }

 private:
  void add_topic(const Record& record) {
    const std::string& place = run_.records.place();
    budget_.take(Budget::topics, 1, place);
    ByteReader payload(record.payload, place);
    StoredTopic topic;
    topic.is_ros = payload.number<std::uint8_t>() != 0;
    topic.wire = payload.number<std::uint8_t>() != 0 ? ros::Wire::ros1 : ros::Wire::cdr;
    topic.name = payload.name(budget_);
    topic.type = payload.name(budget_);
    topics_.push_back(std::move(topic));
  }

  DecoderRun run_;
  InputBudget budget_;
  std::vector<StoredTopic> topics_;
  Bytes wanted_;  ///< a byte for each topic
  bool is_requested_ = false;
  bool has_ended_ = false;
};

}  // namespace

void send_bag(BagReader& bag, RecordWriter& to, int control) {
  for (const StoredTopic& topic : bag.topics())
    to.write({RecordKind::topic, 0, 0, topic_payload(topic)});
  to.write({RecordKind::ready, 0, 0, {}});
  to.flush();
  bag.select(receive_selection(bag.topics().size(), control));
  bag.leave_in_file();
  for (BagMessage message; bag.next(message);) {
    const Record record{RecordKind::item, static_cast<std::uint32_t>(message.topic),
                        message.time_ns, message.data};
    if (message.in_file == nullptr) {
      to.write(record);
      continue;
    }
    const auto copy = [&](std::size_t offset, std::span<std::byte> bytes) {
      message.in_file->copy(offset, bytes);
    };
    to.write(record, message.in_file->size(), CopyPayload(copy));
  }
  to.write({RecordKind::end, 0, 0, {}});
  to.flush();
}

std::unique_ptr<BagReader> receive_bag(DecoderRun run) {
  return std::make_unique<ReceivedBag>(std::move(run));
}

}  // namespace glidar::bags
