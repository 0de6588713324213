// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Trees, packets and filters in single precision find the same hits as the hit rule applied to all
// triangles of all instances.
#include <glidar/render/rays/scene_search.hpp>

#include <glidar/math/constants.hpp>
#include <glidar/render/rays/exact_test.hpp>
#include <render/rays/instance_spheres.hpp>
#include <render/renderer_suite.hpp>

#include <gmock/gmock.h>

#include <algorithm>
#include <array>

namespace glidar {
namespace {

using testing::builtin_scene;
using testing::camera_beams;
using testing::Draws;
using testing::loose_beams;
using testing::Sphere;
using testing::turned;

/// A scene, a cast and its search.
class Stage {
 public:
  Scene scene;
  Beams beams;
  Pose world_from_sensor;
  bool cull_back_faces;
  std::vector<std::uint8_t> present = {};
  std::vector<InstanceRange> targets = {};

  Stage(Scene all, Beams some, const Pose& pose, bool culls = false)
      : scene(std::move(all)),
        beams(std::move(some)),
        world_from_sensor(pose),
        cull_back_faces(culls),
        resolver_(scene),
        thread_pool_(2),
        search_(resolver_, thread_pool_) {}

  /// Searches all beams, 16 at a time and one by one; expects no difference.
  std::vector<PrimitiveRef> search() {
    prepare();
    std::vector<PrimitiveRef> found(beams.size());
    for (std::size_t first = 0; first < beams.size(); first += kLanes) find(first, found);
    for (std::size_t i = 0; i < beams.size(); ++i) {
      EXPECT_EQ(search_.beams().find(i), found[i]) << "beam " << i;
    }
    return found;
  }

  /// The same by the rule alone: the smallest distance, then the lowest of those that tie with it.
  std::vector<PrimitiveRef> search_by_rule() {
    prepare();
    std::vector<PrimitiveRef> found(beams.size());
    const std::vector<Sphere> spheres = testing::spheres_around(scene, world_from_sensor);
    for (std::size_t i = 0; i < beams.size(); ++i) found[i] = nearest_of_all(i, spheres);
    return found;
  }

  /// The groups of instances of the last search.
  std::size_t groups() const { return search_.trees().groups().size(); }
  /// The instances that the last search could meet.
  std::size_t searched() const { return search_.trees().instances().size(); }

  std::size_t hits(const std::vector<PrimitiveRef>& found) const {
    return found.size() -
           static_cast<std::size_t>(std::count(found.begin(), found.end(), PrimitiveRef{}));
  }

 private:
  void prepare() {
    request_.emplace(CastRequest{.beams = beams,
                                 .world_from_sensor = world_from_sensor,
                                 .cull_back_faces = cull_back_faces,
                                 .instance_enabled = present,
                                 .targets = targets});
    resolver_.set_poses(world_from_sensor, {});
    search_.prepare(*request_);
  }

  void find(std::size_t first, std::vector<PrimitiveRef>& found) const {
    HitBlock block;
    BeamBlock lanes;
    lanes.has_origins = !beams.origins_m.empty();
    block.mask = 0;
    for (unsigned lane = 0; lane < kLanes; ++lane) {
      const std::size_t beam = std::min(first + lane, beams.size() - 1);
      block.mask |= static_cast<std::uint32_t>(first + lane < beams.size()) << lane;
      block.beam[lane] = beam;
      lanes.direction.set(lane, beams.directions[beam]);
      if (lanes.has_origins) lanes.origin_m.set(lane, beams.origins_m[beam]);
    }
    search_.beams().find(lanes, block);
    for (unsigned lane = 0; lane < kLanes; ++lane) {
      if ((block.mask >> lane & 1U) == 0) continue;
      found[block.beam[lane]] = {block.instance[lane], block.primitive[lane]};
    }
  }

  struct Candidate {
    PrimitiveRef found;
    double distance_m;
  };

  [[nodiscard]] PrimitiveRef nearest_of_all(std::size_t beam,
                                            const std::vector<Sphere>& spheres) const {
    const rays::CastView cast{search_.trees(), resolver_, *request_};
    const Eigen::Vector3d start_m =
        world_from_sensor *
        (beams.origins_m.empty() ? Eigen::Vector3d::Zero() : beams.origins_m[beam]);
    const Eigen::Vector3d direction = world_from_sensor.linear() * beams.directions[beam];
    std::vector<Candidate> all;
    for (std::uint32_t instance = 0; instance < scene.instances.size(); ++instance) {
      if (!present.empty() && present[instance] == 0) continue;
      if (!targets.empty() && (instance < targets[beam].begin || instance >= targets[beam].end))
        continue;
      if (is_beside(spheres[instance], start_m, direction)) continue;
      const Mesh& mesh = resolver_.mesh(instance);
      for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const double distance_m = rays::hit_distance_m(cast, beam, {instance, t});
        if (!(distance_m > 0.0)) continue;
        if (!blocks_beam(resolver_, beams, beam, cull_back_faces, {instance, t})) continue;
        all.push_back({{instance, t}, distance_m});
      }
    }
    if (all.empty()) return {};
    const auto is_before = [](const Candidate& a, const Candidate& b) {
      return is_nearer({a.distance_m, a.found.instance, a.found.primitive},
                       {b.distance_m, b.found.instance, b.found.primitive});
    };
    const Candidate nearest = *std::min_element(all.begin(), all.end(), is_before);
    PrimitiveRef lowest = nearest.found;
    for (const Candidate& c : all) {
      const double reach_m = 0.5 * (search_.trees().reach_m(nearest.found.instance) +
                                    search_.trees().reach_m(c.found.instance));
      const double window_m = std::min(rays::tie_window_m(cast, beam, c.found, reach_m),
                                       rays::tie_window_m(cast, beam, nearest.found, reach_m));
      const bool ties = c.distance_m - nearest.distance_m <= window_m;
      if (ties && is_lower(c.found, lowest)) lowest = c.found;
    }
    return lowest;
  }

  Resolver resolver_;
  ThreadPool thread_pool_;
  rays::SceneSearch search_;
  std::optional<CastRequest> request_;
};

/// Bodies of many sizes around a point of the world.
Scene crowd(std::size_t count, std::uint64_t seed, const Eigen::Vector3d& middle_m) {
  Draws draws(seed);
  Scene scene = builtin_scene("box");
  add_model(scene, make_builtin_model("torus"));
  const std::vector<Instance> models = scene.instances;
  scene.instances.clear();
  for (std::size_t i = 0; i < count; ++i) {
    Instance instance = models[i % 8 == 0 ? 1 : 0];
    instance.scale = std::pow(10.0, -1.0 + 2.0 * draws.next());
    const Eigen::Vector3d at_m(draws.next() - 0.5, draws.next() - 0.5, draws.next() - 0.5);
    instance.world_from_object =
        turned(6.0 * draws.next(), draws.direction(), middle_m + 60 * at_m);
    scene.instances.push_back(instance);
  }
  return scene;
}

/// Beams from one point or many, in related or unrelated directions.
Beams some_beams(std::size_t count, bool has_origins, bool is_coherent, std::uint64_t seed) {
  Draws draws(seed);
  std::vector<Eigen::Vector3d> directions;
  std::vector<Eigen::Vector3d> origins;
  Eigen::Vector3d middle = draws.direction();
  for (std::size_t i = 0; i < count; ++i) {
    if (i % 16 == 0) middle = draws.direction();
    directions.push_back(is_coherent ? (middle + 0.05 * draws.direction()).normalized()
                                     : draws.direction());
    if (has_origins) origins.push_back(0.3 * draws.direction());
  }
  return loose_beams(directions, origins);
}

TEST(BeamSearch, SingleRaysHaveTheBitsOfBlocks) {
  Scene scene = builtin_scene("box");
  scene.instances[0].scale = 0.7;
  const Beams beams = some_beams(kLanes, true, false, 19);
  BeamBlock block;
  block.has_origins = true;
  for (unsigned i = 0; i < kLanes; ++i) {
    block.direction.set(i, beams.directions[i]);
    block.origin_m.set(i, beams.origins_m[i]);
  }
  for (int step = 0; step < 20; ++step) {
    const InstanceView view = view_of(scene.instances[0], scene.meshes[0], Pose::Identity(),
                                      turned(0.1 + step, {1, 2, 3}, {0.3, 7.0, -2.0}));
    Lanes3<double> origin;
    Lanes3<double> direction;
    rays_in(view, block, origin, direction);
    for (unsigned i = 0; i < kLanes; ++i) {
      const ObjectRay ray = ray_in(view, beams, i);
      EXPECT_EQ(ray.origin, origin.get(i));
      EXPECT_EQ(ray.direction, direction.get(i));
    }
  }
}

TEST(BeamSearch, EqualsTheRuleAmongManyInstances) {
  for (const bool has_origins : {false, true}) {
    for (const bool is_coherent : {false, true}) {
      const std::uint64_t seed = 2 * static_cast<unsigned>(has_origins) + 1;
      Stage stage(crowd(40, seed, Eigen::Vector3d::Zero()),
                  some_beams(320, has_origins, is_coherent, seed), Pose::Identity());
      const std::vector<PrimitiveRef> found = stage.search();
      EXPECT_GT(stage.hits(found), 30U);
      EXPECT_EQ(found, stage.search_by_rule());
    }
  }
}

TEST(BeamSearch, IsExactAMillionKilometresFromTheWorldsOrigin) {
  const Eigen::Vector3d far_m(1e9, -2e9, 5e8);
  Stage stage(crowd(60, 3, far_m), some_beams(400, true, true, 4),
              turned(0.3, {1, 2, 3}, far_m + Eigen::Vector3d(1.0, 2.0, 3.0)));
  const std::vector<PrimitiveRef> found = stage.search();
  EXPECT_GT(stage.hits(found), 80U);
  EXPECT_EQ(found, stage.search_by_rule());
}

TEST(BeamSearch, IsExactForSmallAndDistantAmongLargeAndNearObjects) {
  Scene scene = crowd(20, 5, Eigen::Vector3d::Zero());
  for (const auto& [scale, distance_m] : {std::pair{6.4e6, 6.5e6}, {1e-3, 8.0}, {50.0, 1e5}}) {
    Instance instance = scene.instances[0];  // a torus: many triangles
    instance.scale = scale;
    instance.world_from_object = turned(1.0, {1, 1, 0}, {0.0, 0.0, distance_m});
    scene.instances.push_back(instance);
  }
  Stage stage(scene, camera_beams(32, 32, 24.0), Pose::Identity());
  const std::vector<PrimitiveRef> found = stage.search();
  EXPECT_GT(stage.hits(found), 500U);
  EXPECT_EQ(found, stage.search_by_rule());
}

TEST(BeamSearch, SkipsDisabledInstancesAndCullsBackFaces) {
  for (const bool culls : {false, true}) {
    Stage stage(crowd(40, 6, Eigen::Vector3d::Zero()), some_beams(320, false, true, 7),
                Pose::Identity(), culls);
    stage.present.assign(40, 1);
    for (std::size_t i = 0; i < 40; i += 3) stage.present[i] = 0;
    const std::vector<PrimitiveRef> found = stage.search();
    for (const PrimitiveRef& f : found)
      EXPECT_TRUE(f.instance == kInvalidId || f.instance % 3 != 0);
    EXPECT_EQ(found, stage.search_by_rule());
  }
}

TEST(BeamSearch, FindsOnlyTheTargetsOfABeam) {
  for (const bool culls : {false, true}) {
    Stage stage(crowd(40, 6, Eigen::Vector3d::Zero()), some_beams(1600, true, true, 7),
                Pose::Identity(), culls);
    (void)stage.search();  // leaves trees over all instances
    Draws draws(9);
    InstanceRange target;
    for (std::uint32_t i = 0; i < stage.beams.size(); ++i) {
      if (i % 5 == 0) {  // not aligned with packets
        target.begin = static_cast<std::uint32_t>(38.0 * draws.next());
        target.end = i % 2 == 0 ? target.begin + 1 : 40;
      }
      stage.targets.push_back(target);
    }
    const std::vector<PrimitiveRef> found = stage.search();
    EXPECT_GT(stage.hits(found), 15U);
    EXPECT_EQ(found, stage.search_by_rule());
    stage.targets.clear();
    EXPECT_EQ(stage.search(), stage.search_by_rule()) << "without targets again";
  }
}

TEST(BeamSearch, ReportsTheLowestOfCoincidentTilesAmongTheTargets) {
  Scene scene = builtin_scene("plane");
  scene.instances.resize(12, scene.instances[0]);
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const double quarter = 0.5 * std::numbers::pi * static_cast<double>(i % 4);
    scene.instances[i].world_from_object =
        turned(0.4, {1.0, 2.0, 0.5}, {3.0, 1.0, 2.0}) *
        turned(quarter, Eigen::Vector3d::UnitZ(), Eigen::Vector3d::Zero());
  }
  Stage stage(scene, some_beams(2000, true, false, 11), Pose::Identity());
  stage.targets.assign(stage.beams.size(), {5, 9});
  const std::vector<PrimitiveRef> found = stage.search();
  EXPECT_GT(stage.hits(found), 10U);
  EXPECT_EQ(found, stage.search_by_rule());
  for (const PrimitiveRef& f : found) EXPECT_TRUE(f.instance == kInvalidId || f.instance == 5);
}

TEST(BeamSearch, ReportsTheLowestOfCoincidentTiles) {
  // The same square with other triangles and poses: distances differ by rounding.
  Scene scene = builtin_scene("plane");
  const Instance one = scene.instances[0];
  Draws draws(8);
  scene.instances.clear();
  for (int i = 0; i < 12; ++i) {
    Instance instance = one;
    const double quarter = 0.5 * std::numbers::pi * (i % 4);
    instance.world_from_object = turned(0.4, {1.0, 2.0, 0.5}, {3.0, 1.0, 2.0}) *
                                 turned(quarter, Eigen::Vector3d::UnitZ(), Eigen::Vector3d::Zero());
    scene.instances.push_back(instance);
  }
  const Eigen::Vector3d eye = {5.0, 2.0, 7.0};
  Stage stage(scene, camera_beams(50, 50, 60.0),
              look_at(eye, {3.0, 1.0, 2.0}, Eigen::Vector3d::UnitZ()));
  const std::vector<PrimitiveRef> found = stage.search();
  EXPECT_GT(stage.hits(found), 400U);
  for (const PrimitiveRef& f : found) EXPECT_TRUE(f.instance == 0 || f.instance == kInvalidId);
  EXPECT_EQ(found, stage.search_by_rule());
}

TEST(BeamSearch, IsExactWithInstancesAtVastlyDifferentDistances) {
  for (const bool has_origins : {false, true}) {
    Scene scene = crowd(40, 17, Eigen::Vector3d::Zero());
    for (const double distance_m : {1e11, 3e11, 1e8, 2e14}) {
      Instance instance = scene.instances[0];  // a torus: many triangles
      instance.scale = 0.1 * distance_m;
      instance.world_from_object = turned(1.0, {1, 1, 0}, {0.0, 0.0, distance_m});
      scene.instances.push_back(instance);
    }
    std::rotate(scene.instances.begin(), scene.instances.end() - 3, scene.instances.end());
    Stage stage(scene, some_beams(960, has_origins, true, 18), Pose::Identity());
    const std::vector<PrimitiveRef> found = stage.search();
    EXPECT_EQ(stage.groups(), 3U);
    EXPECT_GT(stage.hits(found), 60U);
    EXPECT_EQ(found, stage.search_by_rule());
  }
}

/// Squares of very different sizes on a plane, and one of 2 m at this height above it. Sizes are
/// powers of two, so that distances to the plane are the same bit for bit.
std::vector<Instance> squares_of_all_sizes(const Instance& square, double height_m) {
  std::vector<Instance> squares(4, square);
  squares[1].scale = 0x1p30;
  squares[2].scale = 0x1p55;
  squares[3].world_from_object.translation().z() = height_m;
  return squares;
}

TEST(BeamSearch, ReportsTheLowestOfCoincidentSurfacesOfVastlyDifferentSizes) {
  Scene scene = builtin_scene("plane");
  const Instance square = scene.instances[0];
  scene.instances.resize(4);
  const Pose down = look_at({0.1, 0.2, 8.0}, {0.1, 0.2, 0.0}, Eigen::Vector3d::UnitY());
  const Pose askew = look_at({1.0, 2.0, 9.0}, {0.0, 0.0, 0.0}, Eigen::Vector3d::UnitY());
  std::vector<std::size_t> found_on(4);
  for (const double height_m : {-1e-6, 1e-6, 0.01}) {
    const std::vector<Instance> squares = squares_of_all_sizes(square, height_m);
    std::array<std::size_t, 4> order = {0, 1, 2, 3};
    do {
      for (std::size_t i = 0; i < 4; ++i) scene.instances[i] = squares[order[i]];
      for (const Pose& from : {down, askew}) {
        Stage stage(scene, camera_beams(9, 9, 30.0), from);
        const std::vector<PrimitiveRef> found = stage.search();
        EXPECT_EQ(stage.groups(), 3U);
        EXPECT_EQ(found, stage.search_by_rule()) << height_m;
        for (const PrimitiveRef& f : found) ++found_on[order[f.instance]];
      }
    } while (std::next_permutation(order.begin(), order.end()));
  }
  EXPECT_THAT(found_on, ::testing::Each(::testing::Gt(0U)));
}

/// A square whose halves are connected along its diagonal by a triangle of this width.
Scene stitched_square(float width) {
  Scene scene = builtin_scene("plane");
  Mesh& mesh = scene.meshes[0];
  mesh = Mesh();
  mesh.positions_m = {{-64, -1, 0}, {0, width, 0}, {64, 1, 0}, {0, -64, 0}, {0, 64, 0}};
  mesh.triangles = {{0, 3, 2}, {0, 1, 4}, {1, 2, 4}, {0, 2, 1}};
  return scene;
}

TEST(BeamSearch, NoBeamLeaksAtATriangleWithoutWidth) {
  Draws draws(13);
  for (const float width : {1e-3F, 1e-9F, 1e-11F, 1e-12F, 1e-14F, 1e-30F, 0.0F}) {
    std::vector<Eigen::Vector3d> directions;
    std::vector<Eigen::Vector3d> origins;
    for (int i = 0; i < 4000; ++i) {
      const double at = 20.0 * (draws.next() - 0.5);
      const Eigen::Vector3d target(at, at / 64.0 + width * (draws.next() - 0.5), 0.0);
      const Eigen::Vector3d up(draws.next() - 0.5, draws.next() - 0.5, 0.2 + draws.next());
      origins.push_back(target + (0.5 + 20.0 * draws.next()) * up);
      directions.push_back((target - origins.back()).normalized());
    }
    Stage stage(stitched_square(width), loose_beams(directions, origins), Pose::Identity());
    const std::vector<PrimitiveRef> found = stage.search();
    EXPECT_EQ(stage.hits(found), found.size()) << width;
    EXPECT_EQ(found, stage.search_by_rule()) << width;
  }
}

TEST(BeamSearch, FollowsInstancesAndSensorsThatMove) {
  Stage stage(crowd(30, 9, Eigen::Vector3d::Zero()), some_beams(160, false, true, 10),
              Pose::Identity());
  for (int step = 0; step < 4; ++step) {
    EXPECT_EQ(stage.search(), stage.search_by_rule()) << step;
    stage.world_from_sensor.translation() += Eigen::Vector3d(0.01, 0.4, step * 3.0);
    if (step == 2) stage.scene.instances[3].world_from_object.translation().x() += 2.0;
  }
}

TEST(BeamSearch, FollowsFewMovingInstancesAmongMany) {
  Stage stage(crowd(60, 14, Eigen::Vector3d::Zero()), some_beams(160, false, true, 15),
              Pose::Identity());
  Draws draws(16);
  for (int step = 0; step < 12; ++step) {
    EXPECT_EQ(stage.search(), stage.search_by_rule()) << step;
    for (int i = 0; i < 3; ++i) {
      const auto moved = static_cast<std::size_t>(60.0 * draws.next());
      const double far_m = step == 8 ? 1e6 : 20.0;
      stage.scene.instances[moved].world_from_object =
          turned(6.0 * draws.next(), draws.direction(), far_m * draws.direction());
    }
  }
}

TEST(BeamSearch, CopiesAtOnePlaceAreSearchedOnceAndAppearWhenTheyMove) {
  constexpr std::size_t kCopies = 50'000;
  Scene scene = crowd(30, 9, Eigen::Vector3d::Zero());
  const Beams beams = some_beams(160, false, true, 10);
  const std::vector<PrimitiveRef> found = Stage(scene, beams, Pose::Identity()).search();
  const auto hit = std::find_if(found.begin(), found.end(),
                                [](const PrimitiveRef& f) { return !(f == PrimitiveRef{}); });
  ASSERT_NE(hit, found.end());
  const std::uint32_t copied = hit->instance;
  const Instance original = scene.instances[copied];
  scene.instances.insert(scene.instances.end(), kCopies, original);
  Stage stage(std::move(scene), beams, Pose::Identity());
  EXPECT_EQ(stage.search(), found);
  EXPECT_EQ(stage.searched(), 30U);
  stage.present.assign(stage.scene.instances.size(), 1);
  stage.present[copied] = 0;
  std::vector<PrimitiveRef> without = stage.search();
  EXPECT_EQ(stage.searched(), 30U);
  for (PrimitiveRef& f : without) f.instance = f.instance == 30 ? copied : f.instance;
  EXPECT_EQ(without, found);
}

/// An instance moves away from its copies, then one of these, then an instance to another.
TEST(BeamSearch, CopiesThatMoveAreFollowed) {
  Scene scene = crowd(40, 19, Eigen::Vector3d::Zero());
  for (const std::size_t i : {7U, 7U, 9U}) {
    const Instance copied = scene.instances[i];
    scene.instances.push_back(copied);
  }
  Stage stage(std::move(scene), some_beams(160, false, true, 20), Pose::Identity());
  const std::array<std::pair<std::size_t, std::size_t>, 4> moves = {
      {{7, 3}, {41, 5}, {42, 7}, {1, 2}}};
  EXPECT_EQ(stage.search(), stage.search_by_rule());
  EXPECT_EQ(stage.searched(), 40U);
  for (const auto& [moved, to] : moves) {
    std::vector<Instance>& all = stage.scene.instances;
    all[moved].world_from_object = all[to].world_from_object;
    EXPECT_EQ(stage.search(), stage.search_by_rule()) << moved;
  }
}

TEST(BeamSearch, FindsNothingInAnEmptySceneOrForNanBeams) {
  Scene empty = builtin_scene("box");
  empty.instances.clear();
  Stage none(empty, some_beams(20, false, true, 11), Pose::Identity());
  EXPECT_EQ(none.hits(none.search()), 0U);
  Beams beams = some_beams(32, true, true, 12);
  beams.directions[5].setConstant(kNaN);
  beams.origins_m[9].x() = std::numeric_limits<double>::infinity();
  beams.origins_m[20].y() = 1e200;
  Scene around = builtin_scene("box");
  Stage inside(around, beams, Pose::Identity());
  const std::vector<PrimitiveRef> found = inside.search();
  for (const std::size_t i : {5U, 9U, 20U}) EXPECT_EQ(found[i], PrimitiveRef{}) << i;
  EXPECT_EQ(inside.hits(found), 29U);
}

}  // namespace
}  // namespace glidar
