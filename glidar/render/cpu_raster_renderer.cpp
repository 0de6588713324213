// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/cpu_raster_renderer.hpp>

#include <glidar/render/cpu_base.hpp>
#include <glidar/render/pinhole_only.hpp>
#include <glidar/render/raster/raster_renderer.hpp>
#include <glidar/render/rays/rays_renderer.hpp>
#include <glidar/render/scan_raster/scan_renderer.hpp>

namespace glidar {
namespace {

class CpuRasterRenderer final : public Renderer {
 public:
  CpuRasterRenderer(const Scene& scene, unsigned threads)
      : base_(std::make_shared<CpuBase>(scene, threads)) {}

  [[nodiscard]] std::string_view name() const override { return "raster"; }
  [[nodiscard]] ThreadPool& thread_pool() override { return base_->thread_pool; }

  void cast(const CastRequest& request, Hits& hits) override {
    renderer_for(request).cast(request, hits);
  }

 private:
  Renderer& renderer_for(const CastRequest& request) {
    if (!request.targets.empty()) {
      if (rays_ == nullptr) rays_ = make_rays_renderer(base_);
      return *rays_;
    }
    const Beams& beams = request.beams;
    if (rasterizer_limitation(beams) == nullptr) {
      if (pinhole_ == nullptr) pinhole_ = make_raster_renderer(base_);
      return *pinhole_;
    }
    if (scan_ == nullptr) scan_ = std::make_unique<scan_raster::ScanRenderer>(base_);
    return *scan_;
  }

  std::shared_ptr<CpuBase> base_;
  std::unique_ptr<Renderer> pinhole_;
  std::unique_ptr<Renderer> scan_;
  std::unique_ptr<Renderer> rays_;  ///< for beams with targets, which have no grid
};

}  // namespace

std::unique_ptr<Renderer> make_cpu_raster_renderer(const Scene& scene,
                                                   const RendererOptions& options) {
  return std::make_unique<CpuRasterRenderer>(scene, options.threads);
}

}  // namespace glidar
