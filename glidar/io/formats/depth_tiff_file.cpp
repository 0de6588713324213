// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/format.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/formats/npy_file.hpp>

#include <fmt/format.h>
#include <tiffio.h>

#include <algorithm>
#include <array>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace glidar {
namespace {

/// The file in memory, because libtiff seeks back to link its parts.
struct Memory {
  std::vector<char> bytes;
  std::size_t position = 0;
  std::string message;  ///< the last error
};

Memory& memory_of(thandle_t handle) {
  return *static_cast<Memory*>(handle);
}

tmsize_t read_bytes(thandle_t handle, void* to, tmsize_t size) {
  Memory& memory = memory_of(handle);
  const std::size_t there = memory.bytes.size() - std::min(memory.position, memory.bytes.size());
  const std::size_t count = std::min(there, static_cast<std::size_t>(size));
  std::memcpy(to, memory.bytes.data() + memory.position, count);
  memory.position += count;
  return static_cast<tmsize_t>(count);
}

tmsize_t write_bytes(thandle_t handle, void* from, tmsize_t size) {
  Memory& memory = memory_of(handle);
  const std::size_t end = memory.position + static_cast<std::size_t>(size);
  if (memory.bytes.size() < end) memory.bytes.resize(end);
  std::memcpy(memory.bytes.data() + memory.position, from, static_cast<std::size_t>(size));
  memory.position = end;
  return size;
}

toff_t seek_byte(thandle_t handle, toff_t offset, int whence) {
  Memory& memory = memory_of(handle);
  const std::size_t start = whence == SEEK_SET   ? 0
                            : whence == SEEK_CUR ? memory.position
                                                 : memory.bytes.size();
  return memory.position = start + offset;
}

int close_nothing(thandle_t /*handle*/) {
  return 0;
}

toff_t size_of_file(thandle_t handle) {
  return memory_of(handle).bytes.size();
}

int on_error(TIFF* /*tiff*/, void* user, const char* /*module*/, const char* format,
             va_list arguments) {
  std::array<char, 256> text{};
  std::vsnprintf(text.data(), text.size(), format, arguments);
  static_cast<Memory*>(user)->message = text.data();
  return 1;  // suppresses libtiff's own messages
}

using Tiff = std::unique_ptr<TIFF, decltype(&TIFFClose)>;

/// Little-endian; the classic format unless the pixels need offsets beyond 32 bits.
Tiff open_tiff(Memory& memory, std::size_t pixel_bytes) {
  constexpr std::size_t kRoomForTags = 4096;
  const bool is_big = pixel_bytes + kRoomForTags > std::numeric_limits<std::uint32_t>::max();
  const std::unique_ptr<TIFFOpenOptions, decltype(&TIFFOpenOptionsFree)> options(
      TIFFOpenOptionsAlloc(), TIFFOpenOptionsFree);
  TIFFOpenOptionsSetErrorHandlerExtR(options.get(), on_error, &memory);
  return {
      TIFFClientOpenExt("depth", is_big ? "wl8" : "wl", &memory, read_bytes, write_bytes, seek_byte,
                        close_nothing, size_of_file, nullptr, nullptr, options.get()),
      TIFFClose};
}

bool set_tags(TIFF* tiff, const CloudFile& job) {
  return TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, job.cloud.cols) == 1 &&
         TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, job.cloud.rows) == 1 &&
         TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 32) == 1 &&
         TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 1) == 1 &&
         TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_IEEEFP) == 1 &&
         TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK) == 1 &&
         TIFFSetField(tiff, TIFFTAG_COMPRESSION, COMPRESSION_NONE) == 1 &&
         TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, job.cloud.rows) == 1 &&
         TIFFSetField(tiff, TIFFTAG_IMAGEDESCRIPTION, job.pixels.c_str()) == 1;
}

/// Writes depth in metres as TIFF with one 32-bit float per pixel, NaN for no return.
void write_depth_tiff(const CloudFile& job, AtomicFile& file) {
  const auto& depths_m = std::get<std::vector<double>>(distance_column(job.cloud).values);
  std::vector<float> pixels(depths_m.size());
  std::transform(depths_m.begin(), depths_m.end(), pixels.begin(),
                 [](double depth_m) { return static_cast<float>(depth_m); });
  const std::size_t size = pixels.size() * sizeof(float);
  Memory memory;
  bool is_written = false;
  if (Tiff tiff = open_tiff(memory, size)) {
    is_written =
        set_tags(tiff.get(), job) &&
        TIFFWriteEncodedStrip(tiff.get(), 0, pixels.data(), static_cast<tmsize_t>(size)) >= 0 &&
        TIFFFlush(tiff.get()) == 1;
  }
  if (!is_written) {
    throw Error({file.path().string(), fmt::format("cannot write the TIFF: {}", memory.message), "",
                 "write .npy, which has the same numbers"});
  }
  file.write(std::string_view(memory.bytes.data(), memory.bytes.size()));
}

}  // namespace

Format depth_tiff_format() {
  return {.info = {.suffix = ".depth.tiff",
                   .description = "32-bit depth image, metres",
                   .columns = {"depth"}},
          .content = Content::image,
          .fields = depth_fields,
          .write = write_depth_tiff,
          .pixels = "depth in metres as 32-bit float; NaN: no return"};
}

}  // namespace glidar
