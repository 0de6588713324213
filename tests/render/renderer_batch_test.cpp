// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// A batch of casts equals single casts, in every renderer.
#include <render/renderer_suite.hpp>
#include <support/error_text.hpp>

#include <atomic>
#include <cstring>
#include <stdexcept>

namespace glidar {
namespace {

using testing::builtin_scene;
using testing::camera_beams;
using testing::Draws;
using testing::turned;

class RendererBatch : public testing::RendererSuite {
 protected:
  RendererBatch() {
    add_model(scene_, make_builtin_model("box"));
    scene_.instances[1].world_from_object = turned(0.4, {0.2, 0.5, 1.0}, {2.5, 0.0, 0.0});
    scene_.instances[1].scale = 0.3;
  }

  /// A view of the scene from a random side; every fifth looks away from it.
  Pose next_pose() {
    const Eigen::Vector3d eye = (3.0 + 20.0 * draws_.next()) * draws_.direction();
    const bool is_away = count_++ % 5 == 4;
    return look_at(eye, is_away ? Eigen::Vector3d(2.0 * eye) : Eigen::Vector3d::Zero(),
                   draws_.direction());
  }

  void add(const Beams& beams) {
    requests_.push_back(
        {.beams = beams, .world_from_sensor = next_pose(), .hit_columns = kAllHitColumns});
  }

  /// Casts a batch, then each request alone, and compares every bit of every column.
  void expect_as_one_by_one() {
    const std::unique_ptr<Renderer> one = renderer(scene_);
    std::vector<Hits> together(requests_.size());
    std::vector<Hits*> hits;
    for (Hits& h : together) hits.push_back(&h);
    one->cast_batch(requests_, hits);
    std::size_t found = 0;
    for (std::size_t i = 0; i < requests_.size(); ++i) {
      Hits alone;
      renderer_alone(*one, requests_[i], alone);
      expect_same(together[i], alone, i);
      for (const std::uint32_t instance : alone.instance) found += instance != kInvalidId ? 1 : 0;
    }
    EXPECT_GT(found, 20U * requests_.size());
  }

  static void renderer_alone(Renderer& one, CastRequest request, Hits& hits) {
    request.on_tile_done = {};
    request.progress = {};
    one.cast(request, hits);
  }

  static void expect_same(const Hits& a, const Hits& b, std::size_t i) {
    const auto same = [](const auto& x, const auto& y) {
      return x.size() == y.size() && std::memcmp(x.data(), y.data(), x.size() * sizeof(x[0])) == 0;
    };
    EXPECT_TRUE(same(a.range_m, b.range_m)) << "cast " << i;
    EXPECT_EQ(a.instance, b.instance) << "cast " << i;
    EXPECT_EQ(a.primitive, b.primitive) << "cast " << i;
    EXPECT_TRUE(same(a.depth_m, b.depth_m)) << "cast " << i;
    EXPECT_TRUE(same(a.normal, b.normal)) << "cast " << i;
    EXPECT_TRUE(same(a.shading_normal, b.shading_normal)) << "cast " << i;
    EXPECT_TRUE(same(a.reflectance, b.reflectance)) << "cast " << i;
    EXPECT_TRUE(same(a.object_point_m, b.object_point_m)) << "cast " << i;
  }

  Scene scene_ = builtin_scene("asteroid");
  Draws draws_{6};
  int count_ = 0;
  std::vector<CastRequest> requests_;
};

TEST_P(RendererBatch, ManySmallViewsOfOneSizeEqualSingleCasts) {
  const Beams beams = camera_beams(64, 64, 60.0);
  for (int i = 0; i < 70; ++i) add(beams);  // many tiles
  expect_as_one_by_one();
}

TEST_P(RendererBatch, ViewsOfManySizesEqualSingleCasts) {
  const std::vector<Beams> sizes = {camera_beams(61, 43, 50.0), camera_beams(128, 128, 90.0),
                                    camera_beams(33, 200, 40.0)};
  for (std::size_t i = 0; i < 15; ++i) add(sizes[i % sizes.size()]);
  for (std::size_t i = 0; i < 15; ++i) add(sizes[i / 5]);
  expect_as_one_by_one();
}

TEST_P(RendererBatch, LargeAndSmallViewsEqualSingleCasts) {
  const Beams small = camera_beams(100, 80, 90.0);
  const Beams large = camera_beams(700, 300, 300.0);
  for (const Beams* beams : {&small, &large, &large, &small, &small}) add(*beams);
  expect_as_one_by_one();
}

TEST_P(RendererBatch, EveryCastHasItsOwnPosesFieldsAndCulling) {
  const Beams beams = camera_beams(50, 50, 45.0);
  for (int i = 0; i < 6; ++i) add(beams);
  const std::vector<Pose> poses = {turned(0.5, {1.0, 0.0, 0.0}, {0.3, 0.0, 0.0}), next_pose()};
  const std::vector<std::uint8_t> present = {1, 0};
  requests_[1].world_from_instance = poses;
  requests_[2].hit_columns = {};
  requests_[3].cull_back_faces = true;
  requests_[5].instance_enabled = present;
  expect_as_one_by_one();
}

TEST_P(RendererBatch, ReportsTheBeamsAndProgressOfEveryCast) {
  const Beams beams = camera_beams(40, 30, 35.0);
  constexpr std::size_t kCasts = 7;
  std::vector<std::vector<std::atomic<int>>> report_count;
  std::vector<double> progress(kCasts, 0.0);
  for (std::size_t i = 0; i < kCasts; ++i) report_count.emplace_back(beams.size());
  const auto counter = [&](std::size_t i) {
    return [&report_count, i](BeamRange range) {
      for (std::size_t b = range.begin; b < range.end; ++b) ++report_count[i][b];
    };
  };
  std::vector<decltype(counter(0))> counters;
  for (std::size_t i = 0; i < kCasts; ++i) counters.push_back(counter(i));
  for (std::size_t i = 0; i < kCasts; ++i) {
    add(beams);
    requests_.back().on_tile_done = FunctionRef<void(BeamRange)>(counters[i]);
    requests_.back().progress = [&progress, i](double part) { progress[i] = part; };
  }
  std::vector<Hits> all(kCasts);
  std::vector<Hits*> hits;
  for (Hits& h : all) hits.push_back(&h);
  renderer(scene_)->cast_batch(requests_, hits);
  for (std::size_t i = 0; i < kCasts; ++i) {
    for (const std::atomic<int>& times : report_count[i]) EXPECT_EQ(times, 1) << "cast " << i;
    EXPECT_EQ(progress[i], 1.0) << "cast " << i;
  }
}

TEST_P(RendererBatch, AnAbortedCastDoesNotAffectTheNext) {
  const Beams beams = camera_beams(40, 30, 35.0);
  for (int i = 0; i < 3; ++i) add(beams);
  const std::unique_ptr<Renderer> one = renderer(scene_);
  const auto breaking = [](BeamRange /*range*/) { throw std::runtime_error("enough"); };
  std::vector<Hits> all(requests_.size());
  std::vector<Hits*> hits;
  for (Hits& h : all) hits.push_back(&h);
  std::vector<CastRequest> broken(requests_.begin(), requests_.end());
  broken[1].on_tile_done = FunctionRef<void(BeamRange)>(breaking);
  EXPECT_THROW(one->cast_batch(broken, hits), std::runtime_error);
  one->cast_batch(requests_, hits);
  Hits expected;
  renderer(scene_)->cast(requests_[2], expected);
  expect_same(all[2], expected, 2);
}

TEST_P(RendererBatch, AnEmptyBatchIsAccepted) {
  renderer(scene_)->cast_batch({}, {});
}

TEST_P(RendererBatch, RejectsAWrongNumberOfHits) {
  const Beams beams = camera_beams(4, 4, 4.0);
  add(beams);
  EXPECT_EQ(error_text([&] { renderer(scene_)->cast_batch(requests_, {}); }),
            "batch of casts: hits for 0 of 1 casts; allowed: hits for each cast");
}

INSTANTIATE_TEST_SUITE_P(All, RendererBatch, ::testing::ValuesIn(renderer_kinds()),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace glidar
