// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/decoder/shared_ring.hpp>

#include <glidar/io/decoder/record_stream.hpp>
#include <glidar/io/files/unique_fd.hpp>

#include <support/error_text.hpp>

#include <gmock/gmock.h>

#include <unistd.h>

#include <array>
#include <thread>

namespace glidar {
namespace {

using ::testing::HasSubstr;

using Bytes = std::vector<std::byte>;

constexpr std::uint64_t kMaxPayload = std::uint64_t{1} << 24U;

/// Both ends of the memory and of the pipe beside it.
struct Ends {
  UniqueFd memory{SharedRing::create()};
  UniqueFd read_end;
  UniqueFd write_end;

  Ends() {
    std::array<int, 2> pipe{};
    EXPECT_EQ(::pipe(pipe.data()), 0);
    read_end = UniqueFd(pipe[0]);
    write_end = UniqueFd(pipe[1]);
  }
  [[nodiscard]] RecordReader reader() const {
    return {[fd = read_end.get()](std::span<std::byte> to) {
              const ssize_t got = ::read(fd, to.data(), to.size());
              return static_cast<std::size_t>(std::max<ssize_t>(got, 0));
            },
            "run.db3", kMaxPayload, std::make_shared<SharedRing>(memory.get())};
  }
};

Bytes pattern(std::size_t size, std::size_t seed) {
  Bytes bytes(size);
  for (std::size_t i = 0; i < size; ++i)
    bytes[i] = static_cast<std::byte>((i * 31 + seed * 7 + i / 4099) & 255U);
  return bytes;
}

TEST(SharedRing, RecordsLargerThanItReadBackInOrder) {
  const std::vector<std::size_t> sizes = {10,     4096, 5'000'000, 3,   524'288,
                                          70'000, 0,    524'289,   4095};
  Ends ends;
  std::thread writing([&] {
    SharedRing ring(ends.memory.get());
    RecordWriter writer(ends.write_end.get(), &ring);
    for (std::uint32_t i = 0; i < sizes.size(); ++i)
      writer.write({RecordKind::item, i, i, pattern(sizes[i], i)});
    writer.flush();
  });
  RecordReader reader = ends.reader();
  for (std::uint32_t i = 0; i < sizes.size(); ++i) {
    const Record record = reader.next();
    EXPECT_EQ(record.index, i);
    EXPECT_EQ(Bytes(record.payload.begin(), record.payload.end()), pattern(sizes[i], i));
  }
  writing.join();
}

TEST(SharedRing, HoldsNoMoreThanItsSizeUntilBytesAreTaken) {
  const UniqueFd memory(SharedRing::create());
  SharedRing from(memory.get());
  SharedRing to(memory.get());
  const Bytes bytes(2 * std::size_t{SharedRing::kBytes}, std::byte{5});
  EXPECT_EQ(from.put(bytes), SharedRing::kBytes);
  EXPECT_EQ(from.put(bytes), 0U);
  Bytes taken(100);
  to.take(taken);
  EXPECT_EQ(from.put(bytes), 100U);
}

TEST(SharedRing, ItsSizeCannotChange) {
  const UniqueFd memory(SharedRing::create());
  EXPECT_NE(::ftruncate(memory.get(), 0), 0);
  EXPECT_NE(::ftruncate(memory.get(), off_t{1} << 24), 0);
}

TEST(SharedRing, PiecesThatDoNotFitAreErrors) {
  for (const std::uint32_t piece : {0U, 5001U, 0xFFFFFFFFU}) {
    const Ends ends;
    std::array<std::byte, 24> head{};
    head[0] = std::byte{3};      // an item
    head[16] = std::byte{0x88};  // of 5000 bytes
    head[17] = std::byte{0x13};
    ASSERT_EQ(::write(ends.write_end.get(), head.data(), head.size()), 24);
    ASSERT_EQ(::write(ends.write_end.get(), &piece, sizeof piece), 4);
    RecordReader reader = ends.reader();
    EXPECT_THAT(error_text([&] { reader.next(); }), HasSubstr("a piece of"));
  }
}

}  // namespace
}  // namespace glidar
