// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/format.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/text.hpp>
#include <glidar/core/version.hpp>
#include <glidar/io/formats/point_rows.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <lzf.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <limits>

namespace glidar {
namespace {

constexpr std::size_t kMaxBlock = std::numeric_limits<std::uint32_t>::max();

/// PCL declares packed colour as float in binary files; in text it must be the integer, because
/// most of these bit patterns are denormal floats, which text readers reject.
char pcd_type(Stored stored, PcdEncoding encoding) {
  if (stored == Stored::packed_rgb) return encoding == PcdEncoding::ascii ? 'U' : 'F';
  if (stored == Stored::i64) return 'I';
  return stored == Stored::f32 || stored == Stored::f64 ? 'F' : 'U';
}

std::string viewpoint(const CloudFile& job) {
  const Pose cloud_from_sensor = job.cloud.world_from_cloud.inverse() * job.frame.world_from_sensor;
  return fmt::format("{}", fmt::join(to_xyz_wxyz(cloud_from_sensor), " "));
}

std::string header(const CloudFile& job, const CloudSize& size, const std::string& viewpoint) {
  const std::span<const PointField> fields = job.fields;
  constexpr std::array kData = {"ascii", "binary", "binary_compressed"};
  const PcdEncoding encoding = job.options.pcd;
  std::string sizes;
  std::string types;
  std::string counts;
  for (const PointField& field : fields) {
    fmt::format_to(std::back_inserter(sizes), " {}", type_of(field.stored).bytes);
    fmt::format_to(std::back_inserter(types), " {}", pcd_type(field.stored, encoding));
    counts += " 1";
  }
  return fmt::format(
      "# .PCD v0.7 - Point Cloud Data file format\n"
      "# glidar {}, metres in the frame {}{}\n"
      "VERSION 0.7\nFIELDS {}\nSIZE{}\nTYPE{}\nCOUNT{}\nWIDTH {}\nHEIGHT {}\nVIEWPOINT {}\n"
      "POINTS {}\nDATA {}\n",
      version(), printable_line(job.cloud.frame_id), size.padding, joined_names(fields, ' '), sizes,
      types, counts, size.cols, size.rows, viewpoint, size.rows * size.cols,
      kData[static_cast<std::size_t>(encoding)]);
}

[[noreturn]] void too_large(const AtomicFile& file) {
  throw Error({file.path().string(), "the cloud is too large for binary_compressed PCD",
               "less than 4 GiB of points", "write binary PCD instead"});
}

/// Field after field, as PCL compresses it.
std::vector<std::byte> by_field(std::span<const PointField> fields, std::size_t count) {
  std::vector<std::byte> bytes(row_bytes(fields) * count);
  std::size_t offset = 0;
  for (const PointField& field : fields) {
    const std::size_t size = type_of(field.stored).bytes * count;
    pack_rows(std::span(&field, 1), 0, count, std::span(bytes).subspan(offset, size));
    offset += size;
  }
  return bytes;
}

/// In the worst case lzf adds one byte to 32 and a few at the end. Its hash table starts
/// uninitialised, but the result does not depend on that: an entry is used only if three earlier
/// bytes match, and every earlier triple has been entered (or is a copy of one that was).
void write_compressed(std::span<const PointField> fields, std::size_t count, AtomicFile& file) {
  const std::size_t raw_size = row_bytes(fields) * count;
  if (raw_size > kMaxBlock) too_large(file);
  const std::vector<std::byte> raw = by_field(fields, count);
  std::vector<std::byte> packed(std::min(raw_size + raw_size / 16 + 64, kMaxBlock));
  const unsigned packed_size =
      raw.empty() ? 0U
                  : lzf_compress(raw.data(), static_cast<unsigned>(raw_size), packed.data(),
                                 static_cast<unsigned>(packed.size()));
  if (packed_size == 0 && !raw.empty()) too_large(file);
  const std::array<std::uint32_t, 2> sizes = {packed_size, static_cast<std::uint32_t>(raw_size)};
  file.write(std::as_bytes(std::span(sizes)));
  file.write(std::span<const std::byte>(packed).first(packed_size));
}

/// Fields of a PCD file: real numbers as float, as PCL's point types require; colour is PCL's
/// packed `rgb`.
std::vector<PointField> pcd_fields(const PointCloud& cloud) {
  std::vector<PointField> fields;
  for (const Column& column : cloud.columns) {
    // PCL's own points are float, and Open3D reads wider numbers as 0.
    for (PointField& field : append_pcl_fields(column, fields)) {
      if (field.stored == Stored::f64) field.stored = Stored::f32;
    }
  }
  return fields;
}

/// Writes a Point Cloud Library file, format 0.7: https://pcl.readthedocs.io (The PCD file format).
/// The viewpoint is the sensor's pose in the cloud's frame.
void write_pcd(const CloudFile& job, AtomicFile& file) {
  const std::span<const PointField> fields = job.fields;
  file.write(header(job, {job.cloud.rows, job.cloud.cols, {}}, viewpoint(job)));
  switch (job.options.pcd) {
    case PcdEncoding::ascii:
      return write_text_rows(fields, job.cloud.size(), ' ', file, job.options.progress);
    case PcdEncoding::binary:
      return write_binary_rows(fields, job.cloud.size(), file, job.options.progress);
    case PcdEncoding::binary_compressed:
      return write_compressed(fields, job.cloud.size(), file);
  }
}

/// The sensor may move, so that there is no single viewpoint.
std::string pcd_run_start(const CloudFile& job, const RunTotals& totals) {
  return header(job, size_of_run(totals, 2), "0 0 0 1 0 0 0");
}

void append_pcd(const CloudFile& job, RunTotals& totals, AtomicFile& file) {
  totals.points += job.cloud.size();
  if (job.options.pcd == PcdEncoding::ascii) {
    write_text_rows(job.fields, job.cloud.size(), ' ', file, job.options.progress);
  } else {
    write_binary_rows(job.fields, job.cloud.size(), file, job.options.progress);
  }
}

}  // namespace

Format pcd_format() {
  return {
      .info = {.suffix = ".pcd",
               .description = "Point Cloud Library",
               .columns = {"xyz"},
               .takes_more = true},
      .content = Content::points,
      .fields = pcd_fields,
      .write = write_pcd,
      .run_start = pcd_run_start,
      .append = append_pcd,
      .is_text = [](const FileSinkOptions& options) { return options.pcd == PcdEncoding::ascii; }};
}

}  // namespace glidar
