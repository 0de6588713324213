// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/raster/cluster_drawing.hpp>

#include <glidar/render/raster/packed_mesh.hpp>
#include <glidar/render/raster/tile_buffer.hpp>

#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <render/renderer_suite.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <set>

// Clusters of a mesh, their bounds in the image, and the tiles of an image.

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

/// A square with edges along rows and columns and constant nearness.
TriangleSetup square(const PixelBounds& rect, float nearness, std::uint32_t triangle_id) {
  TriangleSetup setup{};
  setup.rect = rect;
  setup.per_col = {1.0F, -1.0F, 0.0F};
  setup.per_row = {0.0F, 0.0F, 1.0F};
  setup.at_corner = {0.0F, static_cast<float>(rect.right - rect.left), 0.0F};
  setup.certain = {0.5F, 0.5F, 0.5F};
  setup.nearness_at_corner = nearness;
  setup.farthest = 0.0F;
  setup.nearest = 1.0F;
  setup.triangle_id = triangle_id;
  return setup;
}

std::vector<std::uint32_t> drawn_numbers(const TileBuffer& tile) {
  std::vector<std::uint32_t> triangle_ids;
  tile.copy_triangle_ids(triangle_ids);
  return triangle_ids;
}

/// The ids without flags.
std::vector<std::uint32_t> triangles_of(const TileBuffer& tile) {
  std::vector<std::uint32_t> triangle_ids = drawn_numbers(tile);
  for (std::uint32_t& triangle_id : triangle_ids) triangle_id &= kTriangleIdMask | kCertainFlag;
  return triangle_ids;
}

std::unique_ptr<TileBuffer> empty_canvas(int cols, int rows) {
  auto tile = std::make_unique<TileBuffer>();
  tile->clear(cols, rows, 1.0F);
  return tile;
}

/// Random setups, sloping and overlapping.
std::vector<TriangleSetup> many_shapes(int cols, int rows) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> tile(0.0F, 1.0F);
  std::vector<TriangleSetup> shapes;
  for (std::uint32_t i = 0; i < 200; ++i) {
    const int left = static_cast<int>(tile(random) * static_cast<float>(cols - 1));
    const int top = static_cast<int>(tile(random) * static_cast<float>(rows - 1));
    const PixelBounds rect{left, std::min(cols - 1, left + 9), top, std::min(rows - 1, top + 6)};
    // Few different values, so that some triangles are equally near.
    TriangleSetup setup = square(rect, 0.25F * std::floor(4.0F * tile(random)), i);
    if (i % 2 == 0) setup.nearness_per_col = 0.01F * tile(random);
    shapes.push_back(setup);
  }
  return shapes;
}

TEST(RasterTileBuffer, IsEmptyAfterClear) {
  const auto tile = empty_canvas(10, 6);
  EXPECT_EQ(drawn_numbers(*tile), std::vector<std::uint32_t>(60, kNoTriangleId));
  tile->depth_test(3, 2, 0.5F, 0.0F, 7);
  EXPECT_EQ(drawn_numbers(*tile)[2 * 10 + 3], 7U);
  tile->clear(9, 5, 1.0F);
  EXPECT_EQ(drawn_numbers(*tile), std::vector<std::uint32_t>(45, kNoTriangleId));
}

TEST(RasterTileBuffer, TheNearestTriangleWinsInAnyOrder) {
  const int cols = 61;
  const int rows = 47;
  std::vector<TriangleSetup> shapes = many_shapes(cols, rows);
  const auto forward = empty_canvas(cols, rows);
  for (const TriangleSetup& setup : shapes) forward->draw(setup);
  std::shuffle(shapes.begin(), shapes.end(), std::mt19937(5));
  const auto shuffled = empty_canvas(cols, rows);
  for (const TriangleSetup& setup : shapes) shuffled->draw(setup);
  EXPECT_EQ(triangles_of(*forward), triangles_of(*shuffled));
}

TEST(RasterTileBuffer, TheLowerIdWinsAtEqualNearness) {
  const auto tile = empty_canvas(8, 8);
  tile->draw(square({0, 7, 0, 7}, 0.5F, 5));
  tile->draw(square({0, 7, 0, 7}, 0.5F, 3));
  tile->draw(square({0, 7, 0, 7}, 0.5F, 4));
  tile->depth_test(1, 1, 0.5F, 0.0F, 9 | kCertainFlag);
  tile->depth_test(2, 1, 0.5F, 0.0F, 1 | kCertainFlag);
  const std::vector<std::uint32_t> triangle_ids = drawn_numbers(*tile);
  EXPECT_EQ(triangle_ids[8 + 1], 3U | kCertainFlag | kContestedFlag);
  EXPECT_EQ(triangle_ids[8 + 2], 1U | kCertainFlag | kContestedFlag);
}

TEST(RasterTileBuffer, MarksSurfacesThatAreTooCloseInEitherOrder) {
  const TriangleSetup near = square({0, 7, 0, 7}, 0.5F, 5);
  for (const float apart : {0x1p-24F, 0x1p-20F, -0x1p-24F, -0x1p-20F}) {
    const TriangleSetup far = square({0, 7, 0, 7}, 0.5F - apart, 3);
    for (const bool is_swapped : {false, true}) {
      const auto tile = empty_canvas(8, 8);
      tile->draw(is_swapped ? far : near);
      tile->draw(is_swapped ? near : far);
      const std::uint32_t triangle_id = drawn_numbers(*tile)[3 * 8 + 3];
      EXPECT_EQ(triangle_id, (apart > 0.0F ? 5U : 3U) | kCertainFlag | kContestedFlag) << apart;
    }
  }
}

TEST(RasterTileBuffer, DoesNotMarkSurfacesThatAreClearlyApart) {
  const auto tile = empty_canvas(8, 8);
  tile->draw(square({0, 7, 0, 7}, 0.5F, 5));
  tile->draw(square({0, 7, 0, 7}, 0.5F - 0x1p-16F, 3));
  tile->depth_test(1, 1, 0.5F - 0x1p-16F, 0.0F, 4);
  EXPECT_EQ(drawn_numbers(*tile)[3 * 8 + 3], 5U | kCertainFlag);
  EXPECT_EQ(drawn_numbers(*tile)[8 + 1], 5U | kCertainFlag);
}

TEST(RasterTileBuffer, MarksSurfacesWithRoughNearness) {
  TriangleSetup rough = square({0, 7, 0, 7}, 0.5F, 5);
  rough.margin = 0.01F;
  const auto tile = empty_canvas(8, 8);
  tile->draw(rough);
  tile->draw(square({0, 7, 0, 7}, 0.6F, 3));
  EXPECT_EQ(drawn_numbers(*tile)[3 * 8 + 3], 3U | kCertainFlag | kContestedFlag);
}

TEST(RasterTileBuffer, MarksPixelsFarFromEdgesAsCertain) {
  const auto tile = empty_canvas(8, 8);
  tile->draw(square({1, 6, 1, 6}, 0.5F, 2));
  const std::vector<std::uint32_t> triangle_ids = drawn_numbers(*tile);
  EXPECT_EQ(triangle_ids[3 * 8 + 1], 2U);                 // on the left edge
  EXPECT_EQ(triangle_ids[3 * 8 + 6], 2U);                 // on the right one
  EXPECT_EQ(triangle_ids[3 * 8 + 3], 2U | kCertainFlag);  // in the middle
}

TEST(RasterTileBuffer, OccludesARectangleOnlyIfAllOfItIsNearer) {
  for (const int side : {6, 40}) {  // pixel by pixel, and by cells
    const auto tile = empty_canvas(100, 100);
    const PixelBounds rect{20, 20 + side, 30, 30 + side};
    EXPECT_FALSE(tile->is_occluded(rect, 0.1F));
    tile->draw(square({16, 87, 24, 87}, 0.5F, 1));
    tile->mark_stale({16, 87, 24, 87});
    EXPECT_TRUE(tile->is_occluded(rect, 0.4F)) << side;
    EXPECT_FALSE(tile->is_occluded(rect, 0.5F)) << side;
    EXPECT_FALSE(tile->is_occluded({10, 20 + side, 30, 30 + side}, 0.4F)) << side;
  }
}

TEST(RasterTileBuffer, CellsBeyondTheBorderOccludeToo) {
  const auto tile = empty_canvas(43, 29);
  tile->draw(square({0, 42, 0, 28}, 0.5F, 1));
  tile->mark_stale({0, 42, 0, 28});
  EXPECT_TRUE(tile->is_occluded({30, 42, 15, 28}, 0.4F));
}

constexpr PixelBounds kAll{0, 59, 0, 49};

const Nearness& nearness() {
  static const Nearness between({.near_m = 1.0, .far_m = 20.0});
  return between;
}

/// Distance of a pixel from the edges of a triangle in front of the sensor, pixels; positive
/// inside.
double inside_px(const Eigen::Matrix3d& corners, int col, int row) {
  Eigen::Matrix<double, 2, 3> projections = corners.colwise().hnormalized();
  const Eigen::Vector2d e1 = projections.col(1) - projections.col(0);
  const Eigen::Vector2d e2 = projections.col(2) - projections.col(0);
  if (e1.x() * e2.y() - e1.y() * e2.x() < 0.0) projections.col(1).swap(projections.col(2));
  double smallest = 1e9;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector2d edge = projections.col((k + 1) % 3) - projections.col(k);
    const Eigen::Vector2d from = Eigen::Vector2d(col, row) - projections.col(k);
    smallest = std::min(smallest, (edge.x() * from.y() - edge.y() * from.x()) / edge.norm());
  }
  return smallest;
}

/// Nearness where a pixel's beam hits the triangle's plane.
double nearness_at(const Eigen::Matrix3d& corners, int col, int row) {
  const Eigen::Vector3d normal =
      (corners.col(1) - corners.col(0)).cross(corners.col(2) - corners.col(0));
  const double depth = normal.dot(corners.col(0)) / normal.dot(Eigen::Vector3d(col, row, 1.0));
  return nearness().at(depth);
}

/// Sixteen triangles of about one size, in the tile and around it; column k: corner k as (column,
/// row, 1) times depth.
std::array<Eigen::Matrix3d, kLanes> triangles(double size_px, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> tile(-1.0, 1.0);
  std::array<Eigen::Matrix3d, kLanes> all;
  for (Eigen::Matrix3d& corners : all) {
    const Eigen::Vector2d middle(30.0 + 33.0 * tile(random), 25.0 + 28.0 * tile(random));
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector2d projection =
          middle + size_px * Eigen::Vector2d(tile(random), tile(random));
      corners.col(k) = (8.0 + tile(random)) * projection.homogeneous();
    }
  }
  return all;
}

/// The same for single precision, relative to a middle.
TileTransform tile_transform(const std::array<Eigen::Matrix3d, kLanes>& all, CornerBlock& corners) {
  const Eigen::Vector3d middle(8.0 * 30.0, 8.0 * 25.0, 8.0);
  for (unsigned i = 0; i < kLanes; ++i) {
    corners.c0.set(i, (all[i].col(0) - middle).cast<float>());
    corners.c1.set(i, (all[i].col(1) - middle).cast<float>());
    corners.c2.set(i, (all[i].col(2) - middle).cast<float>());
  }
  return {.matrix = {1.0F, 0.0F, 0.0F, 0.0F, 1.0F, 0.0F, 0.0F, 0.0F, 1.0F},
          .column = static_cast<float>(middle.x()),
          .row = static_cast<float>(middle.y()),
          .depth = static_cast<float>(middle.z()),
          .before_far = static_cast<float>(nearness().far_m - middle.z()),
          .factor = static_cast<float>(nearness().factor),
          .min_depth = 1.0F,
          .last_col = static_cast<float>(kAll.right),
          .last_row = static_cast<float>(kAll.bottom),
          .cull_back_faces = false};
}

/// The coverage of a pixel by a setup.
struct PixelCoverage {
  bool coverage;
  bool certain;
  double nearness;
};

PixelCoverage coverage_at(const TriangleSetup& s, int col, int row) {
  const auto across = static_cast<float>(col - s.rect.left);
  const auto down = static_cast<float>(row - s.rect.top);
  PixelCoverage pixel{
      .coverage =
          col >= s.rect.left && col <= s.rect.right && row >= s.rect.top && row <= s.rect.bottom,
      .certain = true,
      .nearness = static_cast<double>(s.nearness_at_corner + s.nearness_per_col * across +
                                      s.nearness_per_row * down)};
  for (std::size_t k = 0; k < 3; ++k) {
    const float edge = s.at_corner[k] + s.per_col[k] * across + s.per_row[k] * down;
    pixel.coverage = pixel.coverage && edge >= 0.0F;
    pixel.certain = pixel.certain && edge >= s.certain[k];
  }
  return pixel;
}

/// Pixels inside are covered, those clearly outside are not, and certain ones are inside.
void expect_correct(const PixelCoverage& pixel, const Eigen::Matrix3d& corners, int col, int row) {
  const double inside = inside_px(corners, col, row);
  // The margin is along the larger of row and column, up to sqrt(2) times as wide; twice for
  // rounding.
  constexpr double kClear_px = 3.0 * static_cast<double>(kEdgeMargin_px);
  if (inside >= 0.0) {
    EXPECT_TRUE(pixel.coverage) << inside;
  }
  if (inside < -kClear_px) {
    EXPECT_FALSE(pixel.coverage) << inside;
  }
  if (!pixel.coverage) return;
  if (pixel.certain) {
    EXPECT_GE(inside, 0.0);
  }
  EXPECT_TRUE(pixel.certain || inside < kClear_px) << inside;
  EXPECT_NEAR(pixel.nearness, nearness_at(corners, col, row), 1e-6);
}

TEST(RasterTriangleSetup, CoversThePixelsWhoseBeamsHitTheTriangles) {
  std::size_t covered_pixels = 0;
  for (const double size_px : {0.4, 1.5, 5.0, 20.0}) {
    for (unsigned seed = 0; seed < 40; ++seed) {
      const auto all = triangles(size_px, seed);
      CornerBlock corners;
      const TileTransform transform = tile_transform(all, corners);
      TriangleSetups setups;
      set_up_triangles(transform, corners, setups);
      Lanes<std::uint32_t> coverage;
      const std::uint32_t pending = coverage_masks(setups, coverage);
      for (unsigned lane = 0; lane < kLanes; ++lane) {
        const auto size = static_cast<SizeClass>(setups.size[lane]);
        ASSERT_NE(size, SizeClass::large);
        const TriangleSetup setup = setups.setup(lane, 0);
        for (int row = 0; row <= kAll.bottom; ++row) {
          for (int col = 0; col <= kAll.right; ++col) {
            PixelCoverage pixel =
                size == SizeClass::none ? PixelCoverage{} : coverage_at(setup, col, row);
            if (size == SizeClass::small) {
              const int bit = (row - setup.rect.top) * kSmall + col - setup.rect.left;
              const bool is_in = pixel.coverage;
              pixel.coverage = is_in && (coverage[lane] >> bit & 1U) != 0;
              pixel.certain = is_in && (coverage[lane] >> (bit + 16) & 1U) != 0;
              EXPECT_EQ(pixel.coverage, is_in);
            }
            expect_correct(pixel, all[lane], col, row);
            if (pixel.coverage) {
              ++covered_pixels;
              EXPECT_NE(pending >> lane & 1U, 0U);
            }
          }
        }
      }
    }
  }
  EXPECT_GT(covered_pixels, 50'000U);
}

TEST(RasterTriangleSetup, DoublePrecisionCoversTheSamePixels) {
  for (const double size_px : {5.0, 20.0, 400.0}) {
    for (const Eigen::Matrix3d& corners : triangles(size_px, 9)) {
      const std::optional<TriangleSetup> setup = set_up_triangle(corners, nearness(), kAll, false);
      for (int row = 0; row <= kAll.bottom; ++row) {
        for (int col = 0; col <= kAll.right; ++col) {
          expect_correct(setup ? coverage_at(*setup, col, row) : PixelCoverage{}, corners, col,
                         row);
        }
      }
    }
  }
}

TEST(RasterTriangleSetup, AcceptsCornersBehindTheSensor) {
  // A floor 1 m below the sensor, from 30 m behind to 40 m ahead: below the horizon all is covered.
  const double focal_px = 30.0;
  const Eigen::Vector2d centre(30.0, 25.0);
  const auto pixel = [&](const Eigen::Vector3d& p) {
    return Eigen::Vector3d(focal_px * p.x() + centre.x() * p.z(),
                           focal_px * p.y() + centre.y() * p.z(), p.z());
  };
  Eigen::Matrix3d corners;
  corners << pixel({-90.0, 1.0, -30.0}), pixel({90.0, 1.0, -30.0}), pixel({0.0, 1.0, 40.0});
  const std::optional<TriangleSetup> setup = set_up_triangle(corners, nearness(), kAll, false);
  ASSERT_TRUE(setup);
  for (int row = 0; row <= kAll.bottom; ++row) {
    for (int col = 0; col <= kAll.right; ++col) {
      const double depth = focal_px / (row - centre.y());  // where the beam meets the floor
      const double x = (col - centre.x()) / focal_px * depth;
      const double half_width = 90.0 * (40.0 - depth) / 70.0;
      const bool hits = depth > 0.0 && std::abs(x) < half_width;
      const PixelCoverage covered = coverage_at(*setup, col, row);
      EXPECT_EQ(covered.coverage, hits) << col << ' ' << row;
      if (hits) {
        EXPECT_NEAR(covered.nearness, nearness().at(depth), 1e-5);
      }
    }
  }
}

TEST(RasterTriangleSetup, CullsBackFacesOnRequest) {
  const auto all = triangles(6.0, 1);
  CornerBlock corners;
  TileTransform transform = tile_transform(all, corners);
  TriangleSetups both;
  TriangleSetups culled;
  set_up_triangles(transform, corners, both);
  transform.cull_back_faces = true;
  set_up_triangles(transform, corners, culled);
  std::size_t dropped = 0;
  for (unsigned lane = 0; lane < kLanes; ++lane) {
    const bool is_back = all[lane].determinant() > 0.0;
    const bool was_there = both.size[lane] != static_cast<int>(SizeClass::none);
    EXPECT_EQ(culled.size[lane] != static_cast<int>(SizeClass::none), was_there && !is_back);
    dropped += static_cast<std::size_t>(was_there && is_back);
    if (is_back) {
      EXPECT_FALSE(set_up_triangle(all[lane], nearness(), kAll, true));
    }
  }
  EXPECT_GT(dropped, 2U);
}

TEST(RasterTriangleSetup, UsesDoublePrecisionWhereSingleIsNotSufficient) {
  auto all = triangles(5.0, 2);
  all[0].col(1) *= -1.0;                                     // behind
  all[1].col(2) = 8.0 * Eigen::Vector3d(4000.0, 20.0, 1.0);  // far beside the tile
  all[1].col(0) = 8.0 * Eigen::Vector3d(20.0, 20.0, 1.0);
  all[2].col(0) = 0.5 * Eigen::Vector3d(30.0, 20.0, 1.0);  // nearer than its cluster allows
  CornerBlock corners;
  const TileTransform transform = tile_transform(all, corners);
  TriangleSetups setups;
  set_up_triangles(transform, corners, setups);
  for (unsigned lane = 0; lane < 3; ++lane) {
    EXPECT_EQ(setups.size[lane], static_cast<int>(SizeClass::large)) << lane;
  }
}

}  // namespace

}  // namespace glidar::raster
