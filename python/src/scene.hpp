// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "motion.hpp"
#include "sensor.hpp"

#include <glidar/io/config/scene_file.hpp>
#include <glidar/render/renderer.hpp>

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace glidar::python {

/// A scene with its renderer, built once. Measurements share it and take turns.
struct PreparedScene {
  std::string kind;  ///< of the renderer
  std::shared_ptr<const Scene> scene;
  std::vector<std::string> files;      ///< all that was read for it
  std::unique_ptr<Renderer> renderer;  ///< none: see unrendered()
  std::mutex turn;
};

/// A sensor on the rig of a scene file; a single one has no name.
struct MountedSensor {
  std::string name;
  std::shared_ptr<SensorHandle> sensor;
  Pose rig_from_sensor = Pose::Identity();
};

/// A scene as Python holds it. What was prepared or measured of it keeps the scene that it saw:
/// changes are made to a copy while anybody else has it.
struct SceneHandle {
  std::shared_ptr<Scene> scene = std::make_shared<Scene>();
  std::vector<Trajectory> motion;      ///< one per instance; empty: all are stationary
  std::vector<MountedSensor> sensors;  ///< of the scene file; none: it names none
  std::optional<Pose> world_from_rig;
  bool looks_at = false;  ///< see SceneFile
  std::optional<Trajectory> rig_motion;
  std::vector<std::string> files;  ///< the scene file and the files that it names, except models
  std::map<std::pair<std::string, unsigned>, std::shared_ptr<PreparedScene>> prepared;

  /// The scene, to be changed.
  Scene& change();
};

/// All files that a scene was read from: its own, those of models, textures and sensors.
std::vector<std::string> files_read(const SceneHandle& handle);

/// The scene without a renderer, which is built only where something is measured.
std::shared_ptr<PreparedScene> unrendered(const SceneHandle& handle, const std::string& kind);

/// Builds the renderer, or gives the one that was built. Called with Python's lock, which it gives
/// up while it builds.
std::shared_ptr<PreparedScene> prepare(SceneHandle& handle, const RendererOptions& options);

}  // namespace glidar::python
