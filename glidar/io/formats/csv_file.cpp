// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/csv_file.hpp>
#include <glidar/io/formats/point_rows.hpp>

namespace glidar {

void write_csv(const CloudFile& job, AtomicFile& file) {
  file.write(joined_names(job.fields, ',') + "\n");
  write_text_rows(job.fields, job.cloud.size(), ',', file, job.options.progress);
}

}  // namespace glidar
