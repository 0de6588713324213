// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/format.hpp>
#include <glidar/io/formats/point_rows.hpp>

namespace glidar {
namespace {

std::string csv_start(const CloudFile& job, const RunTotals& /*totals*/) {
  return joined_names(job.fields, ',') + "\n";
}

void append_csv(const CloudFile& job, RunTotals& totals, AtomicFile& file) {
  totals.points += job.cloud.size();
  write_text_rows(job.fields, job.cloud.size(), ',', file, job.options.progress);
}

/// Writes a line of field names, then a line per point, with the shortest digits that represent
/// each number exactly.
void write_csv(const CloudFile& job, AtomicFile& file) {
  RunTotals totals;
  file.write(csv_start(job, totals));
  append_csv(job, totals, file);
}

}  // namespace

Format csv_format() {
  return {.info = {.suffix = ".csv",
                   .description = "text table",
                   .columns = {"xyz"},
                   .takes_more = true},
          .content = Content::points,
          .fields = native_fields,
          .write = write_csv,
          .run_start = csv_start,
          .append = append_csv,
          .is_text = [](const FileSinkOptions& /*options*/) { return true; }};
}

}  // namespace glidar
