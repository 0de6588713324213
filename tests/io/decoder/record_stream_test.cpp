// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/decoder/record_stream.hpp>
#include <glidar/io/files/unique_fd.hpp>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <unistd.h>
#include <support/error_text.hpp>
#include <support/test_folder.hpp>

#include <algorithm>
#include <array>
#include <thread>

namespace glidar {
namespace {

using ::testing::HasSubstr;

using Bytes = std::vector<std::byte>;

constexpr std::uint64_t kMaxRingRecord = std::uint64_t{1} << 24U;

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
            "run.db3", kMaxRingRecord, std::make_shared<SharedRing>(memory.get())};
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
  const auto fill = [](std::size_t, std::span<std::byte> bytes) {
    std::ranges::fill(bytes, std::byte{5});
  };
  const auto put = [&] { return from.put(2 * SharedRing::kBytes, CopyPayload(fill)); };
  EXPECT_EQ(put(), SharedRing::kBytes);
  EXPECT_EQ(put(), 0U);
  Bytes taken(100);
  to.take(taken);
  EXPECT_EQ(put(), 100U);
}

TEST(SharedRing, ItsSizeCannotChange) {
  const UniqueFd memory(SharedRing::create());
  EXPECT_NE(::ftruncate(memory.get(), 0), 0);
  EXPECT_NE(::ftruncate(memory.get(), off_t{1} << 24), 0);
}

TEST(SharedRing, AFailureWithinARecordReplacesIt) {
  for (const std::size_t size : {100U, 5000U, 1'000'000U}) {
    Ends ends;
    std::thread writing([&] {
      SharedRing ring(ends.memory.get());
      RecordWriter writer(ends.write_end.get(), &ring);
      const auto copy = [](std::size_t offset, std::span<std::byte> bytes) {
        if (offset + bytes.size() > 90) throw Error({"run.db3", "a page is missing"});
      };
      writer.write({RecordKind::item, 7, 0, {}});
      try {
        writer.write({RecordKind::item, 8, 0, {}}, size, CopyPayload(copy));
      } catch (const Error& error) {
        writer.write_failure(error.parts());
      }
    });
    RecordReader reader = ends.reader();
    EXPECT_EQ(reader.next().index, 7U);
    EXPECT_EQ(error_text([&] { reader.next(); }), "run.db3: a page is missing");
    writing.join();
  }
}

TEST(SharedRing, ARecordWithoutItsEndIsAnError) {
  const Ends ends;
  std::array<std::byte, 52> stream{};  // an item of 5000 bytes, no piece, an item
  stream[0] = stream[28] = std::byte{3};
  stream[16] = std::byte{0x88};
  stream[17] = std::byte{0x13};
  ASSERT_EQ(::write(ends.write_end.get(), stream.data(), stream.size()), 52);
  RecordReader reader = ends.reader();
  EXPECT_THAT(error_text([&] { reader.next(); }), HasSubstr("a record without its end"));
}

TEST(SharedRing, PiecesThatDoNotFitAreErrors) {
  for (const std::uint32_t piece : {5001U, 0xFFFFFFFFU}) {
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

namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

using Bytes = std::vector<std::byte>;

constexpr std::uint64_t kMaxRecord = std::uint64_t{1} << 22U;

/// What a writer writes.
template <class Write>
Bytes written(const Write& write) {
  const testing::TestFolder folder;
  const std::string file = (folder / "records").string();
  const UniqueFd fd(::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600));
  RecordWriter writer(fd.get());
  write(writer);
  writer.flush();
  Bytes bytes(static_cast<std::size_t>(::lseek(fd.get(), 0, SEEK_END)));
  EXPECT_EQ(::pread(fd.get(), bytes.data(), bytes.size(), 0), static_cast<ssize_t>(bytes.size()));
  return bytes;
}

/// Reads bytes that arrive in pieces of `piece`.
RecordReader reader_of(const Bytes& bytes, std::size_t piece = SIZE_MAX) {
  auto at = std::make_shared<std::size_t>(0);
  return RecordReader(
      [&bytes, piece, at](std::span<std::byte> to) {
        const std::size_t size = std::min({to.size(), piece, bytes.size() - *at});
        std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(*at), size, to.begin());
        *at += size;
        return size;
      },
      "run.mcap", kMaxRecord);
}

TEST(RecordStream, RecordsOfAnySizeReadBackHoweverTheyArrive) {
  const std::vector<std::size_t> sizes = {0, 3, 300'000, 1, 3'000'000, 70'000, 262'144};
  const Bytes bytes = written([&](RecordWriter& to) {
    for (std::uint32_t i = 0; i < sizes.size(); ++i) {
      const Bytes payload(sizes[i], static_cast<std::byte>(i));
      to.write({RecordKind::item, i, -5 * std::int64_t{i}, payload});
    }
  });
  for (const std::size_t piece : {std::size_t{7'001}, std::size_t{65'536}, SIZE_MAX}) {
    RecordReader reader = reader_of(bytes, piece);
    for (std::uint32_t i = 0; i < sizes.size(); ++i) {
      const Record record = reader.next();
      EXPECT_EQ(record.index, i);
      EXPECT_EQ(record.stamp_ns, -5 * std::int64_t{i});
      ASSERT_EQ(record.payload.size(), sizes[i]);
      EXPECT_TRUE(std::all_of(record.payload.begin(), record.payload.end(),
                              [&](std::byte one) { return one == static_cast<std::byte>(i); }));
    }
  }
}

TEST(RecordStream, AnErrorOfTheProcessIsThrownWithoutControlCharacters) {
  const Bytes bytes = written([](RecordWriter& to) {
    to.write_failure({"run.mcap, byte 7", "a chunk\x1b[2J", "a complete bag", "copy it again"});
  });
  EXPECT_THAT(error_text([&] { reader_of(bytes).next(); }),
              HasSubstr("run.mcap, byte 7: a chunk?[2J; allowed: a complete bag; copy it again"));
}

TEST(RecordStream, MalformedStreamsAreErrors) {
  const Bytes item = written([](RecordWriter& to) {
    to.write({RecordKind::item, 0, 0, Bytes(10)});
  });
  const auto with = [&](std::size_t at, int value) {
    Bytes changed = item;
    changed[at] = static_cast<std::byte>(value);
    return error_text([&] { reader_of(changed).next(); });
  };
  EXPECT_THAT(with(0, 9), AllOf(HasSubstr("run.mcap: "), HasSubstr("a record of kind 9")));
  EXPECT_THAT(with(0, 0), HasSubstr("a record of kind 0"));
  EXPECT_THAT(with(22, 1), HasSubstr("a record of 281474976710666 bytes"));
  EXPECT_THAT(with(16, 11), HasSubstr("it ends early"));
  EXPECT_THAT(with(0, 5), HasSubstr("an error that ends early"));
  EXPECT_THAT(error_text([] { reader_of({}).next(); }), HasSubstr("it ends early"));
}

TEST(RecordStream, TopicsAreShort) {
  const Bytes bytes = written([](RecordWriter& to) {
    to.write({RecordKind::topic, 0, 0, Bytes(100'000)});
  });
  EXPECT_THAT(error_text([&] { reader_of(bytes).next(); }), HasSubstr("a record of 100000 bytes"));
}

}  // namespace
}  // namespace glidar
