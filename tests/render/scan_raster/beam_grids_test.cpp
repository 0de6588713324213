// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Grids are cached for the same beams only.
#include <glidar/render/scan_raster/beam_grids.hpp>

#include <render/scan_raster/scanner.hpp>

namespace glidar::scan_raster {
namespace {

using testing::camera_beams;
using testing::scanner_beams;

TEST(BeamGrids, CachesTheGridsOfAlternatingSensors) {
  ThreadPool thread_pool(1);
  BeamGrids grids;
  const std::vector<Beams> sensors = {scanner_beams({}), camera_beams(64, 48, 50.0),
                                      camera_beams(64, 48, 60.0)};
  std::vector<const BeamGrid*> first;
  for (const Beams& beams : sensors) first.push_back(&grids.of(beams, thread_pool));
  for (std::size_t i = 0; i < 9; ++i) {
    const BeamGrid& grid = grids.of(sensors[i % 3], thread_pool);
    EXPECT_EQ(&grid, first[i % 3]);
    EXPECT_TRUE(grid.has_measured(sensors[i % 3], thread_pool));
  }
}

TEST(BeamGrids, MeasuresAgainWhenOneBitOfABeamChanges) {
  ThreadPool thread_pool(1);
  BeamGrids grids;
  Beams beams = scanner_beams({});
  grids.of(beams, thread_pool);
  for (int k = 0; k < 9; ++k) {
    Eigen::Vector3d& changed = beams.directions[1234];
    changed.z() = std::nextafter(changed.z(), 1.0);
    const BeamGrid& grid = grids.of(beams, thread_pool);
    bool is_found = false;
    for (const SectorTable& sector : grid.sectors()) {
      for (std::size_t cell = 0; cell < sector.start().size(); ++cell) {
        if (sector.start()[cell] < 0.0F || sector.beam(cell) != 1234) continue;
        is_found = sector.exact_direction(2)[cell] == changed.z();
      }
    }
    EXPECT_TRUE(is_found);
  }
}

}  // namespace
}  // namespace glidar::scan_raster
