// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/error.hpp>
#include <glidar/render/opengl/draw_state.hpp>
#include <glidar/render/opengl/egl_context.hpp>
#include <glidar/render/opengl/woods2016_drawing.hpp>
#include <glidar/render/pieces_renderer.hpp>
#include <glidar/render/pinhole_only.hpp>
#include <glidar/render/visible_depths.hpp>
#include <glidar/render/woods2016_camera.hpp>

#include <memory>
#include <utility>

namespace glidar {
namespace {

class OpenglWoods2016Camera final : public Woods2016Camera {
 public:
  OpenglWoods2016Camera(const Scene& scene, const RendererOptions& options,
                        std::unique_ptr<opengl::Context> context)
      : thread_pool_(options.threads), resolver_(scene), context_(std::move(context)) {
    const opengl::ScopedDrawState state(*context_);
    gpu_ = std::make_unique<GpuResources>(scene);
  }

  ~OpenglWoods2016Camera() override {
    const opengl::ScopedDrawState state(*context_);
    gpu_.reset();
  }

  void draw(const CastRequest& request, const PhongHeadlight& light,
            const std::optional<Woods2016DepthPlanes>& planes,
            Woods2016Framebuffer& framebuffer) override {
    check(request, resolver_.scene());
    check_pinhole(request.beams, "opengl");
    resolver_.set_poses(request.world_from_sensor, request.world_from_instance);
    framebuffer.rows = request.beams.rows;
    framebuffer.cols = request.beams.cols;
    const Woods2016DepthPlanes used = planes ? *planes : tight_depth_planes(request);
    framebuffer.near_m = used.near_m;
    framebuffer.far_m = used.far_m;
    if (!(used.far_m > used.near_m)) {
      framebuffer.rgba.assign(std::size_t{4} * framebuffer.rows * framebuffer.cols, 0);
      return;
    }
    const opengl::ScopedDrawState state(*context_);
    gpu_->target.begin(framebuffer.rows, framebuffer.cols);
    gpu_->drawing.draw(request, resolver_,
                       {.pinhole = *request.beams.pinhole,
                        .light = light,
                        .planes = used,
                        .depths = tight_depth_range(used.near_m, used.far_m)});
    gpu_->target.read(framebuffer.rgba);
  }

 private:
  /// Objects in the memory of the graphics device.
  struct GpuResources {
    explicit GpuResources(const Scene& scene) : drawing(scene) {}
    opengl::Woods2016Drawing drawing;
    opengl::Woods2016Target target;
  };

  /// Section 2.3 of the paper: planes tightly around the visible surfaces.
  [[nodiscard]] Woods2016DepthPlanes tight_depth_planes(const CastRequest& request) {
    const Scene& scene = resolver_.scene();
    DepthSpan span;
    for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
      if (!is_enabled(request, i)) continue;
      span.extend(visible_depths_.of(resolver_.view(i), resolver_.mesh(i), *request.beams.pinhole,
                                     thread_pool_));
    }
    // A surface across the boresight has one depth; the planes must not coincide.
    constexpr double kMinGap = 1e-6;
    const double margin = kMinGap * span.farthest_m - (span.farthest_m - span.nearest_m);
    if (margin > 0.0) return {span.nearest_m - 0.5 * margin, span.farthest_m + 0.5 * margin};
    return {span.nearest_m, span.farthest_m};
  }

  ThreadPool thread_pool_;
  Resolver resolver_;
  VisibleDepths visible_depths_;
  std::unique_ptr<opengl::Context> context_;
  std::unique_ptr<GpuResources> gpu_;
};

}  // namespace

std::unique_ptr<Woods2016Camera> make_woods2016_camera(const Scene& scene,
                                                       const RendererOptions& options) {
  validate(scene);
  return make_woods2016_camera(scene, options,
                               std::make_unique<opengl::EglContext>(options.graphics_device));
}

std::unique_ptr<Woods2016Camera> make_woods2016_camera(const Scene& scene,
                                                       const RendererOptions& options,
                                                       std::unique_ptr<opengl::Context> context) {
  validate(scene);
  const auto make = [&](const Scene& whole) -> std::unique_ptr<Woods2016Camera> {
    return std::make_unique<OpenglWoods2016Camera>(whole, options, std::move(context));
  };
  return has_pieces(scene) ? make_pieces_camera(scene, make) : make(scene);
}

}  // namespace glidar
