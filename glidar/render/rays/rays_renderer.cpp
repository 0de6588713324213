// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/rays/rays_renderer.hpp>

#include <glidar/render/rays/footprint_search.hpp>
#include <glidar/render/rays/tile_cast.hpp>

#include <utility>

namespace glidar {
namespace {

class RaysRenderer final : public Renderer {
 public:
  explicit RaysRenderer(std::shared_ptr<CpuBase> base) : base_(std::move(base)), tiles_(*base_) {}

  [[nodiscard]] std::string_view name() const override { return "rays"; }
  [[nodiscard]] ThreadPool& thread_pool() override { return base_->thread_pool; }

  void cast(const CastRequest& request, Hits& hits) override {
    if (!tiles_.prepare(request, hits)) return;
    const rays::FootprintSearch footprints(base_->search.beams());
    if (!footprints.is_useful()) return tiles_.cast(request, {}, hits);
    const std::size_t size = request.footprints.beams;
    const auto find = [&](BeamRange beams) {  // footprints are in one row
      footprints.find({beams.begin / size, beams.end / size}, hits);
    };
    tiles_.cast(
        request,
        {.find = FunctionRef<void(BeamRange)>(find), .beams_at_once = request.footprints.beams},
        hits);
  }

 private:
  std::shared_ptr<CpuBase> base_;
  rays::TileCast tiles_;
};

}  // namespace

std::unique_ptr<Renderer> make_rays_renderer(const Scene& scene, const RendererOptions& options) {
  return make_rays_renderer(std::make_shared<CpuBase>(scene, options.threads));
}

std::unique_ptr<Renderer> make_rays_renderer(std::shared_ptr<CpuBase> base) {
  return std::make_unique<RaysRenderer>(std::move(base));
}

}  // namespace glidar
