// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// How many times faster than real time a frame is simulated, with all default features of a preset:
// footprint, returns and noise. The scene is a textured model, by default the apartment in the
// folder GLIDAR_DATA; the sensor is 1.5 m above its origin.
#include <glidar/io/config/sensor_file.hpp>
#include <glidar/io/config/sensor_presets.hpp>
#include <glidar/io/model/model.hpp>
#include <glidar/simulate/simulator.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <memory>
#include <string>
#include <vector>

namespace glidar::bench {
namespace {

constexpr int kRounds = 15;
constexpr unsigned kThreads = 2;

struct Goal {
  const char* sensor;
  double times;  ///< faster than the sensor
};
constexpr Goal kGoals[] = {{"VLP-16", 12.0}, {"OS1-128", 4.0},   {"Livox-Avia", 12.0},
                           {"D435", 4.0},    {"Kinect-v1", 3.0}, {"Azure-Kinect-NFOV", 3.0}};

/// 1.5 m above the scene's origin, looking along +x.
Pose standing_pose(const Beams& beams) {
  Pose pose = Pose::Identity();
  pose.translation() = Eigen::Vector3d(0.0, 0.0, 1.5);
  const SensorAxes axes = axes_of(beams);
  Eigen::Matrix3d sensor_from_world;
  sensor_from_world << axes.ahead, axes.left, axes.up;
  pose.linear() = sensor_from_world.transpose();
  return pose;
}

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

class Case {
 public:
  Case(const Scene& scene, const Goal& goal)
      : goal_(goal),
        simulator_(scene, load_sensor_file(find_sensor_file(goal.sensor)), {.threads = kThreads}),
        motion_(static_motion(scene, standing_pose(*simulator_.beams()))) {}

  void run() {
    const auto start = std::chrono::steady_clock::now();
    const std::clock_t processor_start = std::clock();
    simulator_.simulate(motion_, {}, frame_);
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    processor_s_.push_back(static_cast<double>(std::clock() - processor_start) / CLOCKS_PER_SEC);
    seconds_.push_back(elapsed.count());
  }

  void print() {
    const double seconds = median(seconds_);
    const auto seen = std::count(frame_.status.begin(), frame_.status.end(), Status::hit);
    const double times = 1.0 / (simulator_.sensor().rate_hz * seconds);
    std::printf("%-20s %9zu %9td %9.2f %9.2f %12.2f %8.1f %s\n", goal_.sensor,
                simulator_.beams()->size(), seen, 1e3 * seconds, times, 1e3 * median(processor_s_),
                goal_.times, times >= goal_.times ? "" : "  below");
  }

 private:
  Goal goal_;
  Simulator simulator_;
  Motion motion_;
  Frame frame_;
  std::vector<double> seconds_;
  std::vector<double> processor_s_;  ///< of all threads; what to compare on a busy machine
};

/// All presets, or the one with this name.
void run(const std::string& model, const std::string& only) {
  Scene scene;
  add_model(scene, load_model(model, {}, {}));
  std::vector<std::unique_ptr<Case>> cases;
  for (const Goal& goal : kGoals) {
    if (only.empty() || only == goal.sensor) cases.push_back(std::make_unique<Case>(scene, goal));
  }
  for (int round = 0; round < kRounds; ++round) {
    for (const auto& one : cases) one->run();
  }
  std::printf("%-20s %9s %9s %9s %9s %12s %8s\n", "sensor", "beams", "hits", "ms", "real time",
              "processor ms", "goal");
  for (const auto& one : cases) one->print();
}

}  // namespace
}  // namespace glidar::bench

int main(int argc, char** argv) {
  const char* data = std::getenv("GLIDAR_DATA");
  if (argc < 2 && data == nullptr) {
    std::fputs("usage: real_time_bench [MODEL [SENSOR]]; without MODEL, set GLIDAR_DATA\n", stderr);
    return 2;
  }
  try {
    glidar::bench::run(
        argc > 1 ? argv[1] : std::string(data) + "/scenes/gazebo/apartment/meshes/apartment.dae",
        argc > 2 ? argv[2] : "");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "real_time_bench: %s\n", error.what());
    return 1;
  }
  return 0;
}
