// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "frame.hpp"
#include "frame_state.hpp"
#include "report.hpp"

#include <glidar/core/point_cloud.hpp>
#include <glidar/motion/run_clock.hpp>
#include <glidar/sensor/lidar_placement.hpp>
#include <glidar/sensor/view_placement.hpp>
#include <glidar/simulate/simulator.hpp>

#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <tuple>

namespace glidar::python {
namespace {

/// How many frames are measured together: enough for renderers that draw many at once, and few
/// enough that what was cast is still near in memory when its noise is added.
constexpr std::size_t kTogether = 8;

/// A scene and a sensor made ready.
struct SimulatorHandle {
  std::shared_ptr<PreparedScene> prepared;
  std::shared_ptr<SensorHandle> sensor;
  std::shared_ptr<Simulator> simulator;  ///< of both
  std::vector<Trajectory> motion;        ///< of the scene's instances; empty: they are stationary
  std::optional<Trajectory> rig_motion;  ///< of the scene file
  std::optional<Pose> world_from_rig;    ///< of the scene file
  bool looks_at = false;                 ///< see SceneFile
  std::shared_ptr<FramePool> pool = std::make_shared<FramePool>();
};

SimulatorHandle make_simulator(SceneHandle& scene, const std::shared_ptr<SensorHandle>& sensor,
                               const std::string& renderer, unsigned threads) {
  auto prepared = prepare(scene, {.kind = renderer, .threads = threads});
  auto simulator = std::make_shared<Simulator>(*prepared->scene, sensor, *prepared->renderer);
  return {.prepared = std::move(prepared),
          .sensor = sensor,
          .simulator = std::move(simulator),
          .motion = scene.motion,
          .rig_motion = scene.rig_motion,
          .world_from_rig = scene.world_from_rig,
          .looks_at = scene.looks_at};
}

/// Which frames to measure; one entry per frame.
struct Batch {
  const Trajectories& sensors;
  const std::optional<Trajectories>& objects;  ///< as many for each frame
  std::span<const std::uint64_t> seeds;
  std::span<const std::uint32_t> numbers;
  std::uint32_t sensor_id;
  std::optional<std::int64_t> start_ns;
  const HitColumnMask& hit_columns;

  [[nodiscard]] std::size_t size() const { return sensors.all.size(); }
};

Motion motion_of(const SimulatorHandle& handle, const Batch& batch, std::size_t k) {
  const Scene& scene = *handle.prepared->scene;
  if (!batch.objects) return make_motion(scene, batch.sensors.all[k], handle.motion);
  const std::vector<Trajectory>& all = batch.objects->all;
  const std::size_t count = scene.instances.size();
  const auto first = all.begin() + static_cast<std::ptrdiff_t>(all.size() == count ? 0 : k * count);
  return make_motion(scene, batch.sensors.all[k],
                     {first, first + static_cast<std::ptrdiff_t>(count)});
}

using Frames = std::vector<std::unique_ptr<Measured>>;

std::unique_ptr<Measured> start(const SimulatorHandle& handle, const Batch& batch, std::size_t k) {
  auto measured = std::make_unique<Measured>(handle.pool, handle.pool->take());
  measured->prepared = handle.prepared;
  measured->sensor = handle.sensor;
  measured->beams = handle.sensor->beams(batch.numbers[k]);
  Frame& frame = measured->frame;
  frame.number = batch.numbers[k];
  frame.seed = batch.seeds[k];
  frame.sensor_id = batch.sensor_id;
  return measured;
}

/// Measures frames [first, first + run.size()) of the batch together.
void measure_run(const SimulatorHandle& handle, const Batch& batch, std::size_t first,
                 std::span<const std::unique_ptr<Measured>> run, Watch& watch) {
  std::vector<Motion> motions;
  std::vector<Frame> frames;
  for (std::size_t k = 0; k < run.size(); ++k) {
    Motion& motion = motions.emplace_back(motion_of(handle, batch, first + k));
    Frame& frame = frames.emplace_back(std::move(run[k]->frame));
    frame.stamp_ns = set_run_clock({.time_ns = batch.start_ns}, motion.world_from_sensor,
                                   motion.world_from_instance) +
                     frame_interval(handle.sensor->sensor(), frame.number).start_ns;
  }
  handle.simulator->simulate_batch(motions, batch.hit_columns, frames, watch.progress());
  for (std::size_t k = 0; k < run.size(); ++k) {
    run[k]->motion = std::make_shared<const Motion>(std::move(motions[k]));
    run[k]->frame = std::move(frames[k]);
  }
}

Frames measure_all(const SimulatorHandle& handle, const Batch& batch, Watch& watch) {
  Frames frames;
  for (std::size_t k = 0; k < batch.size(); ++k) frames.push_back(start(handle, batch, k));
  const std::lock_guard lock(handle.prepared->mutex);
  for (std::size_t k = 0; k < frames.size(); k += kTogether) {
    watch.look();
    const std::size_t count = std::min(kTogether, frames.size() - k);
    measure_run(handle, batch, k, std::span(frames).subspan(k, count), watch);
  }
  return frames;
}

/// Seeds, numbers of the frames, which sensor of a rig it is, and the start of the run.
using Keys = std::tuple<Numbers<std::uint64_t>, Numbers<std::uint32_t>, std::uint32_t,
                        std::optional<std::int64_t>>;
using Key = std::tuple<std::uint64_t, std::uint32_t, std::uint32_t, std::optional<std::int64_t>>;

nb::list simulate_all(const SimulatorHandle& handle, const Trajectories& sensors,
                      const std::optional<Trajectories>& objects, const Keys& keys,
                      const HitColumnMask& hit_columns) {
  const auto& [seeds, numbers, sensor_id, start_ns] = keys;
  const Batch batch{.sensors = sensors,
                    .objects = objects,
                    .seeds = {seeds.data(), seeds.shape(0)},
                    .numbers = {numbers.data(), numbers.shape(0)},
                    .sensor_id = sensor_id,
                    .start_ns = start_ns,
                    .hit_columns = hit_columns};
  Frames frames = unlocked([&](Watch& watch) { return measure_all(handle, batch, watch); });
  nb::list result;
  for (auto& measured : frames) {
    result.append(nb::cast(measured.release(), nb::rv_policy::take_ownership));
  }
  return result;
}

/// The same for one frame, with less ado.
std::unique_ptr<Measured> simulate_one(const SimulatorHandle& handle, const Trajectories& sensor,
                                       const std::optional<Trajectories>& objects, const Key& key,
                                       const HitColumnMask& hit_columns) {
  const auto& [seed, number, sensor_id, start_ns] = key;
  const Batch batch{.sensors = sensor,
                    .objects = objects,
                    .seeds = {&seed, 1},
                    .numbers = {&number, 1},
                    .sensor_id = sensor_id,
                    .start_ns = start_ns,
                    .hit_columns = hit_columns};
  return std::move(
      unlocked([&](Watch& watch) { return measure_all(handle, batch, watch); }).front());
}

/// Where the scene file has its only sensor; else where it sees all of the scene.
Trajectories usual_motion(const SimulatorHandle& handle) {
  if (handle.rig_motion) return {{*handle.rig_motion}};
  const std::shared_ptr<const Beams> beams = handle.sensor->beams(0);
  const bool is_lidar = !looks_along_z(*beams);
  if (handle.world_from_rig) {
    const Pose& given = *handle.world_from_rig;
    const bool turned = handle.looks_at && is_lidar;
    return {{ConstantPose{turned ? given * optical_from_body() : given}}};
  }
  const Eigen::Vector3d from(2.0, -3.0, 2.0);
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  const Scene& scene = *handle.prepared->scene;
  return {{ConstantPose{is_lidar ? place_lidar_beside(*beams, scene, from, up)
                                 : fit_camera_to_scene(*beams, scene, from, up)}}};
}

/// Gives a restored frame the scene that it was measured of, and the renderer.
void attach(const SimulatorHandle& handle, Measured& measured) {
  require_hits_of(*handle.prepared->scene, measured);
  if (!measured.prepared) measured.prepared = handle.prepared;
}

/// Gives it the scene alone, of which clouds and files are made without a renderer.
void attach_scene(Measured& measured, const SceneHandle& scene, const std::string& renderer) {
  require_hits_of(*scene.scene, measured);
  if (!measured.unrendered) measured.unrendered = unrendered(scene, renderer);
}

HitColumnMask hit_columns(const std::vector<std::string>& columns) {
  return hit_columns_for(columns);
}

}  // namespace

void bind_simulator(nb::module_& module) {
  nb::class_<HitColumnMask>(module, "HitColumnMask", "The ground truth that a frame keeps.");
  module.def("hit_columns_for", hit_columns, nb::arg("columns"));
  nb::class_<SimulatorHandle>(module, "Simulator")
      .def("simulate", simulate_all, nb::arg("sensors"), nb::arg("objects").none(), nb::arg("keys"),
           nb::arg("hit_columns"),
           nb::sig("def simulate(self, sensors: Trajectories, objects: Trajectories | None, keys: "
                   "tuple[numpy.ndarray, numpy.ndarray, int, int | None], hit_columns: "
                   "HitColumnMask) -> list[Frame]"))
      .def("simulate_one", simulate_one, nb::arg("sensor"), nb::arg("objects").none(),
           nb::arg("key"), nb::arg("hit_columns"))
      .def("usual_motion", usual_motion)
      .def("attach", attach, nb::arg("frame"))
      .def_prop_ro("objects", [](const SimulatorHandle& self) {
        return self.prepared->scene->instances.size();
      });
  module.def("attach_scene", attach_scene, nb::arg("frame"), nb::arg("scene"), nb::arg("renderer"));
  module.def("make_simulator", make_simulator, nb::arg("scene"), nb::arg("sensor"),
             nb::arg("renderer"), nb::arg("threads"));
}

}  // namespace glidar::python
