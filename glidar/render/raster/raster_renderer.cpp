// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/raster/raster_renderer.hpp>

#include <glidar/core/progress_counter.hpp>
#include <glidar/render/grid_window.hpp>
#include <glidar/render/hit_writer.hpp>
#include <glidar/render/pinhole_only.hpp>
#include <glidar/render/plane_points.hpp>
#include <glidar/render/raster/cluster_drawing.hpp>
#include <glidar/render/raster/packed_mesh.hpp>
#include <glidar/render/raster/tile_grid.hpp>
#include <glidar/render/raster/visible_clusters.hpp>
#include <glidar/render/workspace_pool.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace glidar {
namespace {

using raster::Drawing;
using raster::Sighting;

/// What one thread draws with.
struct Desk {
  raster::Canvas canvas;
  std::vector<std::uint32_t> numbers;
  std::vector<std::uint64_t> order;  ///< of the clusters: the nearest first
};

constexpr std::size_t kAhead = 3;  // clusters on their way from memory

/// The part of a sighting that lies on a canvas.
raster::CanvasRect rect_on(const PixelRect& drawn, const Sighting& sighting) {
  const auto first_col = static_cast<int>(drawn.first_col);
  const auto first_row = static_cast<int>(drawn.first_row);
  return {.left = std::max(sighting.left - first_col, 0),
          .right = std::min(sighting.right - first_col, static_cast<int>(drawn.cols) - 1),
          .top = std::max(sighting.top - first_row, 0),
          .bottom = std::min(sighting.bottom - first_row, static_cast<int>(drawn.rows) - 1)};
}

raster::PixelPlace first_of(const raster::Part& part) {
  return {.col = static_cast<std::int32_t>(part.drawn.first_col),
          .row = static_cast<std::int32_t>(part.drawn.first_row)};
}

/// The nearest first; of equals the first.
std::uint64_t key(const Sighting& sighting, std::uint32_t index) {
  // The bits of positive numbers rise with them.
  const std::uint32_t nearness = std::bit_cast<std::uint32_t>(std::max(sighting.nearness, 0.0F));
  return std::uint64_t{~nearness} << 32U | index;
}

class RasterRenderer final : public Renderer {
 public:
  explicit RasterRenderer(std::shared_ptr<CpuBase> base)
      : base_(std::move(base)), triangles_(scene(), "raster") {
    for (std::size_t i = 0; i < scene().meshes.size(); ++i) {
      const Mesh& mesh = scene().meshes[i];
      packed_.emplace_back(mesh, base_->resolver.distinct(i));
      boxes_.push_back(bounds(mesh));
      local_boxes_.push_back(local_box(mesh));
    }
    for (const Instance& instance : scene().instances) {
      has_mask_.push_back(static_cast<std::uint8_t>(has_mask(scene(), instance)));
    }
  }

  [[nodiscard]] std::string_view name() const override { return "raster"; }
  [[nodiscard]] ThreadPool& thread_pool() override { return base_->thread_pool; }

  void cast(const CastRequest& request, Hits& hits) override {
    check(request, scene());
    check_pinhole(request.beams, "raster");
    resize(hits, request.beams.size(), request.fields);
    base_->resolver.set_poses(request.world_from_sensor, request.world_from_instance);
    base_->search.prepare(request);
    if (!overlaps_) overlaps_.emplace(base_->resolver, base_->search.trees());
    overlaps_->prepare(request);
    find_plane_points(request.beams, points_);
    ProgressCounter count(request.progress, request.beams.size());
    const DepthRange depths = depths_of(request, base_->resolver, local_boxes_);
    const GridWindow window =
        depths.is_empty() ? GridWindow{.end_row = 0, .end_col = 0}
                          : window_on(base_->resolver, boxes_, request.instance_enabled, points_);
    write_around(request, window, count, hits);
    if (!depths.is_empty() && window.first_row < window.end_row &&
        window.first_col < window.end_col) {
      draw(request, window, depths, count, hits);
    }
    count.finish();
  }

 private:
  [[nodiscard]] const Scene& scene() const { return base_->resolver.scene(); }

  [[nodiscard]] const raster::PackedMesh& packed_of(std::uint32_t instance) const {
    return packed_[scene().instances[instance].mesh];
  }

  /// Misses, outside of the window.
  void write_around(const CastRequest& request, const GridWindow& window, ProgressCounter& count,
                    Hits& hits) {
    const std::uint32_t cols = request.beams.cols;
    const auto miss = [&](std::size_t begin, std::size_t end) {
      if (begin >= end) return;
      write_misses(request.fields, begin, end - begin, hits);
      if (request.on_tile_done) request.on_tile_done({begin, end});
      count.add(end - begin);
    };
    const auto miss_row = [&](std::size_t row) {
      const bool is_beside = row >= window.first_row && row < window.end_row;
      const std::size_t first = row * cols;
      miss(first, first + (is_beside ? std::min(window.first_col, cols) : cols));
      if (is_beside) miss(first + std::min(window.end_col, cols), first + cols);
    };
    constexpr std::size_t kRowsPerTask = 4;
    base_->thread_pool.parallel_for(request.beams.rows, kRowsPerTask,
                                    [&](std::size_t begin, std::size_t end) {
                                      for (std::size_t row = begin; row < end; ++row) miss_row(row);
                                    });
  }

  void find_sightings(const CastRequest& request, const GridWindow& window,
                      const raster::Nearness& nearness) {
    constexpr std::uint32_t kClustersPerPiece = 1024;
    views_.clear();
    pieces_.clear();
    for (std::uint32_t i = 0; i < scene().instances.size(); ++i) {
      views_.push_back(raster::pixel_view(base_->resolver.view(i), *request.beams.pinhole));
      const auto clusters =
          static_cast<std::uint32_t>(is_enabled(request, i) ? packed_of(i).clusters : 0);
      for (std::uint32_t first = 0; first < clusters; first += kClustersPerPiece) {
        pieces_.push_back({i, first, std::min(first + kClustersPerPiece, clusters)});
      }
    }
    found_.resize(std::max(found_.size(), pieces_.size()));
    base_->thread_pool.parallel_for(pieces_.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const raster::ClusterRange& piece = pieces_[i];
        found_[i].clear();
        raster::add_sightings(views_[piece.instance], nearness, window, packed_of(piece.instance),
                              piece, found_[i]);
      }
    });
    sightings_.clear();
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      sightings_.insert(sightings_.end(), found_[i].begin(), found_[i].end());
    }
  }

  void draw(const CastRequest& request, GridWindow window, const DepthRange& depths,
            ProgressCounter& count, Hits& hits) {
    window.end_row = std::min(window.end_row, request.beams.rows);
    window.end_col = std::min(window.end_col, request.beams.cols);
    const raster::Nearness nearness(depths);
    find_sightings(request, window, nearness);
    parts_.cut(window, request.beams.rows, request.beams.cols);
    parts_.sort(sightings_);
    const Drawing drawing{.request = request,
                          .resolver = base_->resolver,
                          .meshes = packed_,
                          .views = views_,
                          .triangles = triangles_,
                          .has_mask = has_mask_,
                          .nearness = nearness};
    base_->thread_pool.parallel_for(parts_.size(), 1, [&](std::size_t begin, std::size_t end) {
      std::unique_ptr<Desk> desk = desks_.take();
      for (std::size_t i = begin; i < end; ++i) {
        const raster::Part part = parts_.part(i);
        draw_part(drawing, part, parts_.seen_in(i), *desk);
        write_part(drawing, part, *desk, hits);
        count.add(std::size_t{part.written.rows} * part.written.cols);
      }
      desks_.give_back(std::move(desk));
    });
  }

  /// Writes the hits of what was drawn.
  void write_part(const Drawing& drawing, const raster::Part& part, const Desk& desk,
                  Hits& hits) const {
    write_rows({.request = drawing.request,
                .resolver = base_->resolver,
                .triangles = triangles_,
                .points = points_,
                .drawn = part.drawn,
                .numbers = desk.numbers,
                .part = part.written,
                .hits = hits,
                .search = base_->search.beams(),
                .overlaps = *overlaps_},
               0, part.written.rows);
  }

  /// For clusters that reach to the sensor's plane, of which sightings do not tell where.
  [[nodiscard]] bool is_beside(const Sighting& sighting, const PixelRect& drawn) const {
    if (!std::isinf(sighting.nearness)) return false;
    const auto left = static_cast<int>(drawn.first_col);
    const auto top = static_cast<int>(drawn.first_row);
    return raster::is_beside(views_[sighting.instance],
                             packed_of(sighting.instance).boxes[sighting.cluster / kLanes],
                             sighting.cluster % kLanes,
                             {left, left + static_cast<int>(drawn.cols) - 1, top,
                              top + static_cast<int>(drawn.rows) - 1});
  }

  [[nodiscard]] const Sighting& sighting_at(std::uint64_t key) const {
    return sightings_[static_cast<std::uint32_t>(key)];
  }

  /// Draws the clusters that are seen in a part, the nearest first, but for those found hidden.
  void draw_part(const Drawing& drawing, const raster::Part& part,
                 std::span<const std::uint32_t> seen, Desk& desk) const {
    const auto cols = static_cast<int>(part.drawn.cols);
    const auto rows = static_cast<int>(part.drawn.rows);
    desk.canvas.clear(cols, rows, static_cast<float>(drawing.nearness.factor));
    desk.order.clear();
    for (const std::uint32_t index : seen) desk.order.push_back(key(sightings_[index], index));
    std::sort(desk.order.begin(), desk.order.end());
    // What comes lies anywhere in memory: it is asked for in time, unless it is hidden already.
    std::array<const Sighting*, kAhead> coming{};
    for (std::size_t i = 0; i < desk.order.size() + kAhead; ++i) {
      const Sighting*& slot = coming[i % kAhead];
      if (slot != nullptr) {
        raster::draw_cluster(drawing, *slot, first_of(part), desk.canvas);
        desk.canvas.mark_drawn(rect_on(part.drawn, *slot));
      }
      slot = nullptr;
      if (i >= desk.order.size()) continue;
      if (i + kAhead < desk.order.size()) {
        __builtin_prefetch(&sighting_at(desk.order[i + kAhead]));
      }
      const Sighting& sighting = sighting_at(desk.order[i]);
      const raster::CanvasRect rect = rect_on(part.drawn, sighting);
      if (rect.left > rect.right || rect.top > rect.bottom) continue;
      if (desk.canvas.hides(rect, sighting.nearness) || is_beside(sighting, part.drawn)) continue;
      raster::prefetch(drawing, sighting);
      slot = &sighting;
    }
    desk.canvas.copy_numbers(desk.numbers);
  }

  std::shared_ptr<CpuBase> base_;
  std::vector<raster::PackedMesh> packed_;
  TriangleNumbers triangles_;
  std::vector<Eigen::AlignedBox3d> boxes_;        ///< per mesh, in the object's frame
  std::vector<Eigen::AlignedBox3d> local_boxes_;  ///< per mesh, relative to its origin
  std::optional<Overlaps> overlaps_;
  std::vector<std::uint8_t> has_mask_;  ///< per instance
  PlanePoints points_;
  std::vector<raster::PixelView> views_;  ///< per instance
  std::vector<raster::ClusterRange> pieces_;
  std::vector<std::vector<Sighting>> found_;  ///< per piece
  std::vector<Sighting> sightings_;           ///< all of them
  raster::Parts parts_;
  Pool<Desk> desks_;
};

}  // namespace

std::unique_ptr<Renderer> make_raster_renderer(const Scene& scene, const RendererOptions& options) {
  return make_raster_renderer(std::make_shared<CpuBase>(scene, options.threads));
}

std::unique_ptr<Renderer> make_raster_renderer(std::shared_ptr<CpuBase> base) {
  return std::make_unique<RasterRenderer>(std::move(base));
}

}  // namespace glidar
