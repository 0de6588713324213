// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/opengl/opengl_renderer.hpp>

#include <glidar/core/work_count.hpp>
#include <glidar/render/opengl/draw_state.hpp>
#include <glidar/render/opengl/egl_context.hpp>
#include <glidar/render/opengl/number_target.hpp>
#include <glidar/render/opengl/pinhole_only.hpp>
#include <glidar/render/opengl/row_writing.hpp>
#include <glidar/render/opengl/triangle_drawing.hpp>

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

namespace glidar {
namespace {

using opengl::PixelRect;

/// The picture cut into parts, row by row of parts; large pictures fit no target.
std::vector<PixelRect> parts_of(const Beams& beams) {
  constexpr std::uint32_t kSide =
      2048;  // the largest picture that every OpenGL 3.3 draws is 1024..
  std::vector<PixelRect> parts;
  for (std::uint32_t row = 0; row < beams.rows; row += kSide) {
    for (std::uint32_t col = 0; col < beams.cols; col += kSide) {
      parts.push_back(
          {row, col, std::min(kSide, beams.rows - row), std::min(kSide, beams.cols - col)});
    }
  }
  return parts;
}

class OpenglRenderer final : public Renderer {
 public:
  OpenglRenderer(const Scene& scene, const RendererOptions& options,
                 std::unique_ptr<opengl::Context> context)
      : workers_(options.threads),
        resolver_(scene),
        meshes_(scene.meshes.begin(), scene.meshes.end()),
        context_(std::move(context)) {
    const opengl::FreshState state(*context_);
    gpu_ = std::make_unique<OnDevice>(scene);
  }

  ~OpenglRenderer() override {
    const opengl::FreshState state(*context_);
    gpu_.reset();
  }

  [[nodiscard]] std::string_view name() const override { return "opengl"; }
  [[nodiscard]] Workers& workers() override { return workers_; }

  void cast(const CastRequest& request, Hits& hits) override {
    check(request, resolver_.scene());
    opengl::check_pinhole(request.beams);
    resize(hits, request.beams.size(), request.fields);
    resolver_.set_poses(request.world_from_sensor, request.world_from_instance);
    const opengl::DepthRange depths = depths_of(request);
    if (depths.is_empty()) {
      write_misses(request.fields, 0, request.beams.size(), hits);
      if (request.then) request.then({0, request.beams.size()});
      if (request.progress) request.progress(1.0);
      return;
    }
    draw_and_write(request, depths, hits);
  }

 private:
  /// What lives in the graphics device's memory.
  struct OnDevice {
    explicit OnDevice(const Scene& scene) : drawing(scene) {}
    opengl::TriangleDrawing drawing;
    std::array<opengl::NumberTarget, 2> targets;
  };

  /// The planes that hug all instances that are there.
  [[nodiscard]] opengl::DepthRange depths_of(const CastRequest& request) const {
    double nearest_m = std::numeric_limits<double>::infinity();
    double farthest_m = -std::numeric_limits<double>::infinity();
    const Scene& scene = resolver_.scene();
    for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
      if (!opengl::is_present(request, i)) continue;
      opengl::extend_depths(resolver_.view(i), meshes_[scene.instances[i].mesh].box, nearest_m,
                            farthest_m);
    }
    if (!(farthest_m > 0.0)) return {0.0, 0.0};
    return opengl::hugging(nearest_m, farthest_m);
  }

  /// While one part of the picture is read and its hits are written, the next is drawn.
  void draw_and_write(const CastRequest& request, const opengl::DepthRange& depths, Hits& hits) {
    const opengl::FreshState state(*context_);
    const std::vector<PixelRect> parts = parts_of(request.beams);
    const opengl::Settler settler(resolver_, meshes_, request.beams, request.cull_back_faces);
    WorkCount count(request.progress, request.beams.size());
    const auto draw = [&](std::size_t part) {
      opengl::NumberTarget& target = gpu_->targets[part % 2];
      target.begin(parts[part]);
      gpu_->drawing.draw(request, resolver_, parts[part], depths);
      target.start_reading();
    };
    draw(0);
    for (std::size_t part = 0; part < parts.size(); ++part) {
      if (part + 1 < parts.size()) draw(part + 1);
      opengl::NumberTarget& target = gpu_->targets[part % 2];
      const opengl::RowWriting writing{.request = request,
                                       .resolver = resolver_,
                                       .settler = settler,
                                       .drawing = gpu_->drawing,
                                       .rect = parts[part],
                                       .numbers = target.numbers(),
                                       .hits = hits};
      write_rows(writing, workers_, count);
      target.end_reading();
    }
    count.finish();
  }

  Workers workers_;
  Resolver resolver_;
  std::vector<opengl::KnownMesh> meshes_;
  std::unique_ptr<opengl::Context> context_;
  std::unique_ptr<OnDevice> gpu_;
};

}  // namespace

std::unique_ptr<Renderer> make_opengl_renderer(const Scene& scene, const RendererOptions& options) {
  validate(scene);
  return std::make_unique<OpenglRenderer>(
      scene, options, std::make_unique<opengl::EglContext>(options.graphics_device));
}

std::unique_ptr<Renderer> make_opengl_renderer(const Scene& scene, const RendererOptions& options,
                                               std::unique_ptr<opengl::Context> context) {
  validate(scene);
  return std::make_unique<OpenglRenderer>(scene, options, std::move(context));
}

}  // namespace glidar
