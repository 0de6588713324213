// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/cloud_file.hpp>
#include <glidar/io/point_rows.hpp>

namespace glidar {

void write_kitti(const CloudFile& job, AtomicFile& file) {
  std::vector<Field> fields;
  append_fields(*find_column(job.cloud, "xyz"), fields);
  append_fields(*find_column(job.cloud, "intensity"), fields);
  for (Field& field : fields) field.stored = Stored::f32;
  write_binary_rows(fields, job.cloud.size(), file, job.options.progress);
}

}  // namespace glidar
