// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Frames of LiDARs among objects of which some move, and the same with all of them parked.
#include "ratio_reporter.hpp"

#include <glidar/io/config/sensor_file.hpp>
#include <glidar/io/config/sensor_presets.hpp>
#include <glidar/io/model/builtin_models.hpp>
#include <glidar/io/model/model.hpp>
#include <glidar/simulate/simulator.hpp>

#include <cmath>
#include <string>

namespace glidar::bench {
namespace {

constexpr unsigned kThreads = 2;

/// What a sensor sees, and how it moves.
struct Traffic {
  Scene scene;
  Motion motion;
};

/// A row of boxes of 1 m every 3 m, in a square around the sensor, 1.5 m below it. The first
/// `moving` drive at 1 m/s.
Traffic boxes(int count, int moving) {
  Traffic traffic;
  add_model(traffic.scene, make_builtin_model("box"));
  Instance box = traffic.scene.instances[0];
  box.scale = 0.5;
  traffic.scene.instances.clear();
  const int side = static_cast<int>(std::ceil(std::sqrt(count)));
  std::vector<Trajectory> motions;
  for (int i = 0; i < count; ++i) {
    const int row = i / side - side / 2;
    const int column = i % side - side / 2;
    const Eigen::Vector3d place(3.0 * column + 1.5, 3.0 * row + 1.5, 0.0);
    box.world_from_object.translation() = place;
    traffic.scene.instances.push_back(box);
    if (i < moving) {
      motions.emplace_back(
          ConstantTwist{.pose = box.world_from_object, .linear_m_s = Eigen::Vector3d::UnitX()});
    } else {
      motions.emplace_back(ConstantPose{box.world_from_object});
    }
  }
  Pose sensor = Pose::Identity();
  sensor.translation() = Eigen::Vector3d(0.0, 0.0, 1.5);
  traffic.motion = make_motion(traffic.scene, ConstantPose{sensor}, motions);
  return traffic;
}

/// Adds an instance of mesh 0, a box of 2 m, that drives along x.
void add_road_user(Traffic& traffic, const Eigen::Vector3d& size_m, const Eigen::Vector3d& place_m,
                   double speed_m_s) {
  Scene& scene = traffic.scene;
  Instance instance;
  instance.materials = {0};
  instance.id = static_cast<std::uint32_t>(scene.instances.size());
  instance.world_from_object.translation() = place_m;
  scene.instances.push_back(instance);
  set_scale(scene, scene.instances.size() - 1, 0.5 * size_m);
  const Pose pose = scene.instances.back().world_from_object;
  if (speed_m_s == 0.0) {
    traffic.motion.world_from_instance.emplace_back(ConstantPose{pose});
  } else {
    traffic.motion.world_from_instance.emplace_back(
        ConstantTwist{.pose = pose, .linear_m_s = {speed_m_s, 0.0, 0.0}});
  }
}

/// 200 parked and 200 driving cars and 50 people on a street of 1 km between walls; the sensor is
/// on a car at 15 m/s. `drives`: false: all else is parked.
Traffic street(bool drives) {
  const Eigen::Vector3d car_m(4.5, 1.8, 1.5);
  const Eigen::Vector3d person_m(0.4, 0.6, 1.7);
  Traffic traffic;
  add_model(traffic.scene, make_builtin_model("box"));
  const Instance unit = traffic.scene.instances[0];
  traffic.motion.world_from_instance = {ConstantPose{unit.world_from_object}};
  set_scale(traffic.scene, 0, {500.0, 12.0, 0.05});  // the road
  for (const double side : {-1.0, 1.0}) {
    add_road_user(traffic, {1000.0, 0.5, 8.0}, {0.0, 12.0 * side, 4.0}, 0.0);
  }
  for (int i = 0; i < 200; ++i) {
    const double along_m = 5.0 * i - 500.0;
    const double side = i % 2 == 0 ? -1.0 : 1.0;
    add_road_user(traffic, car_m, {along_m, 6.0 * side, 0.8}, 0.0);
    const double lane_m = i % 2 == 0 ? -3.0 : 3.0;
    add_road_user(traffic, car_m, {along_m + 2.0, lane_m, 0.8}, drives ? -5.0 * side : 0.0);
    if (i % 4 == 0) {
      add_road_user(traffic, person_m, {along_m, 9.0 * side, 0.9}, drives ? 1.4 * side : 0.0);
    }
  }
  Pose sensor = Pose::Identity();
  sensor.translation() = Eigen::Vector3d(0.0, 0.0, 2.0);
  traffic.motion.world_from_sensor = ConstantTwist{.pose = sensor, .linear_m_s = {15.0, 0.0, 0.0}};
  return traffic;
}

/// Frames that follow each other.
void register_frames(const Traffic& traffic, const std::string& sensor, bool is_ground_truth,
                     const std::string& name) {
  benchmark::RegisterBenchmark(
      name.c_str(),
      [&traffic, sensor, is_ground_truth](benchmark::State& state) {
        Sensor preset = load_sensor_file(find_sensor_file(sensor));
        if (is_ground_truth) preset = ground_truth_sensor(preset);
        Simulator simulator(traffic.scene, preset, {.kind = "rays", .threads = kThreads});
        const auto period_ns = static_cast<std::int64_t>(1e9 / preset.rate_hz);
        Frame frame;
        for (auto _ : state) {
          simulator.simulate(traffic.motion, {}, frame);
          frame.stamp_ns = (frame.stamp_ns + period_ns) % (100 * period_ns);
        }
      })
      ->UseRealTime()
      ->Unit(benchmark::kMillisecond);
}

int run_all(int argc, char** argv) {
  const Traffic parked = boxes(400, 0);
  const Traffic some = boxes(400, 100);
  const Traffic all = boxes(400, 400);
  const Traffic many_parked = boxes(11'000, 0);
  const Traffic many = boxes(11'000, 1'000);
  const Traffic parked_street = street(false);
  const Traffic driving_street = street(true);
  register_frames(parked, "VLP-16", true, "400 parked");
  register_frames(some, "VLP-16", true, "100 of 400 move");
  register_frames(all, "VLP-16", true, "400 of 400 move");
  register_frames(many_parked, "VLP-16", true, "11,000 parked");
  register_frames(many, "VLP-16", true, "1,000 of 11,000 move");
  for (const std::string& sensor : {std::string("VLP-16"), std::string("OS1-128")}) {
    register_frames(parked_street, sensor, false, sensor + ", parked street");
    register_frames(driving_street, sensor, false, sensor + ", traffic");
  }
  return run(
      argc, argv,
      {{"100 of 400 boxes move / none", "400 parked", "100 of 400 move", 1.0 / 1.5},
       {"400 of 400 boxes move / none", "400 parked", "400 of 400 move", 0.5},
       {"1,000 of 11,000 boxes move / none", "11,000 parked", "1,000 of 11,000 move", 0.5},
       {"VLP-16 in traffic / parked street", "VLP-16, parked street", "VLP-16, traffic", 0.5},
       {"OS1-128 in traffic / parked street", "OS1-128, parked street", "OS1-128, traffic", 0.5}});
}

}  // namespace
}  // namespace glidar::bench

int main(int argc, char** argv) {
  return glidar::bench::run_all(argc, argv);
}
