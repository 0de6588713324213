// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/opengl/opengl_renderer.hpp>

#include <glidar/core/progress_counter.hpp>
#include <glidar/render/close_triangles.hpp>
#include <glidar/render/hit_writer.hpp>
#include <glidar/render/opengl/draw_state.hpp>
#include <glidar/render/opengl/egl_context.hpp>
#include <glidar/render/opengl/tile_plan.hpp>
#include <glidar/render/opengl/triangle_id_drawing.hpp>
#include <glidar/render/opengl/triangle_id_target.hpp>
#include <glidar/render/pieces_renderer.hpp>
#include <glidar/render/pinhole_only.hpp>
#include <glidar/render/rays/scene_search.hpp>
#include <glidar/render/silhouettes.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace glidar {
namespace {

/// At a time, one batch of tiles is drawn, one is read back, and one is converted to hits.
constexpr std::size_t kTargets = 3;

class OpenglRenderer final : public Renderer {
 public:
  OpenglRenderer(const Scene& scene, const RendererOptions& options,
                 std::unique_ptr<opengl::Context> context)
      : thread_pool_(options.threads),
        resolver_(scene),
        search_(resolver_, thread_pool_),
        context_(std::move(context)) {
    for (const Mesh& mesh : scene.meshes) {
      boxes_.push_back(local_box(mesh));
      edges_.push_back(mesh_edges(mesh));
    }
    close_triangles_.emplace(resolver_, search_.trees(), boxes_, thread_pool_);
    const opengl::ScopedDrawState state(*context_);
    gpu_ = std::make_unique<GpuResources>(scene);
    silhouettes_.emplace(edge_uncertainty_px());
  }

  ~OpenglRenderer() override {
    const opengl::ScopedDrawState state(*context_);
    gpu_.reset();
  }

  [[nodiscard]] std::string_view name() const override { return "opengl"; }
  [[nodiscard]] ThreadPool& thread_pool() override { return thread_pool_; }

  void cast(const CastRequest& request, Hits& hits) override {
    const std::array<Hits*, 1> one = {&hits};
    cast_batch({&request, 1}, one);
  }

  void cast_batch(std::span<const CastRequest> requests, std::span<Hits* const> hits) override {
    check_batch(requests, hits);
    for (const CastRequest& request : requests) {
      check(request, resolver_.scene());
      check_pinhole(request.beams, "opengl");
    }
    tiles_.clear();
    for (std::size_t i = 0; i < requests.size(); ++i) plan(requests[i], i, *hits[i]);
    opengl::group_tiles(tiles_, batches_);
    if (!batches_.empty()) draw_and_write(requests, hits);
  }

 private:
  /// Objects in the memory of the graphics device.
  struct GpuResources {
    explicit GpuResources(const Scene& scene) : drawing(scene) {}
    opengl::TriangleIdDrawing drawing;
    std::array<opengl::TriangleIdTarget, kTargets> targets;
  };

  /// Resizes a cast's hits and adds its tiles, if there is anything to draw.
  void plan(const CastRequest& request, std::size_t cast, Hits& hits) {
    resize(hits, request.beams.size(), request.hit_columns);
    resolver_.set_poses(request.world_from_sensor, request.world_from_instance);
    const DepthRange depths = depths_of(request, resolver_, boxes_);
    if (!depths.is_empty() && request.beams.size() > 0) {
      opengl::add_tiles(request.beams, cast, depths, tiles_);
      return;
    }
    write_misses(request.hit_columns, 0, request.beams.size(), hits);
    if (request.on_tile_done) request.on_tile_done({0, request.beams.size()});
    if (request.progress) request.progress(1.0);
  }

  /// While the hits of one batch are written, the next is copied and the one after it is drawn.
  /// Software drivers draw asynchronously but copy synchronously, so each batch is copied only
  /// after the next one was submitted.
  void draw_and_write(std::span<const CastRequest> requests, std::span<Hits* const> hits) {
    const opengl::ScopedDrawState state(*context_);
    for (std::size_t step = 0; step < batches_.size() + 2; ++step) {
      if (step < batches_.size()) draw(requests, batches_[step], target(step));
      if (step >= 1 && step - 1 < batches_.size()) target(step - 1).start_reading();
      if (step < 2) continue;
      opengl::TriangleIdTarget& done = target(step - 2);
      write(requests, batches_[step - 2], done.triangle_ids(), hits);
      done.end_reading();
    }
    count_.reset();
  }

  opengl::TriangleIdTarget& target(std::size_t batch) { return gpu_->targets[batch % kTargets]; }

  void draw(std::span<const CastRequest> requests, const opengl::TileBatch& batch,
            opengl::TriangleIdTarget& target) {
    target.begin(opengl::size_of(tiles_, batch));
    for (std::uint32_t i = 0; i < batch.count; ++i) {
      const opengl::RenderTile& tile = tiles_[batch.first + i];
      const CastRequest& request = requests[tile.cast];
      resolver_.set_poses(request.world_from_sensor, request.world_from_instance);
      target.draw_into(i);
      gpu_->drawing.draw(request, resolver_, tile.rect, tile.depths);
    }
    glFlush();
  }

  void write(std::span<const CastRequest> requests, const opengl::TileBatch& batch,
             std::span<const std::uint32_t> triangle_ids, std::span<Hits* const> hits) {
    const std::size_t pixels = opengl::size_of(tiles_, batch).pixels();
    for (std::size_t i = 0; i < batch.count; ++i) {
      const opengl::RenderTile& tile = tiles_[batch.first + i];
      const CastRequest& request = requests[tile.cast];
      resolver_.set_poses(request.world_from_sensor, request.world_from_instance);
      find_plane_points(request.beams, points_);
      const bool is_first_part = tile.rect.first_row == 0 && tile.rect.first_col == 0;
      if (is_first_part) count_.emplace(request.progress, request.beams.size());
      search_.prepare(request);
      if (!overlaps_) overlaps_.emplace(resolver_, search_.trees());
      overlaps_->prepare(request);
      close_triangles_->prepare(request, silhouettes_->band_px());
      cast_uncertain_beams(request, tile);
      write_image({.request = request,
                   .resolver = resolver_,
                   .triangles = gpu_->drawing.triangle_ids(),
                   .points = points_,
                   .drawn = tile.rect,
                   .triangle_ids = triangle_ids.subspan(i * pixels, pixels),
                   .written = tile.rect,
                   .hits = *hits[tile.cast],
                   .search = search_.beams(),
                   .overlaps = *overlaps_,
                   .close_triangles = &*close_triangles_,
                   .cast_hits = cast_hits_},
                  thread_pool_, *count_);
      const bool is_last_part = tile.rect.first_row + tile.rect.rows == request.beams.rows &&
                                tile.rect.first_col + tile.rect.cols == request.beams.cols;
      if (is_last_part) count_->finish();
    }
  }

  /// True when surfaces may be so near to the sensor that the near plane clips them, or that
  /// rounding moves them to the other side of the sensor.
  [[nodiscard]] bool is_surface_at_sensor(const CastRequest& request,
                                          const DepthRange& depths) const {
    constexpr double kNearPart =
        0x1p-19;  // several times the smallest ratio of tight_depth_range()
    const double slope = std::max({std::abs(points_.x.front()), std::abs(points_.x.back()),
                                   std::abs(points_.y.front()), std::abs(points_.y.back())});
    if (depths.near_m > kNearPart * depths.far_m) return false;
    const double reach_m = kNearPart * depths.far_m * (1.0 + 2.0 * slope);
    for (std::uint32_t i = 0; i < resolver_.scene().instances.size(); ++i) {
      if (!is_enabled(request, i)) continue;
      const InstanceView& view = resolver_.view(i);
      const Eigen::AlignedBox3d sensor(view.sensor_in_object, view.sensor_in_object);
      if (has_triangle_near(search_.trees().of_instance(i), sensor, reach_m / view.scale)) {
        return true;
      }
    }
    return false;
  }

  /// Casts the beams that the rasterizer cannot decide: those so close to a silhouette that the
  /// driver's rounding may have moved it across them, or all where a surface is at the sensor.
  void cast_uncertain_beams(const CastRequest& request, const opengl::RenderTile& tile) {
    if (is_surface_at_sensor(request, tile.depths)) {
      list_beams(request.beams, tile.rect);
      cast_beams(all_beams_);
    } else {
      cast_beams(silhouettes_->find(request, resolver_, edges_, tile.rect, thread_pool_));
    }
  }

  /// Lists all beams of a rectangle.
  void list_beams(const Beams& beams, const PixelRect& rect) {
    all_beams_.clear();
    for (std::size_t row = rect.first_row; row < rect.first_row + rect.rows; ++row) {
      for (std::size_t col = rect.first_col; col < rect.first_col + rect.cols; ++col) {
        all_beams_.push_back(row * beams.cols + col);
      }
    }
  }

  void cast_beams(const std::vector<std::size_t>& beams) {
    cast_hits_.resize(beams.size());
    constexpr std::size_t kBeamsPerTask = 16;
    thread_pool_.parallel_for(beams.size(), kBeamsPerTask, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        cast_hits_[i] = {beams[i], search_.beams().find(beams[i])};
      }
    });
  }

  /// How far a driver may move an edge: vertices are snapped to its grid along both axes, after
  /// rounding in single precision.
  static double edge_uncertainty_px() {
    constexpr double kMinSilhouette_px = 1.0 / 128.0;
    GLint bits = 0;
    glGetIntegerv(GL_SUBPIXEL_BITS, &bits);
    return std::max(kMinSilhouette_px, std::ldexp(2.0, -bits));
  }

  ThreadPool thread_pool_;
  Resolver resolver_;
  rays::SceneSearch search_;
  std::optional<Overlaps> overlaps_;
  std::optional<CloseTriangles> close_triangles_;
  std::vector<Eigen::AlignedBox3d> boxes_;    ///< per mesh, relative to its origin
  std::vector<std::vector<MeshEdge>> edges_;  ///< per mesh
  std::unique_ptr<opengl::Context> context_;
  std::unique_ptr<GpuResources> gpu_;
  std::vector<opengl::RenderTile> tiles_;  ///< of the current cast_batch()
  std::vector<opengl::TileBatch> batches_;
  std::optional<SilhouettePixels> silhouettes_;
  std::vector<std::size_t> all_beams_;
  std::vector<CastHit> cast_hits_;        ///< of the tile whose hits are written
  PlanePoints points_;                    ///< of the tile whose hits are written
  std::optional<ProgressCounter> count_;  ///< of its cast
};

}  // namespace

std::unique_ptr<Renderer> make_opengl_renderer(const Scene& scene, const RendererOptions& options) {
  validate(scene);
  return make_opengl_renderer(scene, options,
                              std::make_unique<opengl::EglContext>(options.graphics_device));
}

std::unique_ptr<Renderer> make_opengl_renderer(const Scene& scene, const RendererOptions& options,
                                               std::unique_ptr<opengl::Context> context) {
  validate(scene);
  const auto make = [&](const Scene& whole) -> std::unique_ptr<Renderer> {
    return std::make_unique<OpenglRenderer>(whole, options, std::move(context));
  };
  return has_pieces(scene) ? make_pieces_renderer(scene, make) : make(scene);
}

}  // namespace glidar
