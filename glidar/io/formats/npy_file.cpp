// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/npy_file.hpp>
#include <glidar/io/formats/point_rows.hpp>

#include <fmt/format.h>

#include <array>
#include <iterator>
#include <vector>

namespace glidar {
namespace {

std::vector<PointField> range_fields(const PointCloud& cloud) {
  return {{"range", find_column(cloud, "range"), 0, Stored::f32}};
}

void write_image(const CloudFile& job, AtomicFile& file) {
  const std::array<std::size_t, 2> shape = {job.cloud.rows, job.cloud.cols};
  file.write(npy_header("<f4", shape));
  write_binary_rows(job.fields, job.cloud.size(), file);
}

}  // namespace

std::string npy_header(std::string_view type, std::span<const std::size_t> shape) {
  constexpr std::size_t kAlignment = 64;
  std::string sizes;
  for (const std::size_t size : shape) fmt::format_to(std::back_inserter(sizes), "{}, ", size);
  std::string dictionary =
      fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}), }}", type, sizes);
  std::string head = "\x93NUMPY";
  head.append({'\x01', '\x00'});
  const std::size_t before = head.size() + 2;
  const std::size_t total = (before + dictionary.size() + kAlignment) / kAlignment * kAlignment;
  dictionary.resize(total - before, ' ');
  dictionary.back() = '\n';
  head += static_cast<char>(dictionary.size() & 0xFFU);
  head += static_cast<char>(dictionary.size() >> 8U);
  return head + dictionary;
}

std::vector<PointField> depth_fields(const PointCloud& cloud) {
  const Column& column = distance_column(cloud);
  return {{column.name, &column, 0, Stored::f32}};
}

Format npy_format() {
  return {.info = {.suffix = ".npy",
                   .description = "NumPy depth image (LiDAR: range), metres",
                   .columns = {"depth"}},
          .content = Content::image,
          .fields = depth_fields,
          .write = write_image,
          .pixels = "depth in metres as 32-bit float; NaN: no return"};
}

Format depth_npy_format() {
  Format format = npy_format();
  format.info.suffix = ".depth.npy";
  format.info.description = "NumPy depth image, metres";
  return format;
}

Format range_npy_format() {
  return {.info = {.suffix = ".range.npy",
                   .description = "NumPy range image, metres",
                   .columns = {"range"}},
          .content = Content::image,
          .fields = range_fields,
          .write = write_image,
          .pixels = "range along the beam in metres as 32-bit float; NaN: no return"};
}

}  // namespace glidar
