// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause

// The C++ side of bench/python_bench.py: python_baseline MODEL measures, for every word on its
// standard input, "frame" (one of 256x256 beams) or "batch" (100 of them), and prints the seconds
// of processor time that it took, by one thread. Memory is reused, as a loop in C++ would.

#include <glidar/core/point_cloud.hpp>
#include <glidar/io/model/model.hpp>
#include <glidar/simulate/simulator.hpp>

#include <cmath>
#include <cstdio>
#include <ctime>
#include <iostream>
#include <numbers>
#include <string>
#include <vector>

namespace {

constexpr std::uint32_t kSide = 256;
constexpr std::size_t kFrames = 100;
constexpr double kFieldOfView_rad = 20.0 * std::numbers::pi / 180.0;

/// On a circle about the scene, so far away that it fills the view, as in python_bench.py.
std::vector<glidar::Motion> motions(const glidar::Scene& scene) {
  const Eigen::AlignedBox3d box = glidar::bounds(scene);
  const Eigen::Vector3d middle = box.center();
  const double distance_m = 3.0 * box.diagonal().norm();
  std::vector<glidar::Motion> all;
  for (std::size_t k = 0; k < kFrames; ++k) {
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(k) / kFrames;
    const Eigen::Vector3d eye =
        middle + distance_m * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0);
    const glidar::Pose pose = glidar::look_at(eye, middle, Eigen::Vector3d::UnitZ());
    all.push_back(glidar::static_motion(scene, pose));
  }
  return all;
}

double processor_s() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv, argv + argc);
  glidar::Scene scene;
  glidar::add_model(scene, glidar::load_model(arguments.at(1), {}, {}));
  glidar::Sensor sensor;
  sensor.optics = glidar::pinhole_from_fov(kSide, kSide, kFieldOfView_rad);
  glidar::Simulator simulator(scene, sensor, {.threads = 1});
  const std::vector<std::string> columns = {"xyz",    "intensity", "range",
                                            "normal", "instance",  "class"};
  const glidar::HitColumnMask hit_columns = glidar::hit_columns_for(columns);
  const std::vector<glidar::Motion> all = motions(scene);
  std::vector<glidar::Frame> frames(kFrames);
  for (std::string word; std::cin >> word;) {
    const double start_s = processor_s();
    if (word == "frame") {
      simulator.simulate(all.front(), hit_columns, frames.front());
    } else {
      simulator.simulate_batch(all, hit_columns, frames);
    }
    std::printf("%.9f\n", processor_s() - start_s);
    std::fflush(stdout);
  }
  return 0;
}
