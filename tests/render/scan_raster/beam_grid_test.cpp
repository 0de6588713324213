// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Beams are recognised as grids of a scanner or a camera, and others are not.
#include <glidar/render/scan_raster/beam_grid.hpp>

#include <render/scan_raster/scanner.hpp>

#include <set>

namespace glidar::scan_raster {
namespace {

using testing::Draws;
using testing::preset_beams;
using testing::Scanner;
using testing::scanner_beams;

BeamGrid grid_of(const Beams& beams) {
  ThreadPool thread_pool(2);
  BeamGrid grid;
  grid.measure(beams, thread_pool);
  return grid;
}

TEST(BeamGrid, AcceptsSpinningAndLineScannerPresets) {
  for (const char* name : {"VLP-16", "VLP-32C", "HDL-32E", "HDL-64E-S3", "OS1-64", "OS0-128",
                           "Pandar64", "XT32", "UTM-30LX", "TiM781"}) {
    const Beams beams = preset_beams(name);
    EXPECT_TRUE(may_form_grid(beams)) << name;
    EXPECT_EQ(grid_of(beams).misfit(), "") << name;
    EXPECT_TRUE(grid_of(beams).other_rows().empty()) << name;
  }
}

TEST(BeamGrid, RejectsBeamsWithoutRowsOrColumns) {
  Draws draws(1);
  Beams random = scanner_beams({});
  for (Eigen::Vector3d& direction : random.directions) direction = draws.direction();
  for (const Beams& beams : {random, preset_beams("Livox-Mid-40"), preset_beams("Livox-Avia")}) {
    EXPECT_FALSE(may_form_grid(beams) && grid_of(beams).misfit().empty());
    EXPECT_NE(grid_of(beams).misfit(), "");
  }
}

TEST(BeamGrid, AcceptsCamerasWithAllLenses) {
  for (const char* name : {"Azure-Kinect-NFOV", "Azure-Kinect-NFOV-2x2", "Azure-Kinect-WFOV",
                           "Azure-Kinect-WFOV-2x2", "Kinect-v2", "D435"}) {
    const Beams beams = preset_beams(name);
    EXPECT_TRUE(may_form_grid(beams)) << name;
    const BeamGrid grid = grid_of(beams);
    EXPECT_EQ(grid.misfit(), "") << name;
    EXPECT_TRUE(grid.is_camera()) << name;
    for (std::size_t i = 0; i < grid.sectors().size(); ++i) EXPECT_TRUE(grid.is_drawn(i)) << name;
  }
}

TEST(BeamGrid, RejectsCamerasWithoutASmoothImage) {
  Draws draws(1);
  Beams random = testing::camera_beams(64, 48, 50.0);
  random.pinhole.reset();
  for (Eigen::Vector3d& direction : random.directions) direction = draws.direction();
  Beams with_origins = testing::camera_beams(64, 48, 50.0);
  with_origins.origins_m.assign(with_origins.size(), Eigen::Vector3d::UnitX());
  for (const Beams& beams : {random, with_origins, testing::camera_beams(640, 1, 500.0)}) {
    EXPECT_FALSE(may_form_grid(beams));
    EXPECT_NE(grid_of(beams).misfit(), "");
  }
}

TEST(BeamGrid, LeavesSteepRowsToRays) {
  const BeamGrid grid = grid_of(scanner_beams({.rows = 16, .low_rad = -0.2, .high_rad = 1.5}));
  EXPECT_EQ(grid.misfit(), "");
  EXPECT_EQ(grid.other_rows(), (std::vector<std::uint32_t>{0}));
}

TEST(BeamGrid, HasEveryBeamInOneCell) {
  for (const Beams& beams :
       {scanner_beams({}), scanner_beams({.rows = 8, .stagger_rad = 0.06}),
        scanner_beams({.rows = 5, .span_rad = -1.0}), testing::camera_beams(201, 133, 150.0)}) {
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

/// Expects a direction in the frame of its sector within the bounds of its cell; returns the row.
/// `across` is its coordinate along the row.
std::int32_t expect_in_bounds(const GridView& view, std::size_t cell, const Eigen::Vector3d& d,
                              double across) {
  const auto row = static_cast<std::int32_t>(cell / view.pitch);
  const double column = across * view.columns_per_unit + view.middle_column;
  const double deviation = column - static_cast<double>(cell % view.pitch);
  EXPECT_GE(deviation, view.low_deviation[row]);
  EXPECT_LE(deviation, view.high_deviation[row]);
  EXPECT_LT(std::abs(d.y() / d.x()), view.max_slope);
  EXPECT_GT(d.z() / d.x(), view.lowest_slope);
  EXPECT_LT(d.z() / d.x(), view.highest_slope);
  return row;
}

/// The bounds of rows and columns hold for the directions themselves.
TEST(BeamGrid, BoundsTheBeamsOfAScanner) {
  const Beams beams = scanner_beams({.rows = 33, .cols = 500, .stagger_rad = 0.05, .uneven = 0.8});
  const BeamGrid grid = grid_of(beams);
  const GridView view = grid.view(0);
  for (const SectorTable& sector : grid.sectors()) {
    for (std::size_t cell = 0; cell < sector.start().size(); ++cell) {
      if (sector.start()[cell] < 0.0F) continue;
      const Eigen::Vector3d d =
          sector.frame().sector_from_sensor * beams.directions[sector.beam(cell)];
      const std::int32_t row = expect_in_bounds(view, cell, d, std::atan(d.y() / d.x()));
      const double tangent = d.z() / std::hypot(d.x(), d.y());
      const ElevationRows& rows = view.elevations;
      const auto bin =
          static_cast<std::size_t>((tangent - rows.lowest_tangent) * rows.bins_per_tangent);
      EXPECT_LE(rows.first_row[bin], row);
      EXPECT_GE(rows.last_row[bin], row);
    }
  }
}

/// The same for the slopes of a camera.
TEST(BeamGrid, BoundsTheBeamsOfACamera) {
  const Beams beams = preset_beams("Azure-Kinect-WFOV-2x2");
  const BeamGrid grid = grid_of(beams);
  for (std::size_t i = 0; i < grid.sectors().size(); ++i) {
    const SectorTable& sector = grid.sectors()[i];
    const GridView view = grid.view(i);
    for (std::size_t cell = 0; cell < sector.start().size(); ++cell) {
      if (sector.start()[cell] < 0.0F) continue;
      const Eigen::Vector3d d =
          sector.frame().slopes_from_sensor * beams.directions[sector.beam(cell)];
      const std::int32_t row = expect_in_bounds(view, cell, d, d.y() / d.x());
      EXPECT_LE(d.z() / d.x() * view.slopes.rows_per_slope + view.slopes.first_row, row);
      EXPECT_GE(d.z() / d.x() * view.slopes.rows_per_slope + view.slopes.last_row, row);
    }
  }
}

/// Each block is nearly a pinhole camera, so that what covers few pixels is tested with few beams.
TEST(BeamGrid, HasNarrowBoundsForCameras) {
  for (const char* name :
       {"Azure-Kinect-NFOV", "Azure-Kinect-WFOV", "Azure-Kinect-WFOV-2x2", "Kinect-v2", "D435"}) {
    const BeamGrid grid = grid_of(preset_beams(name));
    double columns = 0.0;
    double rows = 0.0;
    for (std::size_t i = 0; i < grid.sectors().size(); ++i) {
      const GridView view = grid.view(i);
      columns += view.max_deviation - view.min_deviation;
      rows += view.slopes.last_row - view.slopes.first_row;
    }
    const auto sectors = static_cast<double>(grid.sectors().size());
    EXPECT_LT(columns / sectors, 1.0) << name;
    EXPECT_LT(rows / sectors, 1.0) << name;
  }
}

}  // namespace
}  // namespace glidar::scan_raster
