// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Clusters of a mesh, their bounds in the image, and the tiles of an image.
#include <glidar/render/raster/cluster_drawing.hpp>
#include <glidar/render/raster/packed_mesh.hpp>
#include <render/renderer_suite.hpp>

#include <algorithm>
#include <random>
#include <set>

namespace glidar::raster {
namespace {

using testing::builtin_scene;
using testing::camera_beams;
using testing::Draws;

Eigen::Vector3d corner_of(const Mesh& mesh, std::uint32_t triangle, std::size_t k) {
  return mesh.positions_m[mesh.triangles[triangle][k]].cast<double>();
}

TEST(RasterPackedMesh, ContainsEveryTriangleWithAreaOnce) {
  Mesh mesh = builtin_scene("asteroid").meshes[0];
  mesh.triangles.push_back({5, 5, 9});  // without area
  const PackedMesh packed(mesh);
  EXPECT_EQ(packed.clusters, (mesh.triangles.size() - 1 + 63) / 64);
  std::multiset<std::uint32_t> found;
  for (std::size_t i = 0; i < packed.packets.size(); ++i) {
    const TrianglePacket& packet = packed.packets[i];
    const BoxPacket& boxes = packed.boxes[i / kPacketsPerCluster / kLanes];
    const auto lane = static_cast<unsigned>(i / kPacketsPerCluster % kLanes);
    std::set<std::uint32_t> own(packet.primitive.begin(), packet.primitive.end());
    found.insert(own.begin(), own.end());
    for (unsigned t = 0; t < kLanes; ++t) {
      const Eigen::Vector3d offset =
          corner_of(mesh, packet.primitive[t], 2) - boxes.middle.get(lane).cast<double>();
      EXPECT_LT((packet.corners.c2.get(t).cast<double>() - offset).norm(), 1e-7);
      EXPECT_TRUE((offset.cwiseAbs().array() <= boxes.half.get(lane).cast<double>().array()).all());
    }
  }
  EXPECT_EQ(found.size(), mesh.triangles.size() - 1);
  EXPECT_EQ(*found.rbegin(), mesh.triangles.size() - 2);
}

TEST(RasterPackedMesh, ClustersAreSmall) {
  const Mesh mesh = builtin_scene("sphere").meshes[0];  // radius 1
  const PackedMesh packed(mesh);
  double area = 0.0;
  for (std::size_t i = 0; i < packed.clusters; ++i) {
    const Eigen::Vector3f half = packed.boxes[i / kLanes].half.get(i % kLanes);
    area += static_cast<double>(half.squaredNorm()) * std::numbers::pi;
  }
  EXPECT_LT(area, 3.0 * 4.0 * std::numbers::pi);  // of discs around them; that of the sphere: 4 pi
}

TEST(RasterPackedMesh, AnEmptyMeshHasNoCluster) {
  EXPECT_EQ(PackedMesh(Mesh{}).clusters, 0U);
}

/// Range of depths of a scene from a pose.
DepthRange depths_of(const Scene& scene, const InstanceView& view) {
  double near_m = 1e9;
  double far_m = -1e9;
  const Mesh& mesh = scene.meshes[0];
  const Eigen::AlignedBox3d box = bounds(mesh);
  extend_depths(view, {box.min() - mesh.origin_m, box.max() - mesh.origin_m}, near_m, far_m);
  return tight_depth_range(near_m, far_m);
}

TEST(RasterVisibleClusters, ContainsEveryCornerFromOutsideAndInside) {
  Scene scene = builtin_scene("asteroid");
  scene.instances[0].scale = 1.3;
  scene.instances[0].world_from_object = testing::turned(0.7, {1.0, 2.0, 3.0}, {0.1, 0.2, -0.3});
  const Mesh& mesh = scene.meshes[0];
  const PackedMesh packed(mesh);
  const Beams beams = camera_beams(320, 240, 200.0);
  const GridWindow window{.end_row = 240, .end_col = 320};
  Draws draws(3);
  std::size_t within = 0;
  for (int view_number = 0; view_number < 30; ++view_number) {
    const double distance = 0.2 + 0.2 * view_number;
    const Pose pose =
        look_at(distance * draws.direction(), 0.1 * draws.direction(), Eigen::Vector3d::UnitZ());
    const InstanceView view =
        view_of(scene.instances[0], mesh, scene.instances[0].world_from_object, pose);
    const PixelView pixels = pixel_view(view, *beams.pinhole);
    const Nearness nearness(depths_of(scene, view));
    ClusterBounds bounds;
    for (std::uint32_t cluster = 0; cluster < packed.clusters; ++cluster) {
      const unsigned lane = cluster % kLanes;
      if (lane == 0) {
        bound_clusters(pixels, nearness, window, packed.boxes[cluster / kLanes], bounds);
      }
      const TrianglePacket& packet = packed.packets[cluster * kPacketsPerCluster];
      for (const std::uint32_t triangle : packet.primitive) {
        const Eigen::Vector3d p =
            pixels.pixel_from_object * corner_of(mesh, triangle, 0).homogeneous();
        const double col = p.x() / p.z();
        const double row = p.y() / p.z();
        if (p.z() <= 0.0 || col < 0.0 || col > 319.0 || row < 0.0 || row > 239.0) continue;
        ++within;
        EXPECT_LE(bounds.left[lane], std::ceil(col));
        EXPECT_GE(bounds.right[lane], std::floor(col));
        EXPECT_LE(bounds.top[lane], std::ceil(row));
        EXPECT_GE(bounds.bottom[lane], std::floor(row));
        EXPECT_GE(static_cast<double>(bounds.nearness[lane]), nearness.at(p.z()));
      }
    }
  }
  EXPECT_GT(within, 10'000U);
}

TEST(RasterVisibleClusters, ClustersBehindOrBesideAreNotVisible) {
  const Scene scene = builtin_scene("sphere");  // radius 1
  const PackedMesh packed(scene.meshes[0]);
  const Beams beams = camera_beams(64, 64, 100.0);
  const GridWindow window{.end_row = 64, .end_col = 64};
  for (const Eigen::Vector3d& target :
       {Eigen::Vector3d(16.0, 0.0, 0.0), Eigen::Vector3d(4.0, 8.0, 0.0)}) {
    const Pose pose = look_at({8.0, 0.0, 0.0}, target, Eigen::Vector3d::UnitZ());
    const InstanceView view = view_of(scene.instances[0], scene.meshes[0], Pose::Identity(), pose);
    ClusterBounds bounds;
    for (const BoxPacket& boxes : packed.boxes) {
      bound_clusters(pixel_view(view, *beams.pinhole), Nearness({1.0, 10.0}), window, boxes,
                     bounds);
      for (unsigned i = 0; i < kLanes; ++i) {
        EXPECT_TRUE(bounds.left[i] > bounds.right[i] || bounds.top[i] > bounds.bottom[i]);
      }
    }
  }
}

TEST(RasterTileGrid, EveryPixelIsWrittenOnceAndDrawnWithItsNeighbours) {
  for (const GridWindow& window : {GridWindow{0, 480, 0, 640}, GridWindow{7, 300, 33, 34},
                                   GridWindow{100, 2000, 5, 600}, GridWindow{479, 480, 639, 640}}) {
    TileGrid tiles;
    tiles.build(window, 480, 640);
    std::vector<int> written(480 * 640, 0);
    for (std::size_t i = 0; i < tiles.size(); ++i) {
      const Tile tile = tiles.tile(i);
      EXPECT_LE(tile.drawn.rows, static_cast<std::uint32_t>(TileBuffer::kSide));
      EXPECT_LE(tile.drawn.cols, static_cast<std::uint32_t>(TileBuffer::kSide));
      EXPECT_EQ(tile.drawn.first_row, std::max(tile.written.first_row, 1U) - 1);
      EXPECT_EQ(tile.drawn.first_col + tile.drawn.cols,
                std::min(tile.written.first_col + tile.written.cols + 1, 640U));
      for (std::uint32_t row = 0; row < tile.written.rows; ++row) {
        for (std::uint32_t col = 0; col < tile.written.cols; ++col) {
          ++written[(tile.written.first_row + row) * 640 + tile.written.first_col + col];
        }
      }
    }
    for (std::uint32_t row = 0; row < 480; ++row) {
      for (std::uint32_t col = 0; col < 640; ++col) {
        const bool inside = row >= window.first_row && row < window.end_row &&
                            col >= window.first_col && col < window.end_col;
        ASSERT_EQ(written[row * 640 + col], inside ? 1 : 0) << row << ' ' << col;
      }
    }
  }
}

TEST(RasterTileGrid, ListsTheClustersOfEachTile) {
  TileGrid tiles;
  tiles.build({0, 480, 0, 640}, 480, 640);
  std::mt19937 random(2);
  std::vector<VisibleCluster> clusters;
  for (std::uint32_t i = 0; i < 500; ++i) {
    const auto left = static_cast<std::int32_t>(random() % 600);
    const auto top = static_cast<std::int32_t>(random() % 400);
    clusters.push_back({.instance = 0,
                        .cluster = i,
                        .left = left,
                        .right = left + static_cast<std::int32_t>(random() % 40),
                        .top = top,
                        .bottom = top + static_cast<std::int32_t>(random() % 80),
                        .nearness = 0.0F});
  }
  tiles.bin_clusters(clusters);
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    const PixelRect drawn = tiles.tile(i).drawn;
    const std::span<const std::uint32_t> seen = tiles.clusters_in(i);
    for (std::uint32_t s = 0; s < clusters.size(); ++s) {
      const VisibleCluster& at = clusters[s];
      const bool meets = at.left < static_cast<int>(drawn.first_col + drawn.cols) &&
                         at.right >= static_cast<int>(drawn.first_col) &&
                         at.top < static_cast<int>(drawn.first_row + drawn.rows) &&
                         at.bottom >= static_cast<int>(drawn.first_row);
      EXPECT_EQ(std::count(seen.begin(), seen.end(), s), meets ? 1 : 0);
    }
  }
}

}  // namespace
}  // namespace glidar::raster
