// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/format.hpp>

#include <glidar/core/text.hpp>
#include <glidar/core/version.hpp>
#include <glidar/io/formats/point_rows.hpp>

#include <fmt/format.h>

#include <array>
#include <iterator>

namespace glidar {
namespace {

/// Readers expect these names of normals and colours.
void append_renamed(const Column& column, const std::array<const char*, 3>& names, Stored stored,
                    std::vector<PointField>& fields) {
  for (std::size_t c = 0; c < names.size(); ++c) fields.push_back({names[c], &column, c, stored});
}

std::string ply_header(const CloudFile& job, const CloudSize& size) {
  std::string text =
      fmt::format("ply\nformat {} 1.0\ncomment glidar {}, metres in the frame {}{}\n",
                  job.options.ply_ascii ? "ascii" : "binary_little_endian", version(),
                  printable_line(job.cloud.frame_id), size.padding);
  if (size.rows > 1) {
    fmt::format_to(std::back_inserter(text), "obj_info num_cols {}\nobj_info num_rows {}\n",
                   size.cols, size.rows);
  }
  fmt::format_to(std::back_inserter(text), "element vertex {}\n", size.rows * size.cols);
  for (const PointField& field : job.fields) {
    fmt::format_to(std::back_inserter(text), "property {} {}\n", type_of(field.stored).ply_name,
                   field.name);
  }
  return text + "end_header\n";
}

/// Fields of a PLY file: x y z are float unless that moves a point by more than 0.1 mm or there are
/// points of several frames, then double. Other columns keep their types, except times in 64-bit
/// integers, which are split; normals are nx ny nz, colour is uchar red green blue.
std::vector<PointField> ply_fields(const PointCloud& cloud) {
  std::vector<PointField> fields;
  for (const Column& column : cloud.columns) {
    if (column.name == "xyz") {
      const bool is_float = float_is_enough(column) && find_column(cloud, kFrameColumn) == nullptr;
      const Stored stored = is_float ? Stored::f32 : Stored::f64;
      append_renamed(column, {"x", "y", "z"}, stored, fields);
    } else if (column.name == "normal" && column.components.size() == 3) {
      append_renamed(column, {"nx", "ny", "nz"}, native_type(column), fields);
    } else if (is_colour(column)) {
      append_renamed(column, {"red", "green", "blue"}, Stored::colour_byte, fields);
    } else if (native_type(column) == Stored::i64) {
      append_split_time(column, fields);
    } else {
      append_fields(column, fields);
    }
  }
  return fields;
}

std::string ply_run_start(const CloudFile& job, const RunTotals& totals) {
  return ply_header(job, size_of_run(totals, 1));
}

void append_ply(const CloudFile& job, RunTotals& totals, AtomicFile& file) {
  totals.points += job.cloud.size();
  if (job.options.ply_ascii) {
    write_text_rows(job.fields, job.cloud.size(), ' ', file, job.options.progress);
  } else {
    write_binary_rows(job.fields, job.cloud.size(), file, job.options.progress);
  }
}

/// Writes a Stanford polygon file, little-endian or ascii, vertices only. The size of an organised
/// cloud is stored as in PCL: `obj_info num_cols`.
void write_ply(const CloudFile& job, AtomicFile& file) {
  file.write(ply_header(job, {job.cloud.rows, job.cloud.cols, {}}));
  RunTotals unused;
  append_ply(job, unused, file);
}

}  // namespace

Format ply_format() {
  return {.info = {.suffix = ".ply",
                   .description = "Stanford polygon file",
                   .columns = {"xyz"},
                   .takes_more = true},
          .content = Content::points,
          .fields = ply_fields,
          .write = write_ply,
          .run_start = ply_run_start,
          .append = append_ply,
          .is_text = [](const FileSinkOptions& options) { return options.ply_ascii; }};
}

}  // namespace glidar
