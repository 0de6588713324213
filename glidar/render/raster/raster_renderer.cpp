// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/cpu_base.hpp>

#include <glidar/core/report.hpp>
#include <glidar/render/grid_window.hpp>
#include <glidar/render/hit_writer.hpp>
#include <glidar/render/pinhole_only.hpp>
#include <glidar/render/raster/cluster_drawing.hpp>
#include <glidar/render/raster/packed_mesh.hpp>
#include <glidar/render/rays/tile_cast.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

namespace glidar {

/// Workspaces that threads acquire and release; they are kept for later casts.
template <class T>
class WorkspacePool {
 public:
  std::unique_ptr<T> acquire() {
    const std::scoped_lock lock(mutex_);
    if (free_.empty()) return std::make_unique<T>();
    std::unique_ptr<T> taken = std::move(free_.back());
    free_.pop_back();
    return taken;
  }
  void release(std::unique_ptr<T> taken) {
    const std::scoped_lock lock(mutex_);
    free_.push_back(std::move(taken));
  }

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<T>> free_;
};

namespace {

using raster::DrawContext;
using raster::VisibleCluster;

/// Workspace of one thread.
struct TileScratch {
  raster::TileBuffer buffer;
  std::vector<std::uint32_t> triangle_ids;
  std::vector<std::uint64_t> order;  ///< keys of the clusters, nearest first
};

constexpr std::size_t kPrefetchDistance = 3;  // clusters that are prefetched

/// The part of a cluster's bounds within a tile.
raster::PixelBounds bounds_in(const PixelRect& drawn, const VisibleCluster& cluster) {
  const auto first_col = static_cast<int>(drawn.first_col);
  const auto first_row = static_cast<int>(drawn.first_row);
  return {.left = std::max(cluster.left - first_col, 0),
          .right = std::min(cluster.right - first_col, static_cast<int>(drawn.cols) - 1),
          .top = std::max(cluster.top - first_row, 0),
          .bottom = std::min(cluster.bottom - first_row, static_cast<int>(drawn.rows) - 1)};
}

raster::PixelPosition first_of(const raster::Tile& tile) {
  return {.col = static_cast<std::int32_t>(tile.drawn.first_col),
          .row = static_cast<std::int32_t>(tile.drawn.first_row)};
}

/// Sort key: nearest first, then by index.
std::uint64_t key(const VisibleCluster& cluster, std::uint32_t index) {
  // Bit patterns of positive floats are ordered as their values.
  const std::uint32_t nearness = std::bit_cast<std::uint32_t>(std::max(cluster.nearness, 0.0F));
  return std::uint64_t{~nearness} << 32U | index;
}

class RasterRenderer final : public Renderer {
 public:
  explicit RasterRenderer(std::shared_ptr<CpuBase> base)
      : base_(std::move(base)), triangles_(scene()), rays_(*base_) {
    for (std::size_t i = 0; i < scene().meshes.size(); ++i) {
      const Mesh& mesh = scene().meshes[i];
      packed_.emplace_back(mesh, base_->resolver.distinct(i));
      boxes_.push_back(bounds(mesh));
      local_boxes_.push_back(local_box(mesh));
    }
    for (const Instance& instance : scene().instances) {
      has_alpha_mask_.push_back(static_cast<std::uint8_t>(has_mask(scene(), instance)));
    }
  }

  [[nodiscard]] std::string_view name() const override { return "raster"; }
  [[nodiscard]] ThreadPool& thread_pool() override { return base_->thread_pool; }

  void cast(const CastRequest& request, Hits& hits) override {
    check(request, scene());
    check_pinhole(request.beams, "raster");
    resize(hits, request.beams.size(), request.hit_columns);
    base_->resolver.set_poses(request.world_from_sensor, request.world_from_instance);
    base_->search.prepare(request);
    if (is_on_surface(request)) {
      if (rays_.prepare(request, hits)) rays_.cast(request, {}, hits);
      return;
    }
    base_->resolver.use_stored_planes(request.hit_columns, base_->thread_pool);
    if (!overlaps_) overlaps_.emplace(base_->resolver, base_->search.trees());
    overlaps_->prepare(request);
    find_plane_points(request.beams, points_);
    ProgressCounter count(request.progress, request.beams.size());
    const DepthRange depths = depths_of(request, base_->resolver, local_boxes_);
    const GridWindow window = depths.is_empty() ? GridWindow{.end_row = 0, .end_col = 0}
                                                : visible_window(base_->resolver, boxes_,
                                                                 request.instance_enabled, points_);
    write_around(request, window, count, hits);
    if (!depths.is_empty() && window.first_row < window.end_row &&
        window.first_col < window.end_col) {
      draw(request, window, depths, count, hits);
    }
    count.finish();
  }

 private:
  [[nodiscard]] const Scene& scene() const { return base_->resolver.scene(); }

  /// True where rounding may move a surface to the other side of the sensor, so that the hit rule
  /// has to decide whether beams hit it. The set-up of triangles is accurate to some 2^-50 of the
  /// distance of their corners.
  [[nodiscard]] bool is_on_surface(const CastRequest& request) const {
    constexpr double kRounding = 0x1p-40;
    for (std::uint32_t i = 0; i < scene().instances.size(); ++i) {
      if (!is_enabled(request, i)) continue;
      const Eigen::AlignedBox3d& box = local_boxes_[scene().instances[i].mesh];
      const Eigen::Vector3d& sensor = base_->resolver.view(i).sensor_in_object;
      if (box.isEmpty()) continue;
      const double reach = kRounding * ((box.center() - sensor).norm() + box.sizes().norm());
      if (box.squaredExteriorDistance(sensor) > reach * reach) continue;
      const rays::MeshTree& tree = base_->search.trees().of_instance(i);
      if (rays::may_touch_triangle(tree, sensor, reach)) return true;
    }
    return false;
  }

  [[nodiscard]] const raster::PackedMesh& packed_of(std::uint32_t instance) const {
    return packed_[scene().instances[instance].mesh];
  }

  /// Writes misses outside of the window.
  void write_around(const CastRequest& request, const GridWindow& window, ProgressCounter& count,
                    Hits& hits) {
    const std::uint32_t cols = request.beams.cols;
    const auto miss = [&](std::size_t begin, std::size_t end) {
      if (begin >= end) return;
      write_misses(request.hit_columns, begin, end - begin, hits);
      if (request.on_tile_done) request.on_tile_done({begin, end});
      count.add(end - begin);
    };
    const auto miss_row = [&](std::size_t row) {
      const bool is_outside = row >= window.first_row && row < window.end_row;
      const std::size_t first = row * cols;
      miss(first, first + (is_outside ? std::min(window.first_col, cols) : cols));
      if (is_outside) miss(first + std::min(window.end_col, cols), first + cols);
    };
    constexpr std::size_t kRowsPerTask = 4;
    base_->thread_pool.parallel_for(request.beams.rows, kRowsPerTask,
                                    [&](std::size_t begin, std::size_t end) {
                                      for (std::size_t row = begin; row < end; ++row) miss_row(row);
                                    });
  }

  void find_visible_clusters(const CastRequest& request, const GridWindow& window,
                             const raster::Nearness& nearness) {
    constexpr std::uint32_t kClustersPerRange = 1024;
    views_.clear();
    ranges_.clear();
    for (std::uint32_t i = 0; i < scene().instances.size(); ++i) {
      views_.push_back(raster::pixel_view(base_->resolver.view(i), *request.beams.pinhole));
      const auto clusters =
          static_cast<std::uint32_t>(is_enabled(request, i) ? packed_of(i).clusters : 0);
      for (std::uint32_t first = 0; first < clusters; first += kClustersPerRange) {
        ranges_.push_back({i, first, std::min(first + kClustersPerRange, clusters)});
      }
    }
    range_clusters_.resize(std::max(range_clusters_.size(), ranges_.size()));
    base_->thread_pool.parallel_for(ranges_.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const raster::ClusterRange& range = ranges_[i];
        range_clusters_[i].clear();
        raster::add_visible_clusters(views_[range.instance], nearness, window,
                                     packed_of(range.instance), range, range_clusters_[i]);
      }
    });
    visible_clusters_.clear();
    for (std::size_t i = 0; i < ranges_.size(); ++i) {
      visible_clusters_.insert(visible_clusters_.end(), range_clusters_[i].begin(),
                               range_clusters_[i].end());
    }
  }

  void draw(const CastRequest& request, GridWindow window, const DepthRange& depths,
            ProgressCounter& count, Hits& hits) {
    window.end_row = std::min(window.end_row, request.beams.rows);
    window.end_col = std::min(window.end_col, request.beams.cols);
    const raster::Nearness nearness(depths);
    find_visible_clusters(request, window, nearness);
    tiles_.build(window, request.beams.rows, request.beams.cols);
    tiles_.bin_clusters(visible_clusters_);
    const DrawContext context{.request = request,
                              .resolver = base_->resolver,
                              .meshes = packed_,
                              .views = views_,
                              .triangles = triangles_,
                              .has_mask = has_alpha_mask_,
                              .nearness = nearness};
    base_->thread_pool.parallel_for(tiles_.size(), 1, [&](std::size_t begin, std::size_t end) {
      std::unique_ptr<TileScratch> scratch = scratch_pool_.acquire();
      for (std::size_t i = begin; i < end; ++i) {
        const raster::Tile tile = tiles_.tile(i);
        draw_tile(context, tile, tiles_.clusters_in(i), *scratch);
        write_tile(context, tile, *scratch, hits);
        count.add(std::size_t{tile.written.rows} * tile.written.cols);
      }
      scratch_pool_.release(std::move(scratch));
    });
  }

  /// Converts a drawn tile to hits.
  void write_tile(const DrawContext& context, const raster::Tile& tile, const TileScratch& scratch,
                  Hits& hits) const {
    write_rows({.request = context.request,
                .resolver = base_->resolver,
                .triangles = triangles_,
                .points = points_,
                .drawn = tile.drawn,
                .triangle_ids = scratch.triangle_ids,
                .written = tile.written,
                .hits = hits,
                .search = base_->search.beams(),
                .overlaps = *overlaps_},
               0, tile.written.rows);
  }

  /// For clusters that reach the sensor's plane, whose bounds are the whole image.
  [[nodiscard]] bool is_outside(const VisibleCluster& cluster, const PixelRect& drawn) const {
    if (!std::isinf(cluster.nearness)) return false;
    const auto left = static_cast<int>(drawn.first_col);
    const auto top = static_cast<int>(drawn.first_row);
    return raster::is_outside(views_[cluster.instance],
                              packed_of(cluster.instance).boxes[cluster.cluster / kLanes],
                              cluster.cluster % kLanes,
                              {left, left + static_cast<int>(drawn.cols) - 1, top,
                               top + static_cast<int>(drawn.rows) - 1});
  }

  [[nodiscard]] const VisibleCluster& cluster_at(std::uint64_t key) const {
    return visible_clusters_[static_cast<std::uint32_t>(key)];
  }

  /// Draws the clusters in a tile, nearest first, except for occluded ones.
  void draw_tile(const DrawContext& context, const raster::Tile& tile,
                 std::span<const std::uint32_t> visible, TileScratch& scratch) const {
    const auto cols = static_cast<int>(tile.drawn.cols);
    const auto rows = static_cast<int>(tile.drawn.rows);
    scratch.buffer.clear(cols, rows, static_cast<float>(context.nearness.factor));
    scratch.order.clear();
    for (const std::uint32_t index : visible)
      scratch.order.push_back(key(visible_clusters_[index], index));
    std::sort(scratch.order.begin(), scratch.order.end());
    // Clusters are scattered in memory, so visible ones are prefetched.
    std::array<const VisibleCluster*, kPrefetchDistance> coming{};
    for (std::size_t i = 0; i < scratch.order.size() + kPrefetchDistance; ++i) {
      const VisibleCluster*& slot = coming[i % kPrefetchDistance];
      if (slot != nullptr) {
        raster::draw_cluster(context, *slot, first_of(tile), scratch.buffer);
        scratch.buffer.mark_stale(bounds_in(tile.drawn, *slot));
      }
      slot = nullptr;
      if (i >= scratch.order.size()) continue;
      if (i + kPrefetchDistance < scratch.order.size()) {
        __builtin_prefetch(&cluster_at(scratch.order[i + kPrefetchDistance]));
      }
      const VisibleCluster& cluster = cluster_at(scratch.order[i]);
      const raster::PixelBounds rect = bounds_in(tile.drawn, cluster);
      if (rect.left > rect.right || rect.top > rect.bottom) continue;
      if (scratch.buffer.is_occluded(rect, cluster.nearness) || is_outside(cluster, tile.drawn))
        continue;
      raster::prefetch(context, cluster);
      slot = &cluster;
    }
    scratch.buffer.copy_triangle_ids(scratch.triangle_ids);
  }

  std::shared_ptr<CpuBase> base_;
  std::vector<raster::PackedMesh> packed_;
  TriangleIds triangles_;
  std::vector<Eigen::AlignedBox3d> boxes_;        ///< per mesh, in the object's frame
  std::vector<Eigen::AlignedBox3d> local_boxes_;  ///< per mesh, relative to its origin
  std::optional<Overlaps> overlaps_;
  std::vector<std::uint8_t> has_alpha_mask_;  ///< per instance
  PlanePoints points_;
  std::vector<raster::PixelView> views_;  ///< per instance
  std::vector<raster::ClusterRange> ranges_;
  std::vector<std::vector<VisibleCluster>> range_clusters_;  ///< per range of clusters
  std::vector<VisibleCluster> visible_clusters_;             ///< of all instances
  raster::TileGrid tiles_;
  WorkspacePool<TileScratch> scratch_pool_;
  rays::TileCast rays_;  ///< for a sensor on a surface
};

}  // namespace

std::unique_ptr<Renderer> make_raster_renderer(const Scene& scene, const RendererOptions& options) {
  return make_raster_renderer(std::make_shared<CpuBase>(scene, options.threads));
}

std::unique_ptr<Renderer> make_raster_renderer(std::shared_ptr<CpuBase> base) {
  return std::make_unique<RasterRenderer>(std::move(base));
}

}  // namespace glidar
