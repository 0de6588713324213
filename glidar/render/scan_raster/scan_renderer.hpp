// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/cpu_base.hpp>
#include <glidar/render/renderer.hpp>
#include <glidar/render/scan_raster/beam_grids.hpp>
#include <glidar/render/scan_raster/instance_slots.hpp>
#include <glidar/render/scan_raster/kernels.hpp>

#include <memory>

namespace glidar::scan_raster {

/// Rasterises the beams of scanners and of cameras with any lens, see docs/scan-raster.md: the same
/// bits as rays. Throws Error for beams that form no grid.
class ScanRenderer final : public Renderer {
 public:
  explicit ScanRenderer(std::shared_ptr<CpuBase> base);
  ~ScanRenderer() override;

  [[nodiscard]] std::string_view name() const override { return "raster"; }
  [[nodiscard]] ThreadPool& thread_pool() override { return base_->thread_pool; }
  void cast(const CastRequest& request, Hits& hits) override;

  /// As cast(), if grid_of() was just called for the beams and they form a grid, some instance is
  /// enabled, and the resolver and the search of the base have the cast's poses.
  void cast_prepared(const CastRequest& request, Hits& hits);

  /// The grid of the beams, valid until the next call.
  const BeamGrid& grid_of(const Beams& beams);

 private:
  class SectorScratchPool;

  /// Calls body(i, scratch) for each piece, on all threads.
  template <class Body>
  void for_each(std::size_t pieces, const Body& body);

  std::shared_ptr<CpuBase> base_;
  const Kernel& kernel_ = find_kernel(rays::select_kernel().name);
  BeamGrids grids_;
  const BeamGrid* grid_ = nullptr;  ///< of the last grid_of()
  InstanceSlots slots_;
  std::unique_ptr<SectorScratchPool> scratch_pool_;
};

}  // namespace glidar::scan_raster
