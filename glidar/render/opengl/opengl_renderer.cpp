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

/// One picture is drawn, one copied and one worked out at a time.
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
    sheets_.emplace(resolver_, search_.trees(), boxes_, thread_pool_);
    const opengl::FreshState state(*context_);
    gpu_ = std::make_unique<OnDevice>(scene);
    silhouettes_.emplace(doubt_px());
  }

  ~OpenglRenderer() override {
    const opengl::FreshState state(*context_);
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
    pictures_.clear();
    for (std::size_t i = 0; i < requests.size(); ++i) plan(requests[i], i, *hits[i]);
    opengl::group(pictures_, groups_);
    if (!groups_.empty()) draw_and_write(requests, hits);
  }

 private:
  /// What lives in the graphics device's memory.
  struct OnDevice {
    explicit OnDevice(const Scene& scene) : drawing(scene) {}
    opengl::TriangleDrawing drawing;
    std::array<opengl::NumberTarget, kTargets> targets;
  };

  /// Makes room for a cast's hits and adds its pictures, if there is anything to draw.
  void plan(const CastRequest& request, std::size_t cast, Hits& hits) {
    resize(hits, request.beams.size(), request.fields);
    resolver_.set_poses(request.world_from_sensor, request.world_from_instance);
    const DepthRange depths = depths_of(request, resolver_, boxes_);
    if (!depths.is_empty() && request.beams.size() > 0) {
      opengl::add_parts(request.beams, cast, depths, pictures_);
      return;
    }
    write_misses(request.fields, 0, request.beams.size(), hits);
    if (request.on_tile_done) request.on_tile_done({0, request.beams.size()});
    if (request.progress) request.progress(1.0);
  }

  /// While the hits of one group of pictures are written, the next is copied and the one after it
  /// is drawn. A driver in software draws behind our back but copies before our eyes: so each is
  /// copied only after the next was given to draw.
  void draw_and_write(std::span<const CastRequest> requests, std::span<Hits* const> hits) {
    const opengl::FreshState state(*context_);
    for (std::size_t step = 0; step < groups_.size() + 2; ++step) {
      if (step < groups_.size()) draw(requests, groups_[step], target(step));
      if (step >= 1 && step - 1 < groups_.size()) target(step - 1).start_reading();
      if (step < 2) continue;
      opengl::NumberTarget& done = target(step - 2);
      write(requests, groups_[step - 2], done.numbers(), hits);
      done.end_reading();
    }
    count_.reset();
  }

  opengl::NumberTarget& target(std::size_t group) { return gpu_->targets[group % kTargets]; }

  void draw(std::span<const CastRequest> requests, const opengl::PictureGroup& group,
            opengl::NumberTarget& target) {
    target.begin(opengl::size_of(pictures_, group));
    for (std::uint32_t i = 0; i < group.count; ++i) {
      const opengl::Picture& picture = pictures_[group.first + i];
      const CastRequest& request = requests[picture.cast];
      resolver_.set_poses(request.world_from_sensor, request.world_from_instance);
      target.draw_into(i);
      gpu_->drawing.draw(request, resolver_, picture.rect, picture.depths);
    }
    glFlush();
  }

  void write(std::span<const CastRequest> requests, const opengl::PictureGroup& group,
             std::span<const std::uint32_t> numbers, std::span<Hits* const> hits) {
    const std::size_t pixels = opengl::size_of(pictures_, group).pixels();
    for (std::size_t i = 0; i < group.count; ++i) {
      const opengl::Picture& picture = pictures_[group.first + i];
      const CastRequest& request = requests[picture.cast];
      resolver_.set_poses(request.world_from_sensor, request.world_from_instance);
      find_plane_points(request.beams, points_);
      const bool is_first_part = picture.rect.first_row == 0 && picture.rect.first_col == 0;
      if (is_first_part) count_.emplace(request.progress, request.beams.size());
      search_.prepare(request);
      if (!overlaps_) overlaps_.emplace(resolver_, search_.trees());
      overlaps_->prepare(request);
      sheets_->prepare(request, silhouettes_->band_px());
      search_known(request, picture);
      write_picture({.request = request,
                     .resolver = resolver_,
                     .triangles = gpu_->drawing.numbers(),
                     .points = points_,
                     .drawn = picture.rect,
                     .numbers = numbers.subspan(i * pixels, pixels),
                     .part = picture.rect,
                     .hits = *hits[picture.cast],
                     .search = search_.beams(),
                     .overlaps = *overlaps_,
                     .sheets = &*sheets_,
                     .known = known_},
                    thread_pool_, *count_);
      const bool is_last_part = picture.rect.first_row + picture.rect.rows == request.beams.rows &&
                                picture.rect.first_col + picture.rect.cols == request.beams.cols;
      if (is_last_part) count_->finish();
    }
  }

  /// True when surfaces may be so near to the sensor that the picture's nearest plane cuts them
  /// off, or that rounding moves them to the other side of the sensor.
  [[nodiscard]] bool is_something_at_sensor(const CastRequest& request,
                                            const DepthRange& depths) const {
    constexpr double kNearPart = 0x1p-19;  // some times hugging()'s least part
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

  /// Decides the beams for which the picture does not do: those that pass a silhouette so closely
  /// that the driver's rounding may have moved it over them, or all where something is right at the
  /// sensor.
  void search_known(const CastRequest& request, const opengl::Picture& picture) {
    if (is_something_at_sensor(request, picture.depths)) {
      list_beams(request.beams, picture.rect);
      search_beams(all_beams_);
    } else {
      search_beams(silhouettes_->find(request, resolver_, edges_, picture.rect, thread_pool_));
    }
  }

  /// All of a part of the picture.
  void list_beams(const Beams& beams, const PixelRect& part) {
    all_beams_.clear();
    for (std::size_t row = part.first_row; row < part.first_row + part.rows; ++row) {
      for (std::size_t col = part.first_col; col < part.first_col + part.cols; ++col) {
        all_beams_.push_back(row * beams.cols + col);
      }
    }
  }

  void search_beams(const std::vector<std::size_t>& beams) {
    known_.resize(beams.size());
    constexpr std::size_t kBeamsPerTask = 16;
    thread_pool_.parallel_for(beams.size(), kBeamsPerTask, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        known_[i] = {beams[i], search_.beams().find(beams[i])};
      }
    });
  }

  /// How far a driver may move a border: corners are rounded to its grid, both across and along,
  /// and rounded in single precision before.
  static double doubt_px() {
    constexpr double kMinSilhouette_px = 1.0 / 128.0;
    GLint bits = 0;
    glGetIntegerv(GL_SUBPIXEL_BITS, &bits);
    return std::max(kMinSilhouette_px, std::ldexp(2.0, -bits));
  }

  ThreadPool thread_pool_;
  Resolver resolver_;
  rays::SceneSearch search_;
  std::optional<Overlaps> overlaps_;
  std::optional<CloseSheets> sheets_;
  std::vector<Eigen::AlignedBox3d> boxes_;    ///< per mesh, relative to its origin
  std::vector<std::vector<MeshEdge>> edges_;  ///< per mesh
  std::unique_ptr<opengl::Context> context_;
  std::unique_ptr<OnDevice> gpu_;
  std::vector<opengl::Picture> pictures_;  ///< of the batch under way
  std::vector<opengl::PictureGroup> groups_;
  std::optional<SilhouettePixels> silhouettes_;
  std::vector<std::size_t> all_beams_;
  std::vector<KnownHit> known_;           ///< of the picture whose hits are written
  PlanePoints points_;                    ///< of the picture whose hits are written
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
