// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/decoder/pixel_records.hpp>

#include <cstring>

namespace glidar {

void send_pixels(const PixelSize& size, std::span<const std::byte> bytes, RecordWriter& to) {
  std::vector<std::byte> payload(sizeof size + bytes.size());
  std::memcpy(payload.data(), &size, sizeof size);
  std::memcpy(payload.data() + sizeof size, bytes.data(), bytes.size());
  to.write({RecordKind::item, 0, 0, payload});
  to.flush();
}

ReceivedPixels receive_pixels(DecoderRun run, std::uint64_t (*bytes_of)(const PixelSize& size)) {
  const Record record = run.records.next();
  ReceivedPixels pixels;
  if (record.kind != RecordKind::item || record.payload.size() <= sizeof pixels.size)
    run.records.reject("no image");
  std::memcpy(&pixels.size, record.payload.data(), sizeof pixels.size);
  const std::span<const std::byte> bytes = record.payload.subspan(sizeof pixels.size);
  if (bytes.size() != bytes_of(pixels.size)) run.records.reject("an image of another size");
  pixels.bytes.assign(bytes.begin(), bytes.end());
  return pixels;
}

}  // namespace glidar
