// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/box_classes.hpp>
#include <glidar/core/report.hpp>
#include <glidar/core/scene.hpp>
#include <glidar/motion/motion.hpp>
#include <glidar/render/renderer.hpp>
#include <glidar/sensor/sensor.hpp>
#include <glidar/simulate/return_replacement.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace glidar {

struct Simulation;

/// Simulates frames of a scene as a sensor measures them. Prepares once what is the same for all
/// frames, and reuses its memory. One call at a time, also of simulators that share a renderer. The
/// scene, which must outlive it, may not change: objects move by Motion.
class Simulator {
 public:
  /// With a renderer of its own.
  Simulator(const Scene& scene, Sensor sensor, const RendererOptions& options = {});
  /// With a renderer over the same scene, which must outlive it.
  Simulator(const Scene& scene, Sensor sensor, Renderer& renderer);
  /// With a sensor whose beams are shared.
  Simulator(const Scene& scene, const std::shared_ptr<const BeamCache>& beam_cache,
            Renderer& renderer);
  Simulator(Simulator&&) noexcept;
  Simulator& operator=(Simulator&&) noexcept;
  ~Simulator();

  /// The first frame of a static scene with the sensor at this pose.
  Frame simulate(const Pose& world_from_sensor, const HitColumnMask& hit_columns = {},
                 std::uint64_t seed = 1);

  /// Simulates the frame that stamp_ns, seed, sensor_id and number of `frame` state. `hit_columns`
  /// is the ground truth to keep beside the range. The frame's memory is reused.
  void simulate(const Motion& motion, const HitColumnMask& hit_columns, Frame& frame,
                const ProgressCallback& progress = {});

  /// Simulates many frames, for example for Monte Carlo: frames[i] moves as motions[i] and is
  /// bit-identical to that of simulate(). Renderers that draw need less time for many small frames
  /// together than one by one. Throws Error unless there is a motion per frame.
  void simulate_batch(std::span<const Motion> motions, const HitColumnMask& hit_columns,
                      std::span<Frame> frames, const ProgressCallback& progress = {});

  /// The boxes of the objects of a frame that was simulated with this motion.
  [[nodiscard]] std::vector<ObjectBox> find_boxes(const Motion& motion, Frame& frame,
                                                  BoxSelection selection);

  /// Sets the classes whose objects have boxes; empty, as by default: the countable ones. Throws
  /// Error unless there is a value for each class of the scene.
  void set_boxed_classes(BoxedClasses classes);

  /// Replaces the returns of all further frames; empty: none are replaced.
  void set_return_replacement(ReturnReplacement replacement);

  [[nodiscard]] const Scene& scene() const;
  [[nodiscard]] const Sensor& sensor() const;
  [[nodiscard]] Renderer& renderer() const;
  /// The beams of a frame as the sensor reports them. May be called from any thread.
  [[nodiscard]] std::shared_ptr<const Beams> beams(std::uint32_t frame = 0) const;

  /// Everything that simulate() in simulate.hpp reads and writes for a frame with these beams; all
  /// arguments must outlive it. Frames that are simulated together differ in `slot`.
  [[nodiscard]] Simulation prepare(const Beams& beams, const Motion& motion,
                                   const HitColumnMask& hit_columns, Frame& frame,
                                   const ProgressCallback& progress, std::size_t slot = 0);

 private:
  Simulator(const Scene& scene, Sensor sensor, std::unique_ptr<Renderer> renderer);

  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace glidar
