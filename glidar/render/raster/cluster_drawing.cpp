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

/// The tile into which clusters of an instance are drawn.
struct TileTarget {
  const DrawContext& context;
  std::uint32_t instance;
  std::int32_t first_col;  ///< of the image in the tile
  std::int32_t first_row;
  TileBuffer& buffer;

  [[nodiscard]] const PixelView& view() const { return context.views[instance]; }
  [[nodiscard]] std::uint32_t triangle_id(std::uint32_t primitive) const {
    return context.triangles.first(instance) + primitive;
  }
};

/// Corners must be at least this deep for single precision.
float min_depth(const TileTransform& transform, const Eigen::Vector3f& half) {
  // At a smaller fraction of the depth of the farthest corner, rounding of depths would move
  // corners.
  constexpr float kMinPart = 1.0F / 16.0F;
  // A column is a sum of three products: if their sizes add up to more than this many pixels, its
  // rounding approaches kEdgeMargin_px.
  constexpr float kMaxDrawing_px = 128.0F;
  const Eigen::Map<const Eigen::Matrix3f> matrix(transform.matrix.data());
  const Eigen::Vector3f reach = matrix.cwiseAbs() * half;
  return std::max(kMinPart * (transform.depth + reach.z()),
                  std::max(reach.x(), reach.y()) / kMaxDrawing_px);
}

TileTransform tile_transform(const TileTarget& target, const PackedMesh& mesh,
                             std::uint32_t cluster) {
  const BoxPacket& boxes = mesh.boxes[cluster / kLanes];
  const unsigned lane = cluster % kLanes;
  const Eigen::Matrix<double, 3, 4>& pixel = target.view().pixel_from_object;
  Eigen::Matrix<double, 3, 4> tile = pixel;
  tile.row(0) -= target.first_col * pixel.row(2);
  tile.row(1) -= target.first_row * pixel.row(2);
  const Eigen::Vector3d middle =
      tile.leftCols<3>() * boxes.middle.get(lane).cast<double>() + tile.col(3);
  TileTransform transform{};
  Eigen::Map<Eigen::Matrix3f>(transform.matrix.data()) = tile.leftCols<3>().cast<float>();
  transform.column = static_cast<float>(middle.x());
  transform.row = static_cast<float>(middle.y());
  transform.depth = static_cast<float>(middle.z());
  transform.before_far = static_cast<float>(target.context.nearness.far_m - middle.z());
  transform.factor = static_cast<float>(target.context.nearness.factor);
  transform.min_depth = min_depth(transform, boxes.half.get(lane));
  transform.last_col = static_cast<float>(target.buffer.cols() - 1);
  transform.last_row = static_cast<float>(target.buffer.rows() - 1);
  transform.cull_back_faces = target.context.request.cull_back_faces;
  return transform;
}

bool is_inside(const TriangleSetup& setup, float across, float down) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (setup.at_corner[k] + setup.per_col[k] * across + setup.per_row[k] * down < 0.0F) {
      return false;
    }
  }
  return true;
}

/// Draws pixel by pixel, skipping holes of the alpha mask.
void draw_with_holes(const TileTarget& target, const TriangleSetup& setup,
                     std::uint32_t primitive) {
  const CastRequest& request = target.context.request;
  const auto is_hole = [&](std::size_t beam) {
    return !blocks_beam(target.context.resolver, request.beams, beam, request.cull_back_faces,
                        {target.instance, primitive});
  };
  const std::size_t cols = request.beams.cols;
  for (int row = setup.rect.top; row <= setup.rect.bottom; ++row) {
    for (int col = setup.rect.left; col <= setup.rect.right; ++col) {
      const auto across = static_cast<float>(col - setup.rect.left);
      const auto down = static_cast<float>(row - setup.rect.top);
      const std::size_t beam = static_cast<std::size_t>(target.first_row + row) * cols +
                               static_cast<std::size_t>(target.first_col + col);
      if (!is_inside(setup, across, down) || is_hole(beam)) continue;
      const float nearness = setup.nearness_at_corner + setup.nearness_per_col * across +
                             setup.nearness_per_row * down;
      target.buffer.depth_test(col, row, std::clamp(nearness, setup.farthest, setup.nearest),
                               setup.margin, setup.triangle_id);
    }
  }
}

bool may_have_holes(const TileTarget& target, std::uint32_t primitive) {
  if (target.context.has_mask[target.instance] == 0) return false;
  const Scene& scene = target.context.resolver.scene();
  return material_of(scene, scene.instances[target.instance], primitive).alpha_cutoff > 0.0F;
}

void draw_setup(const TileTarget& target, const TriangleSetup& setup, std::uint32_t primitive) {
  if (may_have_holes(target, primitive)) {
    draw_with_holes(target, setup, primitive);
  } else {
    target.buffer.draw(setup);
  }
}

void draw_large(const TileTarget& target, std::uint32_t primitive) {
  const Mesh& mesh = target.context.resolver.mesh(target.instance);
  const Triangle& triangle = mesh.triangles[primitive];
  Eigen::Matrix3d corners;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3f& position = mesh.positions_m[triangle[static_cast<std::size_t>(k)]];
    corners.col(k) = target.view().pixel_from_object * position.cast<double>().homogeneous();
  }
  corners.row(0) -= target.first_col * corners.row(2);
  corners.row(1) -= target.first_row * corners.row(2);
  const PixelBounds all = {0, target.buffer.cols() - 1, 0, target.buffer.rows() - 1};
  std::optional<TriangleSetup> setup = set_up_triangle(corners, target.context.nearness, all,
                                                       target.context.request.cull_back_faces);
  if (!setup) return;
  setup->triangle_id = target.triangle_id(primitive);
  draw_setup(target, *setup, primitive);
}

/// Draws the pixels that a small triangle covers.
void draw_small(const TileTarget& target, const TriangleSetups& f, unsigned lane,
                std::uint32_t coverage, std::uint32_t primitive) {
  constexpr std::uint32_t kPixels = (1U << kCertainShift) - 1;
  const std::uint32_t triangle_id = target.triangle_id(primitive);
  for (std::uint32_t rest = coverage & kPixels; rest != 0; rest &= rest - 1) {
    const int bit = std::countr_zero(rest);
    const std::uint32_t certain = (coverage >> (bit + kCertainShift) & 1U) != 0 ? kCertainFlag : 0;
    const int across = bit % kSmall;
    const int down = bit / kSmall;
    const float nearness = f.nearness_at_corner[lane] +
                           f.nearness_per_col[lane] * static_cast<float>(across) +
                           f.nearness_per_row[lane] * static_cast<float>(down);
    target.buffer.depth_test(f.left[lane] + across, f.top[lane] + down,
                             std::clamp(nearness, f.farthest[lane], f.nearest[lane]),
                             f.margin[lane], triangle_id | certain);
  }
}

void draw_packet(const TileTarget& target, const TrianglePacket& packet, const TriangleSetups& f) {
  Lanes<std::uint32_t> coverage;
  for (std::uint32_t pending = coverage_masks(f, coverage); pending != 0; pending &= pending - 1) {
    const auto lane = static_cast<unsigned>(std::countr_zero(pending));
    const auto size = static_cast<SizeClass>(f.size[lane]);
    const std::uint32_t primitive = packet.primitive[lane];
    if (size == SizeClass::large) {
      draw_large(target, primitive);
    } else if (size == SizeClass::medium || may_have_holes(target, primitive)) {
      draw_setup(target, f.setup(lane, target.triangle_id(primitive)), primitive);
    } else {
      draw_small(target, f, lane, coverage[lane], primitive);
    }
  }
}

const PackedMesh& mesh_of(const DrawContext& context, const VisibleCluster& cluster) {
  return context.meshes[context.resolver.scene().instances[cluster.instance].mesh];
}

std::span<const TrianglePacket> packets_of(const PackedMesh& mesh, std::uint32_t cluster) {
  const std::size_t first = cluster * kPacketsPerCluster;
  return std::span(mesh.packets)
      .subspan(first, std::min(kPacketsPerCluster, mesh.packets.size() - first));
}

}  // namespace

void prefetch(const DrawContext& context, const VisibleCluster& cluster) {
  const std::span<const TrianglePacket> packets =
      packets_of(mesh_of(context, cluster), cluster.cluster);
  constexpr std::ptrdiff_t kLine = 64;
  const auto* at = reinterpret_cast<const char*>(packets.data());
  const auto* last = reinterpret_cast<const char*>(packets.data() + packets.size());
  for (; at < last; at += kLine) __builtin_prefetch(at);
}

void draw_cluster(const DrawContext& context, const VisibleCluster& cluster,
                  const PixelPosition& first, TileBuffer& buffer) {
  const TileTarget target{context, cluster.instance, first.col, first.row, buffer};
  const PackedMesh& mesh = mesh_of(context, cluster);
  const TileTransform transform = tile_transform(target, mesh, cluster.cluster);
  TriangleSetups footprints;
  for (const TrianglePacket& packet : packets_of(mesh, cluster.cluster)) {
    set_up_triangles(transform, packet.corners, footprints);
    draw_packet(target, packet, footprints);
  }
}

}  // namespace glidar::raster
