// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "imu.hpp"
#include "motion.hpp"
#include "sensor.hpp"

#include <glidar/core/box_classes.hpp>
#include <glidar/io/config/scene_file.hpp>
#include <glidar/render/renderer.hpp>

#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace glidar::python {

/// Measurements of a scene run one at a time. Python's signal handlers run within a measurement, in
/// its thread, where another one of the scene would wait for it forever.
class MeasurementMutex {
 public:
  /// Throws Error in a signal handler that interrupts a measurement of the scene.
  void lock();
  void unlock();

 private:
  std::mutex mutex_;
  std::atomic<std::thread::id> holder_;
};

/// A scene with its renderer, created once. Measurements share it and run one at a time.
struct PreparedScene {
  std::string kind;  ///< of the renderer
  std::shared_ptr<const Scene> scene;
  std::vector<std::string> files;      ///< all files that it was read from
  BoxedClasses boxed_classes;          ///< whose objects have boxes
  std::unique_ptr<Renderer> renderer;  ///< none: see unrendered()
  MeasurementMutex mutex;
};

/// A sensor on the rig of a scene file; a single one has no name.
struct MountedSensor {
  std::string name;
  std::shared_ptr<SensorHandle> sensor;
  Pose rig_from_sensor = Pose::Identity();
};

/// A Python scene. Simulators and frames keep the state that they measure:
/// changes are made to a copy while one of them uses it.
struct SceneHandle {
  std::shared_ptr<Scene> scene = std::make_shared<Scene>();
  std::vector<Trajectory> motion;      ///< one per instance; empty: all are stationary
  std::vector<MountedSensor> sensors;  ///< of the scene file; empty: none
  std::optional<Pose> world_from_rig;
  bool looks_at = false;  ///< see SceneFile
  std::optional<Trajectory> rig_motion;
  std::vector<RigImu> imus;
  Eigen::Vector3d gravity_m_s2 = standard_gravity_m_s2();
  std::vector<std::string> box_classes;  ///< see SceneFile
  std::vector<std::string> files;  ///< the scene file and the files that it names, except models
  std::map<std::pair<std::string, unsigned>, std::shared_ptr<PreparedScene>> prepared;

  /// The scene, to be changed.
  Scene& change();
};

/// All files that a scene was read from: its own, those of models, textures and sensors.
std::vector<std::string> files_read(const SceneHandle& handle);

/// The scene without a renderer, which is created only for measurements.
std::shared_ptr<PreparedScene> unrendered(const SceneHandle& handle, const std::string& kind);

/// Creates the renderer, or returns the existing one. Called with Python's lock, which it releases
/// while it creates one.
std::shared_ptr<PreparedScene> prepare(SceneHandle& handle, const RendererOptions& options);

}  // namespace glidar::python
