// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io/bags.

#include <glidar/io/bags/bag.hpp>
#include <glidar/io/bags/byte_reader.hpp>
#include <glidar/io/bags/mcap_records.hpp>

#include <map>
#include <string>
#include <vector>

namespace glidar::bags {

/// The head of a record.
struct McapRecord {
  mcap::Op op{};
  std::uint64_t size = 0;  ///< of its content
};

McapRecord read_mcap_head(ByteReader& reader);

/// The schemas and channels of a file, each known after its record.
class McapChannels {
 public:
  /// Takes the content of a schema or channel record; ignores others and repetitions. Names and
  /// topics count in the budget.
  void add(mcap::Op op, ByteReader& content, InputBudget& budget);

  [[nodiscard]] const std::vector<StoredTopic>& topics() const { return topics_; }
  /// Index in topics(). Throws Error, at the reader's place, for an unknown channel.
  [[nodiscard]] std::size_t topic_of(std::uint16_t channel, const ByteReader& reader) const;

 private:
  void add_channel(ByteReader& content, InputBudget& budget);

  std::map<std::uint16_t, std::string> schemas_;
  std::map<std::uint16_t, std::size_t> channels_;
  std::vector<StoredTopic> topics_;
};

}  // namespace glidar::bags
