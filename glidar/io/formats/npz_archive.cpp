// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/npz_archive.hpp>

#include <glidar/core/error.hpp>

#include <fmt/format.h>
#include <zip.h>

#include <array>
#include <exception>
#include <memory>

namespace glidar {
namespace {

/// The target of libzip's bytes, and a stored exception, because none may pass through libzip.
struct NpzTarget {
  AtomicFile& file;
  std::exception_ptr failure;
  zip_error_t error{};
};

zip_int64_t seek(NpzTarget& target, void* data, zip_uint64_t length) {
  // libzip seeks from the start or the current position, never from the end
  constexpr auto kNoEnd = static_cast<zip_uint64_t>(ZIP_INT64_MAX);
  const zip_int64_t offset =
      zip_source_seek_compute_offset(target.file.position(), kNoEnd, data, length, &target.error);
  if (offset >= 0) target.file.seek(static_cast<std::uint64_t>(offset));
  return offset < 0 ? -1 : 0;
}

/// The part of libzip's source protocol (zip_source_function(3)) that a new archive needs.
zip_int64_t answer(NpzTarget& target, void* data, zip_uint64_t length, zip_source_cmd_t command) {
  switch (command) {
    case ZIP_SOURCE_SUPPORTS:
      return zip_source_make_command_bitmap(
          ZIP_SOURCE_OPEN, ZIP_SOURCE_READ, ZIP_SOURCE_CLOSE, ZIP_SOURCE_STAT, ZIP_SOURCE_ERROR,
          ZIP_SOURCE_FREE, ZIP_SOURCE_SEEK, ZIP_SOURCE_TELL, ZIP_SOURCE_BEGIN_WRITE,
          ZIP_SOURCE_COMMIT_WRITE, ZIP_SOURCE_ROLLBACK_WRITE, ZIP_SOURCE_WRITE,
          ZIP_SOURCE_SEEK_WRITE, ZIP_SOURCE_TELL_WRITE, ZIP_SOURCE_REMOVE, -1);
    case ZIP_SOURCE_STAT:
      zip_stat_init(static_cast<zip_stat_t*>(data));
      return sizeof(zip_stat_t);
    case ZIP_SOURCE_ERROR:
      return zip_error_to_data(&target.error, data, length);
    case ZIP_SOURCE_WRITE:
      target.file.write(std::span(static_cast<const std::byte*>(data), length));
      return static_cast<zip_int64_t>(length);
    case ZIP_SOURCE_SEEK_WRITE:
      return seek(target, data, length);
    case ZIP_SOURCE_TELL_WRITE:
      return static_cast<zip_int64_t>(target.file.position());
    case ZIP_SOURCE_OPEN:
    case ZIP_SOURCE_CLOSE:
    case ZIP_SOURCE_BEGIN_WRITE:
    case ZIP_SOURCE_COMMIT_WRITE:
    case ZIP_SOURCE_ROLLBACK_WRITE:
    case ZIP_SOURCE_REMOVE:
    case ZIP_SOURCE_FREE:
      return 0;
    default:
      zip_error_set(&target.error, ZIP_ER_OPNOTSUPP, 0);
      return -1;
  }
}

extern "C" zip_int64_t glidar_npz_target(void* user, void* data, zip_uint64_t length,
                                         zip_source_cmd_t command) {
  NpzTarget& target = *static_cast<NpzTarget*>(user);
  try {
    return answer(target, data, length, command);
  } catch (...) {
    target.failure = std::current_exception();
    zip_error_set(&target.error, ZIP_ER_WRITE, 0);
    return -1;
  }
}

[[noreturn]] void fail(const NpzTarget& target, const char* reason) {
  if (target.failure) std::rethrow_exception(target.failure);
  throw Error({target.file.path().string(), fmt::format("cannot write the archive: {}", reason)});
}

using Archive = std::unique_ptr<zip_t, decltype(&zip_discard)>;

Archive open_archive(NpzTarget& target) {
  zip_error_t error;
  zip_error_init(&error);
  zip_source_t* sink = zip_source_function_create(glidar_npz_target, &target, &error);
  zip_t* archive =
      sink == nullptr ? nullptr : zip_open_from_source(sink, ZIP_CREATE | ZIP_TRUNCATE, &error);
  if (archive == nullptr) {
    zip_source_free(sink);
    fail(target, zip_error_strerror(&error));
  }
  return {archive, zip_discard};
}

/// Header and numbers are read in place when the archive is closed.
void add(zip_t* archive, const NpzArray& array, const NpzTarget& target) {
  // libzip's interface takes non-const pointers but only reads.
  const auto fragment = [](const void* data, std::size_t size) {
    return zip_buffer_fragment_t{static_cast<zip_uint8_t*>(const_cast<void*>(data)), size};
  };
  const std::array fragments = {fragment(array.head.data(), array.head.size()),
                                fragment(array.bytes.data(), array.bytes.size())};
  zip_source_t* source =
      zip_source_buffer_fragment(archive, fragments.data(), array.bytes.empty() ? 1 : 2, 0);
  if (source == nullptr) fail(target, zip_strerror(archive));
  const zip_int64_t added =
      zip_file_add(archive, (array.name + ".npy").c_str(), source, ZIP_FL_ENC_UTF_8);
  if (added < 0) {
    zip_source_free(source);
    fail(target, zip_strerror(archive));
  }
  const auto index = static_cast<zip_uint64_t>(added);
  constexpr zip_uint16_t kFirstJanuary1980 =
      (1U << 5U) | 1U;  // a fixed date, so that the bytes do not depend on the time
  if (zip_set_file_compression(archive, index, ZIP_CM_STORE, 0) != 0 ||
      zip_file_set_dostime(archive, index, 0, kFirstJanuary1980, 0) != 0)
    fail(target, zip_strerror(archive));
}

}  // namespace

void write_npz_archive(const std::vector<NpzArray>& arrays, AtomicFile& file) {
  NpzTarget target{file, nullptr, {}};
  zip_error_init(&target.error);
  Archive archive = open_archive(target);
  for (const NpzArray& array : arrays) add(archive.get(), array, target);
  if (zip_close(archive.get()) != 0) fail(target, zip_strerror(archive.get()));
  static_cast<void>(archive.release());  // closed and freed
}

}  // namespace glidar
