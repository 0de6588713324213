// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause

// The presets of Livox sensors with prisms against rows of the manufacturer's own scan tables.
#include <glidar/io/config/sensor_file.hpp>

#include <glidar/math/constants.hpp>
#include <support/preset.hpp>
#include <support/source_folder.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace glidar {
namespace {

constexpr std::int64_t kTableLength_ns = 4'000'000'000;
constexpr double kTolerance_deg = 2e-4;  // the rows are rounded to 1e-4, the fits have below 1e-4

struct TableRow {
  std::size_t row = 0;  ///< of the table, which lists all beams of a firing one after the other
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
};

std::vector<TableRow> rows_of(const std::string& sensor) {
  std::ifstream file(std::string(kSourceFolder) + "/tests/io/config/livox_rows.csv");
  std::vector<TableRow> rows;
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with(sensor + ",")) continue;
    std::istringstream text(line.substr(sensor.size() + 1));
    TableRow row;
    double azimuth_deg = 0.0;
    double elevation_deg = 0.0;
    char comma = 0;
    text >> row.row >> comma >> azimuth_deg >> comma >> elevation_deg;
    row.direction = direction_at(azimuth_deg * kDegree, elevation_deg * kDegree);
    rows.push_back(row);
  }
  return rows;
}

struct LivoxTable {
  const char* sensor;
  std::size_t rows;          ///< in the file of this test
  std::size_t first_firing;  ///< the firing of the table's first rows; most tables begin with the
                             ///< second one
};

void PrintTo(const LivoxTable& table, std::ostream* out) {
  *out << table.sensor;
}

class LivoxTables : public ::testing::TestWithParam<LivoxTable> {};

TEST_P(LivoxTables, HaveTheDirectionsOfThePreset) {
  const auto [sensor, count, first_firing] = GetParam();
  const std::vector<TableRow> rows = rows_of(sensor);
  ASSERT_EQ(rows.size(), count);
  const std::int64_t end_ns = kTableLength_ns + 1'000'000;
  const Beams beams = make_beams(testing::preset(sensor), {0, end_ns});
  for (const TableRow& row : rows) {
    const std::size_t firing = row.row / beams.rows + first_firing;
    const Eigen::Vector3d& d = beams.directions[row.row % beams.rows * beams.cols + firing];
    const double error_deg =
        std::atan2(d.cross(row.direction).norm(), d.dot(row.direction)) / kDegree;
    EXPECT_LT(error_deg, kTolerance_deg) << "row " << row.row;
  }
}

INSTANTIATE_TEST_SUITE_P(Prisms, LivoxTables,
                         ::testing::Values(LivoxTable{"Livox-Mid-40", 60, 1},
                                           LivoxTable{"Livox-Mid-70", 60, 1},
                                           LivoxTable{"Livox-Avia", 144, 0},
                                           LivoxTable{"Livox-Horizon", 144, 1},
                                           LivoxTable{"Livox-Tele-15", 144, 1}),
                         [](const auto& table) {
                           std::string name = table.param.sensor;
                           std::erase(name, '-');
                           return name;
                         });

}  // namespace
}  // namespace glidar
