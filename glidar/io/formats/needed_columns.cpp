// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/needed_columns.hpp>

namespace glidar {

std::vector<std::string> needed_columns(const FileFormat& format) {
  std::vector<std::string> columns = format.columns;
  if (format.suffix == ".bin" || format.suffix == ".kitti")
    columns.insert(columns.end(), {"range", "instance", "class"});
  return columns;
}

}  // namespace glidar
