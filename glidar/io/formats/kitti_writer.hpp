// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/frame.hpp>
#include <glidar/core/scene.hpp>
#include <glidar/sensor/sensor.hpp>

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace glidar {

/// A sensor of a rig whose frames are written. The sensor must outlive the writer.
struct KittiSensor {
  const Sensor& sensor;
  Pose rig_from_sensor = Pose::Identity();
};

struct KittiWriterOptions {
  bool deskew = false;                   ///< points as fired from where the sensor was
  std::string renderer;                  ///< for the context of the files
  std::vector<std::string> inputs = {};  ///< files that must not be overwritten
};

/// True for names of KITTI folders, NAME.kitti.
bool is_kitti_name(const std::filesystem::path& path);

/// Writes the frames of a run into one folder, which is a training folder of KITTI's 3D object
/// benchmark and a sequence of its odometry benchmark and of SemanticKITTI. The scans are those of
/// the first sensor that is no camera, or without one of the first camera; the images those of
/// the first two cameras without distortion. Files of a scan appear together; times.txt, poses.txt,
/// calib.txt and semantic-kitti.yaml when the run ends. docs/files/kitti.md lists all files.
class KittiWriter {
 public:
  /// The scene must outlive it. Throws Error when the folder cannot be made.
  KittiWriter(std::filesystem::path folder, const Scene& scene, std::vector<KittiSensor> sensors,
              KittiWriterOptions options);
  ~KittiWriter();
  KittiWriter(const KittiWriter&) = delete;
  KittiWriter& operator=(const KittiWriter&) = delete;

  /// The ground truth that it reads of a sensor's frames.
  [[nodiscard]] HitColumnMask hit_columns(std::size_t sensor) const;
  /// Takes a frame; frames are in the order of their start. Throws Error.
  void write(std::size_t sensor, const Frame& frame, const Beams& beams);
  /// Call after the last frame. Throws Error, also when the folder has more scans of an earlier
  /// run.
  void finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace glidar
