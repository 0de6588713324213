// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/auto_renderer.hpp>

#include <glidar/render/cpu_base.hpp>
#include <glidar/render/grid_window.hpp>
#include <glidar/render/pinhole_only.hpp>
#include <glidar/render/raster/raster_renderer.hpp>
#include <glidar/render/rays/rays_renderer.hpp>
#include <glidar/render/triangle_ids.hpp>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace glidar {
namespace {

/// The raster processes every triangle in view, a ray only a few: above this many triangles per
/// beam that may hit something, rays are faster (bench/renderers_bench.py: about 10).
constexpr std::uint64_t kMaxPerBeam = 11;

class AutoRenderer final : public Renderer {
 public:
  AutoRenderer(const Scene& scene, unsigned threads)
      : base_(std::make_shared<CpuBase>(scene, threads)) {
    for (const Mesh& mesh : scene.meshes) boxes_.push_back(bounds(mesh));
    std::uint64_t all = 0;
    for (const Instance& instance : scene.instances) {
      all += scene.meshes[instance.mesh].triangles.size();
    }
    can_draw_ = all < kNoTriangleId;
  }

  [[nodiscard]] std::string_view name() const override { return "auto"; }
  [[nodiscard]] ThreadPool& thread_pool() override { return base_->thread_pool; }

  void cast(const CastRequest& request, Hits& hits) override {
    check(request, base_->resolver.scene());
    faster(request).cast(request, hits);
  }

 private:
  Renderer& faster(const CastRequest& request) {
    if (is_for_raster(request)) {
      if (raster_ == nullptr) raster_ = make_raster_renderer(base_);
      return *raster_;
    }
    if (rays_ == nullptr) rays_ = make_rays_renderer(base_);
    return *rays_;
  }

  bool is_for_raster(const CastRequest& request) {
    if (!can_draw_ || rasterizer_limitation(request.beams) != nullptr) return false;
    const std::uint64_t beams = beams_in_view(request);
    return beams == 0 || triangles(request) <= kMaxPerBeam * beams;
  }

  [[nodiscard]] std::uint64_t triangles(const CastRequest& request) const {
    const Scene& scene = base_->resolver.scene();
    std::uint64_t all = 0;
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
      if (is_enabled(request, i)) all += scene.meshes[scene.instances[i].mesh].triangles.size();
    }
    return all;
  }

  /// Number of beams that may hit something.
  std::uint64_t beams_in_view(const CastRequest& request) {
    base_->resolver.set_poses(request.world_from_sensor, request.world_from_instance);
    find_plane_points(request.beams, points_);
    const GridWindow window =
        visible_window(base_->resolver, boxes_, request.instance_enabled, points_);
    const std::uint64_t rows = std::min(window.end_row, request.beams.rows) - window.first_row;
    const std::uint64_t cols = std::min(window.end_col, request.beams.cols) - window.first_col;
    return rows * cols;
  }

  std::shared_ptr<CpuBase> base_;
  std::vector<Eigen::AlignedBox3d> boxes_;  ///< per mesh
  bool can_draw_;                           ///< the triangle ids suffice for all triangles
  PlanePoints points_;
  std::unique_ptr<Renderer> raster_;
  std::unique_ptr<Renderer> rays_;
};

}  // namespace

std::unique_ptr<Renderer> make_auto_renderer(const Scene& scene, const RendererOptions& options) {
  return std::make_unique<AutoRenderer>(scene, options.threads);
}

}  // namespace glidar
