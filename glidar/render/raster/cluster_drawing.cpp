// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/raster/cluster_drawing.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <span>

namespace glidar::raster {
namespace {

/// A cluster on its way onto a canvas.
struct Placed {
  const Drawing& drawing;
  std::uint32_t instance;
  std::int32_t first_col;  ///< of the picture on the canvas
  std::int32_t first_row;
  Canvas& canvas;

  [[nodiscard]] const PixelView& view() const { return drawing.views[instance]; }
  [[nodiscard]] std::uint32_t number(std::uint32_t primitive) const {
    return drawing.triangles.first(instance) + primitive;
  }
};

/// Corners nearer than this are not for single precision.
float least_depth(const Aim& aim, const Eigen::Vector3f& half) {
  // Nearer than this part of the farthest corner, rounding of its depth would move a corner.
  constexpr float kMinPart = 1.0F / 16.0F;
  // A column is a sum of three products: where their sizes add up to more than this many pixels,
  // its rounding comes near kBorderRoom_px.
  constexpr float kMaxDrawing_px = 128.0F;
  const Eigen::Map<const Eigen::Matrix3f> turn(aim.turn.data());
  const Eigen::Vector3f reach = turn.cwiseAbs() * half;
  return std::max(kMinPart * (aim.depth + reach.z()),
                  std::max(reach.x(), reach.y()) / kMaxDrawing_px);
}

Aim aim_at(const Placed& placed, const PackedMesh& mesh, std::uint32_t cluster) {
  const Boxes& boxes = mesh.boxes[cluster / kLanes];
  const unsigned lane = cluster % kLanes;
  const Eigen::Matrix<double, 3, 4>& pixel = placed.view().pixel_from_object;
  Eigen::Matrix<double, 3, 4> canvas = pixel;
  canvas.row(0) -= placed.first_col * pixel.row(2);
  canvas.row(1) -= placed.first_row * pixel.row(2);
  const Eigen::Vector3d seen =
      canvas.leftCols<3>() * boxes.middle.get(lane).cast<double>() + canvas.col(3);
  Aim aim{};
  Eigen::Map<Eigen::Matrix3f>(aim.turn.data()) = canvas.leftCols<3>().cast<float>();
  aim.column = static_cast<float>(seen.x());
  aim.row = static_cast<float>(seen.y());
  aim.depth = static_cast<float>(seen.z());
  aim.before_far = static_cast<float>(placed.drawing.nearness.far_m - seen.z());
  aim.factor = static_cast<float>(placed.drawing.nearness.factor);
  aim.least_depth = least_depth(aim, boxes.half.get(lane));
  aim.last_col = static_cast<float>(placed.canvas.cols() - 1);
  aim.last_row = static_cast<float>(placed.canvas.rows() - 1);
  aim.cull_back_faces = placed.drawing.request.cull_back_faces;
  return aim;
}

bool is_inside(const Shape& shape, float across, float down) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (shape.at_corner[k] + shape.per_col[k] * across + shape.per_row[k] * down < 0.0F) {
      return false;
    }
  }
  return true;
}

/// Draws pixel by pixel, looking for holes.
void draw_with_holes(const Placed& placed, const Shape& shape, std::uint32_t primitive) {
  const CastRequest& request = placed.drawing.request;
  const auto is_hole = [&](std::size_t beam) {
    return !stops(placed.drawing.resolver, request.beams, beam, request.cull_back_faces,
                  {placed.instance, primitive});
  };
  const std::size_t cols = request.beams.cols;
  for (int row = shape.rect.top; row <= shape.rect.bottom; ++row) {
    for (int col = shape.rect.left; col <= shape.rect.right; ++col) {
      const auto across = static_cast<float>(col - shape.rect.left);
      const auto down = static_cast<float>(row - shape.rect.top);
      const std::size_t beam = static_cast<std::size_t>(placed.first_row + row) * cols +
                               static_cast<std::size_t>(placed.first_col + col);
      if (!is_inside(shape, across, down) || is_hole(beam)) continue;
      const float nearness = shape.nearness_at_corner + shape.nearness_per_col * across +
                             shape.nearness_per_row * down;
      placed.canvas.offer(col, row, std::clamp(nearness, shape.farthest, shape.nearest), shape.room,
                          shape.number);
    }
  }
}

bool may_have_holes(const Placed& placed, std::uint32_t primitive) {
  if (placed.drawing.has_mask[placed.instance] == 0) return false;
  const Scene& scene = placed.drawing.resolver.scene();
  return material_of(scene, scene.instances[placed.instance], primitive).alpha_cutoff > 0.0F;
}

void draw_shape(const Placed& placed, const Shape& shape, std::uint32_t primitive) {
  if (may_have_holes(placed, primitive)) {
    draw_with_holes(placed, shape, primitive);
  } else {
    placed.canvas.draw(shape);
  }
}

void draw_large(const Placed& placed, std::uint32_t primitive) {
  const Mesh& mesh = placed.drawing.resolver.mesh(placed.instance);
  const Triangle& triangle = mesh.triangles[primitive];
  Eigen::Matrix3d corners;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3f& position = mesh.positions_m[triangle[static_cast<std::size_t>(k)]];
    corners.col(k) = placed.view().pixel_from_object * position.cast<double>().homogeneous();
  }
  corners.row(0) -= placed.first_col * corners.row(2);
  corners.row(1) -= placed.first_row * corners.row(2);
  const CanvasRect all = {0, placed.canvas.cols() - 1, 0, placed.canvas.rows() - 1};
  std::optional<Shape> shape =
      shape_of(corners, placed.drawing.nearness, all, placed.drawing.request.cull_back_faces);
  if (!shape) return;
  shape->number = placed.number(primitive);
  draw_shape(placed, *shape, primitive);
}

/// Draws the pixels that a small triangle covers.
void draw_small(const Placed& placed, const Footprints& f, unsigned lane, std::uint32_t covered,
                std::uint32_t primitive) {
  constexpr std::uint32_t kPixels = (1U << kCertainShift) - 1;
  const std::uint32_t number = placed.number(primitive);
  for (std::uint32_t rest = covered & kPixels; rest != 0; rest &= rest - 1) {
    const int bit = std::countr_zero(rest);
    const std::uint32_t certain = (covered >> (bit + kCertainShift) & 1U) != 0 ? kCertain : 0;
    const int across = bit % kSmall;
    const int down = bit / kSmall;
    const float nearness = f.nearness_at_corner[lane] +
                           f.nearness_per_col[lane] * static_cast<float>(across) +
                           f.nearness_per_row[lane] * static_cast<float>(down);
    placed.canvas.offer(f.left[lane] + across, f.top[lane] + down,
                        std::clamp(nearness, f.farthest[lane], f.nearest[lane]), f.room[lane],
                        number | certain);
  }
}

void draw_pack(const Placed& placed, const Pack& pack, const Footprints& f) {
  Lanes<std::uint32_t> covered;
  for (std::uint32_t due = cover(f, covered); due != 0; due &= due - 1) {
    const auto lane = static_cast<unsigned>(std::countr_zero(due));
    const auto size = static_cast<Size>(f.size[lane]);
    const std::uint32_t primitive = pack.primitive[lane];
    if (size == Size::large) {
      draw_large(placed, primitive);
    } else if (size == Size::medium || may_have_holes(placed, primitive)) {
      draw_shape(placed, f.shape(lane, placed.number(primitive)), primitive);
    } else {
      draw_small(placed, f, lane, covered[lane], primitive);
    }
  }
}

const PackedMesh& mesh_of(const Drawing& drawing, const Sighting& sighting) {
  return drawing.meshes[drawing.resolver.scene().instances[sighting.instance].mesh];
}

std::span<const Pack> packs_of(const PackedMesh& mesh, std::uint32_t cluster) {
  const std::size_t first = cluster * kPacksPerCluster;
  return std::span(mesh.packs)
      .subspan(first, std::min(kPacksPerCluster, mesh.packs.size() - first));
}

}  // namespace

void prefetch(const Drawing& drawing, const Sighting& sighting) {
  const std::span<const Pack> packs = packs_of(mesh_of(drawing, sighting), sighting.cluster);
  constexpr std::ptrdiff_t kLine = 64;
  const auto* at = reinterpret_cast<const char*>(packs.data());
  const auto* last = reinterpret_cast<const char*>(packs.data() + packs.size());
  for (; at < last; at += kLine) __builtin_prefetch(at);
}

void draw_cluster(const Drawing& drawing, const Sighting& sighting, const PixelPlace& first,
                  Canvas& canvas) {
  const Placed placed{drawing, sighting.instance, first.col, first.row, canvas};
  const PackedMesh& mesh = mesh_of(drawing, sighting);
  const Aim aim = aim_at(placed, mesh, sighting.cluster);
  Footprints footprints;
  for (const Pack& pack : packs_of(mesh, sighting.cluster)) {
    find_footprints(aim, pack.corners, footprints);
    draw_pack(placed, pack, footprints);
  }
}

}  // namespace glidar::raster
