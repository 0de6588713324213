// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/bags/chunk_codec.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/bags/byte_reader.hpp>

#include <fmt/format.h>
#include <lz4frame.h>
#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <memory>
#include <utility>

namespace glidar::bags {
namespace {

/// LZ4 expands a byte to at most 255 (lz4_Block_format.md); zstd has no such limit.
constexpr std::uint64_t kMaxLz4Ratio = 256;

LZ4F_preferences_t lz4_preferences() {
  LZ4F_preferences_t preferences = LZ4F_INIT_PREFERENCES;
  preferences.frameInfo.blockSizeID = LZ4F_max4MB;
  preferences.frameInfo.blockMode = LZ4F_blockIndependent;
  preferences.frameInfo.contentChecksumFlag = LZ4F_contentChecksumEnabled;
  return preferences;
}

void compress_lz4(std::span<const std::byte> chunk, Bytes& to) {
  const LZ4F_preferences_t preferences = lz4_preferences();
  to.resize(LZ4F_compressFrameBound(chunk.size(), &preferences));
  const std::size_t size =
      LZ4F_compressFrame(to.data(), to.size(), chunk.data(), chunk.size(), &preferences);
  if (LZ4F_isError(size) != 0U)
    throw Error({"LZ4", std::string("cannot compress: ") + LZ4F_getErrorName(size)});
  to.resize(size);
}

void compress_zstd(std::span<const std::byte> chunk, Bytes& to) {
  constexpr int kFast = 1;
  to.resize(ZSTD_compressBound(chunk.size()));
  const std::size_t size = ZSTD_compress(to.data(), to.size(), chunk.data(), chunk.size(), kFast);
  if (ZSTD_isError(size) != 0U)
    throw Error({"Zstandard", std::string("cannot compress: ") + ZSTD_getErrorName(size)});
  to.resize(size);
}

Bytes decompress_lz4(std::span<const std::byte> packed, std::uint64_t size,
                     const std::string& place, Bytes chunk) {
  if (size / kMaxLz4Ratio > packed.size())
    reject_bag(place, fmt::format("{} bytes that claim to be {}", packed.size(), size));
  LZ4F_dctx* made = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&made, LZ4F_VERSION)) != 0U)
    throw Error({place, "cannot decompress LZ4"});
  const std::unique_ptr<LZ4F_dctx, LZ4F_errorCode_t (*)(LZ4F_dctx*)> context(
      made, LZ4F_freeDecompressionContext);
  chunk.resize(size);
  std::size_t done = 0;
  for (;;) {
    std::size_t written = chunk.size() - done;
    std::size_t read = packed.size();
    const std::size_t hint = LZ4F_decompress(context.get(), chunk.data() + done, &written,
                                             packed.data(), &read, nullptr);
    if (LZ4F_isError(hint) != 0U)
      reject_bag(place, std::string("damaged LZ4 data: ") + LZ4F_getErrorName(hint));
    done += written;
    packed = packed.subspan(read);
    if (hint == 0 || (written == 0 && read == 0)) {
      if (hint == 0 && packed.empty() && done == chunk.size()) return chunk;
      reject_bag(place, "LZ4 data of another size", fmt::format("{} bytes", size));
    }
  }
}

Bytes decompress_zstd(std::span<const std::byte> packed, std::uint64_t size,
                      const std::string& place, Bytes chunk) {
  const unsigned long long known = ZSTD_getFrameContentSize(packed.data(), packed.size());
  if (known == ZSTD_CONTENTSIZE_ERROR || (known != ZSTD_CONTENTSIZE_UNKNOWN && known > size))
    reject_bag(place, "damaged Zstandard data");
  chunk.resize(size);
  const std::size_t done =
      ZSTD_decompress(chunk.data(), chunk.size(), packed.data(), packed.size());
  if (ZSTD_isError(done) != 0U)
    reject_bag(place, std::string("damaged Zstandard data: ") + ZSTD_getErrorName(done));
  if (done != size)
    reject_bag(place, fmt::format("{} bytes of Zstandard data", done), fmt::format("{}", size));
  return chunk;
}

}  // namespace

void compress(std::span<const std::byte> chunk, Compression compression, Bytes& to) {
  if (compression == Compression::lz4) return compress_lz4(chunk, to);
  compress_zstd(chunk, to);
}

Bytes decompress(const PackedChunk& packed, InputBudget& budget, const std::string& place,
                 Bytes reused) {
  const auto& [bytes, compression, size] = packed;
  if (compression == Compression::none) {
    if (bytes.size() != size)
      reject_bag(place, fmt::format("{} bytes that claim to be {}", bytes.size(), size));
    return {bytes.begin(), bytes.end()};
  }
  const std::uint64_t max_size = std::min(kMaxChunkBytes, budget.limit(Budget::held_bytes));
  if (size > max_size) {
    reject_bag(place, fmt::format("a chunk of {} bytes", size),
               fmt::format("at most {} bytes in a bag of this size", max_size));
  }
  budget.take(Budget::decompressed_bytes, size, place);
  if (compression == Compression::lz4) return decompress_lz4(bytes, size, place, std::move(reused));
  return decompress_zstd(bytes, size, place, std::move(reused));
}

Bytes read_chunk(BagFile& file, const StoredChunk& chunk, InputBudget& budget, Bytes reused) {
  if (chunk.compression == Compression::none && chunk.size == chunk.stored_size)
    return file.read(chunk.offset, chunk.size, std::move(reused));
  const Bytes stored = file.read(chunk.offset, chunk.stored_size);
  return decompress({stored, chunk.compression, chunk.size}, budget, file.place(chunk.offset),
                    std::move(reused));
}

std::uint32_t crc32_of(std::span<const std::byte> bytes, std::uint32_t crc) {
  return static_cast<std::uint32_t>(
      crc32_z(crc, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

std::uint32_t combined_crc32(std::uint32_t first, std::uint32_t second, std::uint64_t second_size) {
  return static_cast<std::uint32_t>(
      crc32_combine(first, second, static_cast<z_off_t>(second_size)));
}

}  // namespace glidar::bags
