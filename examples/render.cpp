// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/error.hpp>
#include <glidar/core/point_cloud.hpp>
#include <glidar/io/formats/file_sink.hpp>
#include <glidar/io/model/model.hpp>
#include <glidar/simulate/simulate.hpp>

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
  const glidar::Beams beams = glidar::make_beams(sensor);
  const glidar::Motion motion = glidar::static_motion(
      scene, glidar::look_at({6.0, 0.0, 2.0}, {0.0, 0.0, 0.0}, {0.0, 0.0, 1.0}));
  const auto renderer = glidar::make_renderer(scene, {});
  const std::vector<std::string> columns = {"xyz", "intensity", "normal"};
  glidar::Frame frame;
  glidar::simulate({scene, sensor, beams, motion, *renderer}, glidar::fields_needed_by(columns),
                   frame);
  glidar::PointCloud cloud;
  glidar::make_point_cloud(frame, beams, scene, {.frame_id = beams.frame_id}, columns, cloud);
  glidar::make_file_sink(path, {}, {scene, sensor, beams, "auto"})->write(cloud, frame);
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
