// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Beams are recognised as grids, and others are not.
#include <glidar/render/scan_raster/beam_grid.hpp>

#include <glidar/io/sensor_file.hpp>
#include <glidar/io/sensor_presets.hpp>
#include <render/scan_raster/scanner.hpp>

#include <limits>
#include <set>

namespace glidar::scan_raster {
namespace {

using testing::Draws;
using testing::Scanner;
using testing::scanner_beams;

BeamGrid grid_of(const Beams& beams) {
  Workers workers(2);
  BeamGrid grid;
  grid.measure(beams, workers);
  return grid;
}

Beams preset_beams(const char* name) {
  return make_beams(load_sensor_file(find_sensor_file(name)));
}

TEST(BeamGrid, TakesSpinningAndLineScannerPresets) {
  for (const char* name : {"VLP-16", "VLP-32C", "HDL-32E", "HDL-64E-S3", "OS1-64", "OS0-128",
                           "Pandar64", "XT32", "UTM-30LX", "TiM781"}) {
    const Beams beams = preset_beams(name);
    EXPECT_TRUE(may_form_grid(beams)) << name;
    EXPECT_EQ(grid_of(beams).misfit(), "") << name;
    EXPECT_TRUE(grid_of(beams).other_rows().empty()) << name;
  }
}

TEST(BeamGrid, RefusesBeamsWithoutRowsOrColumns) {
  Draws draws(1);
  Beams random = scanner_beams({});
  for (Eigen::Vector3d& direction : random.directions) direction = draws.direction();
  for (const Beams& beams : {random, preset_beams("Livox-Mid-40"), preset_beams("Livox-Avia"),
                             testing::camera_beams(320, 240, 150.0)}) {
    EXPECT_FALSE(may_form_grid(beams) && grid_of(beams).misfit().empty());
    EXPECT_NE(grid_of(beams).misfit(), "");
  }
}

TEST(BeamGrid, LeavesSteepRowsToRays) {
  const BeamGrid grid = grid_of(scanner_beams({.rows = 16, .low_rad = -0.2, .high_rad = 1.5}));
  EXPECT_EQ(grid.misfit(), "");
  EXPECT_EQ(grid.other_rows(), (std::vector<std::uint32_t>{0}));
}

TEST(BeamGrid, HasEveryBeamInOneCell) {
  for (const Scanner& scanner :
       {Scanner{}, Scanner{.rows = 8, .stagger_rad = 0.06}, Scanner{.rows = 5, .span_rad = -1.0}}) {
    const Beams beams = scanner_beams(scanner);
    std::set<std::size_t> seen;
    const BeamGrid grid = grid_of(beams);
    for (const SectorTable& sector : grid.sectors()) {
      for (std::size_t cell = 0; cell < sector.start().size(); ++cell) {
        if (sector.start()[cell] < 0.0F) continue;
        const std::size_t beam = sector.beam(cell);
        EXPECT_TRUE(seen.insert(beam).second);
        for (int axis = 0; axis < 3; ++axis) {
          EXPECT_EQ(sector.exact_direction(axis)[cell], beams.directions[beam][axis]);
        }
      }
    }
    EXPECT_EQ(seen.size(), beams.size());
  }
}

/// The bounds of rows and columns hold for the directions themselves.
TEST(BeamGrid, BoundsItsBeams) {
  const Beams beams = scanner_beams({.rows = 33, .cols = 500, .stagger_rad = 0.05, .uneven = 0.8});
  const BeamGrid grid = grid_of(beams);
  const GridView view = grid.view();
  for (const SectorTable& sector : grid.sectors()) {
    for (std::size_t cell = 0; cell < sector.start().size(); ++cell) {
      if (sector.start()[cell] < 0.0F) continue;
      const Eigen::Vector3d d = sector.sector_from_sensor() * beams.directions[sector.beam(cell)];
      const auto row = static_cast<std::int32_t>(cell / view.pitch);
      const double column = std::atan(d.y() / d.x()) * view.columns_per_rad + view.middle_column;
      const double deviation = column - static_cast<double>(cell % view.pitch);
      EXPECT_GE(deviation, view.low_deviation[row]);
      EXPECT_LE(deviation, view.high_deviation[row]);
      EXPECT_LT(std::abs(d.y() / d.x()), view.max_slope);
      EXPECT_GT(d.z() / d.x(), view.lowest_slope);
      EXPECT_LT(d.z() / d.x(), view.highest_slope);
      const double tangent = d.z() / std::hypot(d.x(), d.y());
      const auto bin =
          static_cast<std::size_t>((tangent - view.lowest_tangent) * view.bins_per_tangent);
      EXPECT_LE(view.first_row[bin], row);
      EXPECT_GE(view.last_row[bin], row);
    }
  }
}

TEST(BeamGrid, IsMeasuredAnewWhenOneBitOfABeamChanges) {
  Workers workers(1);
  BeamGrid grid;
  Beams beams = scanner_beams({});
  grid.measure(beams, workers);
  Eigen::Vector3d& changed = beams.directions[1234];
  changed.z() = std::nextafter(changed.z(), 1.0);
  grid.measure(beams, workers);
  bool is_found = false;
  for (const SectorTable& sector : grid.sectors()) {
    for (std::size_t cell = 0; cell < sector.start().size(); ++cell) {
      if (sector.start()[cell] < 0.0F || sector.beam(cell) != 1234) continue;
      is_found = sector.exact_direction(2)[cell] == changed.z();
    }
  }
  EXPECT_TRUE(is_found);
}

}  // namespace
}  // namespace glidar::scan_raster
