// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/frame.hpp>
#include <glidar/core/scene.hpp>
#include <glidar/sensor/sensor.hpp>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace glidar {

/// True for the names of new bags: NAME.mcap, NAME.rosbag2 and NAME.bag.
bool is_frame_bag_name(const std::filesystem::path& path);

struct FrameBagOptions {
  std::string layout = {};                ///< of points, see cloud_layouts(); empty: `columns`
  std::vector<std::string> columns = {};  ///< of points; empty: those that suit the sensor
  bool deskew = false;                    ///< points as fired from where the sensor was
};

/// Writes frames of one sensor to a ROS bag, in the order of time, with the topics of docs/bags.md.
/// The bag appears under its name in finish(); without it nothing remains.
class FrameBag {
 public:
  /// Sensor, beams (of frame 0) and scene must outlive it. Throws Error when the suffix is unknown
  /// or nothing can be created in the folder.
  FrameBag(const std::filesystem::path& path, const Scene& scene, const Sensor& sensor,
           const Beams& beams, const FrameBagOptions& options = {});
  ~FrameBag();
  FrameBag(const FrameBag&) = delete;
  FrameBag& operator=(const FrameBag&) = delete;

  /// Throws Error for a frame before 1970, and when the disk is full.
  void write(const Frame& frame, const Beams& beams);
  void finish();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace glidar
