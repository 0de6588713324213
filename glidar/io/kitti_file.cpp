// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/cloud_file.hpp>
#include <glidar/io/point_rows.hpp>

namespace glidar {

std::vector<Field> kitti_fields(const PointCloud& cloud) {
  std::vector<Field> fields;
  append_fields(*find_column(cloud, "xyz"), fields);
  append_fields(*find_column(cloud, "intensity"), fields);
  for (Field& field : fields) field.stored = Stored::f32;
  return fields;
}

void write_kitti(const CloudFile& job, AtomicFile& file) {
  write_binary_rows(job.fields, job.cloud.size(), file, job.options.progress);
}

}  // namespace glidar
