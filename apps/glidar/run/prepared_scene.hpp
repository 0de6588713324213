// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/options/render_options.hpp>
#include <apps/glidar/run/console.hpp>
#include <glidar/output/output.hpp>
#include <glidar/simulate/simulator.hpp>
#include <glidar/woods2016/framebuffer.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace glidar::app {

/// A sensor that measures: the only one, or one of a rig.
struct ActiveSensor {
  std::string name = {};  ///< empty: the only sensor
  std::uint32_t id = 0;   ///< index in the scene file; its random numbers depend on it
  Sensor sensor;
  Pose rig_from_sensor = Pose::Identity();
  Beams beams = {};  ///< of frame 0
  Motion motion = {};
  std::uint32_t frames = 1;                   ///< in the duration of the run
  std::shared_ptr<Simulator> simulator = {};  ///< made by prepare_scene()
};

/// A loaded scene, ready to be measured: with its sensors, their poses and motion, and a renderer.
struct PreparedScene {
  Scene scene;
  std::vector<ActiveSensor> sensors;  ///< one, or those of the scene file's rig
  RigMotion motion;                   ///< at the times of stamps
  std::int64_t start_ns = 0;          ///< of the run: the stamp of frame 0 of each sensor
  std::string recorded_start = {};   ///< --start-time to repeat the run; empty: the options suffice
  std::optional<double> duration_s;  ///< of a sequence of frames; empty: not limited
  std::unique_ptr<Renderer> renderer;
  std::unique_ptr<Woods2016Camera> woods2016_camera;  ///< for --quantized-framebuffer; else none
  std::vector<RigImu> imus;                           ///< on the rig
  Eigen::Vector3d gravity_m_s2 = standard_gravity_m_s2();
  BoxedClasses boxed_classes;      ///< whose objects have boxes
  std::vector<std::string> files;  ///< all files that were read
};

/// Loads and prepares the inputs of the options; `on_loaded` is called before the renderer is
/// prepared, which can take long. The console shows progress and advice. Throws Error.
void prepare_scene(const RenderFlags& flags, const std::function<void()>& on_loaded,
                   Console& console, PreparedScene& prepared);

/// The label of this sensor's files and topics: its name on a rig; empty if --sensor-name is given
/// or there is no rig.
std::string label_of(const RenderFlags& flags, const ActiveSensor& active);

/// The only sensor. Throws Error if there are several.
ActiveSensor& only_sensor(PreparedScene& prepared);

/// The motion of a sensor and all instances.
Motion motion_of(RigMotion motion, const ActiveSensor& active);

/// The stamp of a frame: when it starts.
std::int64_t stamp_of(const PreparedScene& prepared, const ActiveSensor& active,
                      std::uint32_t number);

/// The end of the last frame of all sensors, or of the duration.
std::int64_t end_ns(const PreparedScene& prepared);

/// Sets number, sensor, stamp and seed of a frame of the sequence.
void set_frame_header(const RenderFlags& flags, const PreparedScene& prepared,
                      const ActiveSensor& active, std::uint32_t number, Frame& frame);

/// A simulator of the scene, with the framebuffer that its options select.
std::shared_ptr<Simulator> make_simulator(const PreparedScene& prepared,
                                          const std::shared_ptr<const BeamCache>& beam_cache);

/// The same with another renderer of the scene; `camera` nullptr: no framebuffer.
std::shared_ptr<Simulator> make_simulator(const Scene& scene,
                                          const std::shared_ptr<const BeamCache>& beam_cache,
                                          Renderer& renderer, Woods2016Camera* camera);

/// Prints advice as warnings.
void print_advice(const std::vector<std::string>& advice, Console& console);

/// A frame of one of the sensors.
struct SensorFrame {
  std::size_t sensor_index = 0;
  std::uint32_t number = 0;
};

/// The frames of all sensors in the order of their start; of frames that start together, in the
/// order of the sensors.
class FrameOrder {
 public:
  /// The sensors must outlive it. Each has ActiveSensor::frames frames.
  explicit FrameOrder(std::span<const ActiveSensor> sensors)
      : sensors_(sensors), numbers_(sensors.size()) {}
  /// Empty: there are no more frames.
  std::optional<SensorFrame> next();

 private:
  std::span<const ActiveSensor> sensors_;
  std::vector<std::uint32_t> numbers_;  ///< of each sensor's next frame
};

}  // namespace glidar::app
