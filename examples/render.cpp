// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/glidar.hpp>

#include <cstdio>
#include <string>
#include <vector>

namespace {

/// A 512 x 512 depth camera looks at a rock from 6 m.
void render(const std::string& path) {
  // [README]
  glidar::Scene scene;
  glidar::add_model(scene, glidar::load_model("builtin:asteroid", {}, {}));
  glidar::Sensor sensor;
  sensor.optics = glidar::pinhole_from_fov(512, 512, 0.4);  // radians
  glidar::Simulator simulator(scene, sensor);
  const glidar::Frame frame = simulator.simulate(glidar::look_at({6, 0, 2}, {0, 0, 0}));

  const std::vector<std::string> columns = {"xyz", "intensity"};
  glidar::PointCloud cloud;
  glidar::make_point_cloud(frame, *simulator.beams(), scene, {frame.frame_id}, columns, cloud);
  glidar::make_file_sink(path, {}, {scene, sensor, *simulator.beams(), "auto"})
      ->write(cloud, frame);
  // [README]
}

}  // namespace

int main() {
  try {
    render("rock.pcd");
  } catch (const glidar::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
