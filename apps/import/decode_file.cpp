// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/decode_file.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/bags/bag_records.hpp>
#include <glidar/io/bags/sqlite.hpp>
#include <glidar/io/formats/grey_image_file.hpp>
#include <glidar/io/model/png_texture.hpp>
#include <glidar/io/packets/packet_frames.hpp>

#include <sys/resource.h>

namespace glidar::import {
namespace {

/// Limits SQLite to an eighth of this process's memory.
void limit_sqlite() {
  rlimit memory{};
  if (::getrlimit(RLIMIT_AS, &memory) == 0 && memory.rlim_cur != RLIM_INFINITY)
    bags::limit_sqlite_memory(memory.rlim_cur / 8);
}

}  // namespace

bool decode_file(const std::string& kind, const std::filesystem::path& path, const HelperFds& fds) {
  SharedRing ring(fds.shared);
  RecordWriter records(fds.answer, &ring);
  try {
    if (kind == kBagDecoder.name) {
      limit_sqlite();
      bags::send_bag(*bags::open_bag_unconfined(path), records, fds.control);
    } else if (kind == kCaptureDecoder.name) {
      send_packets(path, records);
    } else if (kind == kGreyImageDecoder.name) {
      send_grey_image(path, records);
    } else if (kind == kTextureDecoder.name) {
      send_png_texture(path, records);
    } else {
      return false;
    }
  } catch (const Error& error) {
    records.write_failure(error.parts());
  }
  return true;
}

}  // namespace glidar::import
