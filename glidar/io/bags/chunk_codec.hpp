// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io/bags.

#include <glidar/io/bags/bag.hpp>
#include <glidar/io/bags/bag_file.hpp>
#include <glidar/io/bags/byte_writer.hpp>
#include <glidar/io/files/input_file.hpp>

#include <cstdint>
#include <string>

namespace glidar::bags {

/// Size after which a chunk is written.
inline constexpr std::size_t kChunkBytes = std::size_t{4} << 20U;
/// Maximum size of a chunk that is read.
inline constexpr std::uint64_t kMaxChunkBytes = std::uint64_t{1} << 29U;

/// Compresses a chunk into `to`, whose memory is reused. LZ4: one frame with independent blocks and
/// a checksum of the content, which is all that ROS 1 reads. Not for Compression::none.
void compress(std::span<const std::byte> chunk, Compression compression, Bytes& to);

/// Where a chunk is in its file.
struct StoredChunk {
  std::uint64_t offset = 0;  ///< of the records, which may be compressed
  std::uint64_t stored_size = 0;
  std::uint64_t size = 0;  ///< when it is decompressed
  Compression compression = Compression::none;
};

/// Reads and decompresses a chunk, in the memory of `reused`. Throws Error.
Bytes read_chunk(BagFile& file, const StoredChunk& chunk, InputBudget& budget, Bytes reused);

/// A chunk as a bag stores it.
struct PackedChunk {
  std::span<const std::byte> bytes;
  Compression compression = Compression::none;
  std::uint64_t size = 0;  ///< when it is decompressed
};

/// The chunk in the memory of `reused`. Throws Error, with `place`, unless it has its size, or when
/// it is larger than kMaxChunkBytes or the budget.
Bytes decompress(const PackedChunk& packed, InputBudget& budget, const std::string& place,
                 Bytes reused = {});

/// CRC-32 as zlib computes it, continued from `crc`.
std::uint32_t crc32_of(std::span<const std::byte> bytes, std::uint32_t crc = 0);

/// The CRC of two byte strings after each other, from the CRC of each.
std::uint32_t combined_crc32(std::uint32_t first, std::uint32_t second, std::uint64_t second_size);

}  // namespace glidar::bags
