// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/box_classes.hpp>
#include <glidar/io/config/scene_file.hpp>
#include <glidar/render/renderer.hpp>
#include <glidar/sensor/imu.hpp>
#include <glidar/sensor/sensor.hpp>

#include "bind.hpp"
#include "motion.hpp"

#include <atomic>
#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace glidar::python {

/// An IMU in Python; it does not change.
struct ImuHandle {
  Imu imu;
};

/// A sensor as Python holds it.
using SensorHandle = BeamCache;

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

/// A pool of unused frames, whose memory is reused.
class FramePool {
 public:
  FramePool();
  Frame take();
  void release(Frame frame) noexcept;

 private:
  std::mutex mutex_;
  std::vector<Frame> spare_;
  std::size_t spare_beams_ = 0;
};

/// A Python frame with its scene, sensor and renderer.
struct Measured {
  Measured(std::shared_ptr<FramePool> from, Frame measured)
      : pool(std::move(from)), frame(std::move(measured)) {}
  Measured(const Measured&) = delete;
  Measured& operator=(const Measured&) = delete;
  ~Measured() {
    if (pool) pool->release(std::move(frame));
  }
  /// The scene that it measured, possibly without a renderer. Throws Error when a restored
  /// frame has none yet.
  [[nodiscard]] const PreparedScene& scene() const;
  /// The same with its renderer.
  [[nodiscard]] PreparedScene& rendered() const;

  std::shared_ptr<FramePool> pool;  ///< that the frame's memory returns to; may be null
  Frame frame;
  // for a restored frame each is set once when needed, because other threads may use
  // it
  std::shared_ptr<PreparedScene> prepared;
  std::shared_ptr<const PreparedScene> unrendered;  ///< of restored frames only
  std::shared_ptr<SensorHandle> sensor;
  std::shared_ptr<const Beams> beams;
  std::shared_ptr<const Motion> motion;
  std::atomic<bool> has_boxes =
      false;  ///< frame.boxes are found; changed with the turn of `prepared`
};

/// Whether there are objects whose boxes are not found yet.
bool lacks_boxes(const Measured& measured);

/// Finds frame.boxes, unless that is done. Needs the renderer; without Python's lock.
void ensure_boxes(Measured& measured);

}  // namespace glidar::python
