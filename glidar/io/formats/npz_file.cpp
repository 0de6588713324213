// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/format.hpp>

#include <glidar/io/formats/npz_archive.hpp>
#include <glidar/io/formats/stored_columns.hpp>

#include <vector>

namespace glidar {
namespace {

/// A pose in NumPy's order: row by row.
using RowMajor4d = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;

NpzArray array_of(const PointCloud& cloud, const Column& column) {
  std::vector<std::size_t> shape = {cloud.rows, cloud.cols};
  if (column.components.size() > 1) shape.push_back(column.components.size());
  return std::visit(
      [&](const auto& values) { return npz_array(column.name, shape, std::span(values)); },
      column.values);
}

std::span<const double> numbers(const RowMajor4d& matrix) {
  return {matrix.data(), 16};
}

/// Writes an uncompressed NumPy archive: every column as (rows, cols) or (rows, cols, components),
/// poses 4x4 (world_from_sensor, world_from_cloud, world_from_instance (k, 4, 4)), stamp_ns, seed.
void write_npz(const CloudFile& job, AtomicFile& file) {
  const Frame& frame = job.frame;
  const RowMajor4d world_from_sensor = frame.world_from_sensor.matrix();
  const RowMajor4d world_from_cloud = job.cloud.world_from_cloud.matrix();
  std::vector<double> world_from_instance;
  for (const Pose& pose : frame.world_from_instance) {
    const RowMajor4d matrix = pose.matrix();
    world_from_instance.insert(world_from_instance.end(), matrix.data(), matrix.data() + 16);
  }
  std::vector<NpzArray> arrays;
  for (const StoredColumn& stored : stored_columns(job.fields))
    arrays.push_back(array_of(job.cloud, *stored.column));
  arrays.push_back(npz_array("world_from_sensor", {4, 4}, numbers(world_from_sensor)));
  arrays.push_back(npz_array("world_from_cloud", {4, 4}, numbers(world_from_cloud)));
  arrays.push_back(npz_array("world_from_instance", {frame.world_from_instance.size(), 4, 4},
                             std::span<const double>(world_from_instance)));
  arrays.push_back(npz_array("stamp_ns", {}, std::span(&frame.stamp_ns, 1)));
  arrays.push_back(npz_array("seed", {}, std::span(&frame.seed, 1)));
  write_npz_archive(arrays, file);
}

}  // namespace

Format npz_format() {
  return {.info = {.suffix = ".npz",
                   .description = "NumPy archive of all columns",
                   .columns = {"xyz"},
                   .takes_more = true},
          .content = Content::points,
          .fields = native_fields,
          .write = write_npz};
}

}  // namespace glidar
