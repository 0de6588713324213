// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/optics_yaml.hpp>
#include <glidar/io/config/ray_file.hpp>
#include <glidar/math/constants.hpp>

namespace glidar {
namespace {

constexpr NumberRule kTablePoint_us = {1e-3, 1e6, false, "microseconds from 0.001 to 1e6"};

/// Cuts a list of beams into rows of equal length.
void apply_rows(const YamlField& field, RayTable& table) {
  const std::uint32_t size = table.rows * table.cols;
  const std::uint32_t rows = whole_number(field, 1, size);
  if (size % rows != 0) {
    reject(field, describe(field), "a divisor of the table's " + std::to_string(size) + " beams");
  }
  table.rows = rows;
  table.cols = size / rows;
}

/// Beams one after the other, whatever times the file has.
void apply_point_time(double point_ns, RayTable& table) {
  const std::size_t size = table.directions.size();
  table.times_ns.resize(size);
  for (std::size_t i = 0; i < size; ++i) table.times_ns[i] = static_cast<double>(i) * point_ns;
  table.period_ns = static_cast<double>(size) * point_ns;
}

}  // namespace

RayTable read_beam_table(const YamlField& field) {
  require_map(field, {"type", "file", "rows", "point_us"});
  const YamlField file = need(field, "file");
  const std::filesystem::path path = path_beside(file);
  const bool is_text = path.extension() == ".csv";
  if (!is_text && path.extension() != ".npy") {
    reject(file, describe(file), "a .csv of times, azimuths and zenith angles, or an .npy of rays");
  }
  RayTable table = is_text ? load_scan_csv(path) : load_ray_npy(path);
  if (const auto rows = find(field, "rows")) apply_rows(*rows, table);
  if (const auto point = find(field, "point_us")) {
    apply_point_time(number(*point, kTablePoint_us) * kMicrosecond_ns, table);
  }
  return table;
}

Spinning read_ouster(const YamlField& field) {
  require_map(field, {"type", "file"});
  return load_ouster_metadata(path_beside(need(field, "file")));
}

}  // namespace glidar
