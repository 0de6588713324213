// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/bags/chunk_merger.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/bags/byte_reader.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace glidar::bags {

ChunkMerger::ChunkMerger(std::string place, std::vector<ChunkRange> chunks, SharedBudget budget,
                         Load load)
    : place_(std::move(place)),
      chunks_(std::move(chunks)),
      budget_(std::move(budget)),
      load_(std::move(load)) {
  order_.resize(chunks_.size());
  std::iota(order_.begin(), order_.end(), std::size_t{0});
  std::stable_sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) {
    return chunks_[a].first_ns < chunks_[b].first_ns;
  });
}

bool ChunkMerger::next(BagMessage& message) {
  load_due();
  if (open_.empty()) return false;
  std::pop_heap(open_.begin(), open_.end(), is_later);
  Open& from = *open_.back();
  const ChunkEntry& entry = from.chunk.entries[from.entry];
  message.topic = entry.topic;
  message.time_ns = entry.time_ns;
  message.data = std::span(from.chunk.bytes).subspan(entry.offset, entry.size);
  if (++from.entry == from.chunk.entries.size()) {
    budget_->give_back(Budget::held_bytes, from.chunk.bytes.size());
    current_ = std::move(from.chunk.bytes);  // moving a vector keeps its bytes in place
    open_.pop_back();
  } else {
    std::push_heap(open_.begin(), open_.end(), is_later);
  }
  return true;
}

/// Opens every chunk that may contain the next message.
void ChunkMerger::load_due() {
  while (next_ < order_.size()) {
    if (!open_.empty()) {
      const Open& first = *open_.front();
      if (chunks_[order_[next_]].first_ns > first.chunk.entries[first.entry].time_ns) return;
    }
    open(order_[next_++]);
  }
}

void ChunkMerger::open(std::size_t number) {
  auto opened = std::make_unique<Open>();
  opened->number = number;
  opened->chunk = load_(number, std::exchange(current_, {}));
  std::vector<ChunkEntry>& entries = opened->chunk.entries;
  budget_->take(Budget::messages, entries.size(), place_);
  const ChunkRange& range = chunks_[number];
  for (const ChunkEntry& entry : entries) {
    if (entry.time_ns >= range.first_ns && entry.time_ns <= range.last_ns) continue;
    reject_bag(place_, fmt::format("a message at {} ns in a chunk of {} to {} ns", entry.time_ns,
                                   range.first_ns, range.last_ns));
  }
  if (!selected_.empty())
    std::erase_if(entries, [&](const ChunkEntry& entry) { return !selected_[entry.topic]; });
  if (entries.empty()) return;
  std::stable_sort(entries.begin(), entries.end(),
                   [](const ChunkEntry& a, const ChunkEntry& b) { return a.time_ns < b.time_ns; });
  if (!budget_->try_take(Budget::held_bytes, opened->chunk.bytes.size())) {
    throw Error({place_,
                 fmt::format("chunks of more than {} bytes whose times overlap",
                             budget_->limit(Budget::held_bytes)),
                 "messages that are roughly in order of time", "sort the bag"});
  }
  open_.push_back(std::move(opened));
  std::push_heap(open_.begin(), open_.end(), is_later);
}

bool ChunkMerger::is_later(const std::unique_ptr<Open>& a, const std::unique_ptr<Open>& b) {
  const auto key = [](const Open& open) {
    return std::pair(open.chunk.entries[open.entry].time_ns, open.number);
  };
  return key(*a) > key(*b);
}

}  // namespace glidar::bags
