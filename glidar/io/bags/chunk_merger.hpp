// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io/bags.

#include <glidar/io/bags/bag.hpp>
#include <glidar/io/bags/byte_writer.hpp>
#include <glidar/io/files/input_file.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace glidar::bags {

/// The budget of a bag, which all of its files share.
using SharedBudget = std::shared_ptr<InputBudget>;

/// A part of a bag with messages of any order. Times are in [first_ns, last_ns].
struct ChunkRange {
  std::int64_t first_ns = 0;
  std::int64_t last_ns = 0;
};

/// A message in a chunk.
struct ChunkEntry {
  std::int64_t time_ns = 0;
  std::size_t topic = 0;
  std::size_t offset = 0;  ///< in LoadedChunk::bytes
  std::size_t size = 0;
};

struct LoadedChunk {
  Bytes bytes;
  std::vector<ChunkEntry> entries;
};

/// Merges the messages of chunks by time. A chunk is in memory only while its messages are due.
class ChunkMerger {
 public:
  /// Reads the chunk of a number, if possible in memory that an earlier chunk had.
  using Load = std::function<LoadedChunk(std::size_t number, Bytes reused)>;

  /// `place` is the path of the bag, for errors. Messages, and chunks while they are in memory,
  /// count in the budget.
  ChunkMerger(std::string place, std::vector<ChunkRange> chunks, SharedBudget budget, Load load);

  /// Keeps only messages of topics whose entry is true; before the first next().
  void select(std::vector<bool> topics) { selected_ = std::move(topics); }

  /// Throws Error when a message is outside its chunk's times, or the budget is exceeded, because
  /// too many chunks overlap.
  bool next(BagMessage& message);

 private:
  struct Open {
    std::size_t number = 0;
    LoadedChunk chunk;
    std::size_t entry = 0;  ///< the next one
  };

  void load_due();
  void open(std::size_t number);
  /// Of equal times, the first chunk in the file is the first.
  static bool is_later(const std::unique_ptr<Open>& a, const std::unique_ptr<Open>& b);

  std::string place_;
  std::vector<ChunkRange> chunks_;
  SharedBudget budget_;
  Load load_;
  std::vector<bool> selected_;               ///< empty: all
  std::vector<std::size_t> order_;           ///< chunks by first time
  std::size_t next_ = 0;                     ///< in order_
  std::vector<std::unique_ptr<Open>> open_;  ///< a heap; the earliest message is in front
  Bytes current_;  ///< of a chunk whose last message was returned; reused for the next chunk
};

}  // namespace glidar::bags
