// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/error.hpp>
#include <glidar/core/point_cloud.hpp>
#include <glidar/motion/run_clock.hpp>
#include <glidar/sensor/view_placement.hpp>
#include <glidar/simulate/simulator.hpp>
#include "motion.hpp"
#include "objects.hpp"
#include "report.hpp"

#include <nanobind/eigen/dense.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <tuple>
#include <type_traits>

namespace glidar::python {
namespace {

/// The components of a column's entry: their type and number.
template <class Entry>
struct Parts {
  using Number = std::conditional_t<std::is_enum_v<Entry>, std::uint8_t, Entry>;
};
template <class Scalar, int kRows>
struct Parts<Eigen::Matrix<Scalar, kRows, 1>> {
  using Number = Scalar;
};
template <>
struct Parts<Eigen::Quaternionf> {
  using Number = float;
};
template <>
struct Parts<Reflectance> {
  using Number = float;
};
template <class Scalar, std::size_t kCount>
struct Parts<std::array<Scalar, kCount>> {
  using Number = Scalar;
};

/// Calls visit(name, column) for every column of a frame that has one entry per beam.
template <class AnyFrame, class Visit>
void each_column(AnyFrame& frame, const Visit& visit) {
  visit("range_m", frame.range_m);
  visit("intensity", frame.intensity);
  visit("status", frame.status);
  visit("return_source", frame.return_source);
  visit("sigma_m", frame.sigma_m);
  visit("radial_velocity_m_s", frame.radial_velocity_m_s);
  visit("true_radial_velocity_m_s", frame.true_radial_velocity_m_s);
  visit("disparity_px", frame.disparity_px);
  visit("projector_px", frame.projector_px);
  for (auto& image : frame.raw_images) {
    visit((image.name + ".level").c_str(), image.grey.level);
    visit((image.name + ".electrons").c_str(), image.electrons);
  }
  visit("true_directions", frame.true_directions);
  visit("deskewed.directions", frame.deskewed.directions);
  visit("deskewed.true_directions", frame.deskewed.true_directions);
  visit("deskewed.origins_m", frame.deskewed.origins_m);
  visit("deskewed.start_from_sensor", frame.deskewed.start_from_sensor);
  visit("beam_poses.world_from_sensor", frame.beam_poses.world_from_sensor);
  visit("beam_poses.world_from_object", frame.beam_poses.world_from_object);
  visit("tof_amplitude", frame.tof_amplitude);
  visit("bounced_share", frame.bounced_share);
  auto& truth = frame.ground_truth;
  visit("ground_truth.range_m", truth.range_m);
  visit("ground_truth.instance", truth.instance);
  visit("ground_truth.primitive", truth.primitive);
  visit("ground_truth.depth_m", truth.depth_m);
  visit("ground_truth.normal", truth.normal);
  visit("ground_truth.shading_normal", truth.shading_normal);
  visit("ground_truth.cos_incidence", truth.cos_incidence);
  visit("ground_truth.cos_shading", truth.cos_shading);
  visit("ground_truth.barycentrics", truth.barycentrics);
  visit("ground_truth.colour", truth.colour);
  visit("ground_truth.diffuse", truth.diffuse);
  visit("ground_truth.reflectance", truth.reflectance);
  visit("ground_truth.object_point_m", truth.object_point_m);
  visit("ground_truth.noise_scale", truth.noise_scale);
}

/// All columns of the frame, (N, k), as views of its memory.
nb::dict arrays_of(nb::handle self) {
  nb::dict arrays;
  each_column(nb::cast<const Measured&>(self).frame, [&](const char* name, const auto& values) {
    using Entry = typename std::decay_t<decltype(values)>::value_type;
    using Number = typename Parts<Entry>::Number;
    if (values.empty()) return;
    const std::array<std::size_t, 2> shape = {values.size(), sizeof(Entry) / sizeof(Number)};
    arrays[name] = array_at(reinterpret_cast<const Number*>(values.data()), shape, self);
  });
  return arrays;
}

/// The data of a frame other than its columns.
nb::dict frame_state(const Measured& measured) {
  const Frame& frame = measured.frame;
  nb::dict state;
  state["stamp_ns"] = frame.stamp_ns;
  state["seed"] = frame.seed;
  state["number"] = frame.number;
  state["sensor_id"] = frame.sensor_id;
  state["world_from_sensor"] = matrix_of(frame.world_from_sensor);
  nb::list objects;
  for (const Pose& pose : frame.world_from_instance) objects.append(matrix_of(pose));
  state["world_from_objects"] = objects;
  const TofImages& tof = frame.tof_images;
  if (!tof.level.empty()) {
    state["tof_images"] = nb::make_tuple(tof.frequencies, tof.taps,
                                         nb::bytes(reinterpret_cast<const char*>(tof.level.data()),
                                                   tof.level.size() * sizeof(float)));
  }
  nb::list images;
  for (const RawImage& image : frame.raw_images) {
    images.append(nb::make_tuple(image.name, image.grey.max_level));
  }
  state["raw_images"] = images;
  state["sensor_motion"] = states_of({measured.motion->world_from_sensor});
  state["object_motion"] = states_of(measured.motion->world_from_instance);
  return state;
}

template <class Entry>
void load_column(const nb::dict& arrays, const char* name, std::size_t size,
                 std::vector<Entry>& values) {
  using Number = typename Parts<Entry>::Number;
  using Array = nb::ndarray<const Number, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
  constexpr std::size_t kCount = sizeof(Entry) / sizeof(Number);
  const auto array = entry<Array>(arrays, name);
  if (!array) return;
  if (array->shape(0) != size || array->shape(1) != kCount) {
    throw Error({std::string("frame, ") + name, "an array of another shape",
                 std::to_string(size) + " x " + std::to_string(kCount) + ": one row per beam"});
  }
  values.resize(size);
  std::memcpy(static_cast<void*>(values.data()), array->data(), size * sizeof(Entry));
}

/// Checks that required columns exist and codes are valid.
void check_columns(const Frame& frame, std::size_t size) {
  const Hits& truth = frame.ground_truth;
  for (const RawImage& image : frame.raw_images) {
    if (image.grey.level.size() == size) continue;
    throw Error({"frame", "a raw image without its grey levels"});
  }
  for (const std::size_t found :
       {frame.range_m.size(), frame.intensity.size(), frame.status.size(), truth.range_m.size(),
        truth.instance.size(), truth.primitive.size()}) {
    if (found != size) throw Error({"frame", "a column that every frame has is missing"});
  }
  const auto too_large = [](auto last) { return [last](auto code) { return code > last; }; };
  if (std::any_of(frame.status.begin(), frame.status.end(),
                  too_large(static_cast<Status>(kStatusCount - 1))) ||
      std::any_of(frame.return_source.begin(), frame.return_source.end(),
                  too_large(ReturnSource::crosstalk))) {
    throw Error({"frame", "a status or return source that is not known",
                 "those of glidar.Status, glidar.ReturnSource"});
  }
}

/// The raw images of a time-of-flight camera, if there are any.
void load_tof_images(const nb::dict& state, Frame& frame) {
  const auto stored = entry<nb::tuple>(state, "tof_images");
  if (!stored) return;
  TofImages& images = frame.tof_images;
  images.width = frame.cols;
  images.height = frame.rows;
  images.frequencies = nb::cast<std::uint32_t>((*stored)[0]);
  images.taps = nb::cast<std::uint32_t>((*stored)[1]);
  const auto bytes = nb::cast<nb::bytes>((*stored)[2]);
  const std::size_t count = pixel_count(images) * images.frequencies * std::size_t{images.taps};
  if (bytes.size() != count * sizeof(float)) {
    throw Error({"frame, tof_images", "raw images of another size",
                 std::to_string(count) + " values: frequencies x phase steps x pixels"});
  }
  images.level.resize(count);
  std::memcpy(images.level.data(), bytes.c_str(), bytes.size());
}

/// Raw images without their pixels.
std::vector<RawImage> restore_images(const nb::list& states, const Frame& frame) {
  std::vector<RawImage> images;
  for (const nb::handle state : states) {
    const auto tuple = nb::cast<nb::tuple>(state);
    RawImage& image = images.emplace_back();
    image.name = nb::cast<std::string>(tuple[0]);
    image.grey = {
        .width = frame.cols, .height = frame.rows, .max_level = nb::cast<std::uint32_t>(tuple[1])};
  }
  return images;
}

std::unique_ptr<Measured> restore_frame(const nb::dict& state, const nb::dict& arrays,
                                        const std::shared_ptr<SensorHandle>& sensor) {
  auto measured = std::make_unique<Measured>(nullptr, Frame{});
  Frame& frame = measured->frame;
  frame.stamp_ns = nb::cast<std::int64_t>(state["stamp_ns"]);
  frame.seed = nb::cast<std::uint64_t>(state["seed"]);
  frame.number = nb::cast<std::uint32_t>(state["number"]);
  frame.sensor_id = nb::cast<std::uint32_t>(state["sensor_id"]);
  frame.world_from_sensor =
      restored_pose(nb::cast<Matrix4>(state["world_from_sensor"]), "world_from_sensor");
  for (const nb::handle pose : nb::cast<nb::list>(state["world_from_objects"])) {
    frame.world_from_instance.push_back(
        restored_pose(nb::cast<Matrix4>(pose), "world_from_objects"));
  }
  measured->sensor = sensor;
  measured->beams = sensor->beams(frame.number);
  frame.rows = measured->beams->rows;
  frame.cols = measured->beams->cols;
  frame.frame_id = measured->beams->frame_id;
  const std::size_t size = measured->beams->size();
  frame.raw_images = restore_images(nb::cast<nb::list>(state["raw_images"]), frame);
  each_column(frame,
              [&](const char* name, auto& values) { load_column(arrays, name, size, values); });
  check_columns(frame, size);
  load_tof_images(state, frame);
  std::vector<Trajectory> moves = trajectories_from(nb::cast<nb::list>(state["sensor_motion"]));
  if (moves.size() != 1) throw Error({"frame", "no motion of the sensor", "one trajectory"});
  measured->motion = std::make_shared<const Motion>(
      Motion{moves[0], trajectories_from(nb::cast<nb::list>(state["object_motion"]))});
  return measured;
}

/// Whether two frames have the same columns, bit for bit.
bool has_same_columns(const Measured& a, const Measured& b) {
  std::vector<std::span<const std::byte>> columns;
  const auto collect = [&](const char* /*name*/, const auto& values) {
    columns.push_back(std::as_bytes(std::span(values)));
  };
  each_column(a.frame, collect);
  const std::size_t count = columns.size();
  each_column(b.frame, collect);
  if (columns.size() != 2 * count) return false;
  for (std::size_t k = 0; k < count; ++k) {
    if (!std::ranges::equal(columns[k], columns[count + k])) return false;
  }
  return true;
}

/// Throws Error when the frame's hits are not hits on this scene: an object or a triangle that it
/// does not have, or another number of objects.
void require_hits_of(const Scene& scene, const Measured& measured) {
  const std::size_t objects = scene.instances.size();
  if (measured.motion->world_from_instance.size() != objects ||
      measured.frame.world_from_instance.size() != objects) {
    throw Error(
        {"frame", "poses of another number of objects", std::to_string(objects) + " objects"});
  }
  const Hits& truth = measured.frame.ground_truth;
  for (std::size_t i = 0; i < truth.instance.size(); ++i) {
    const std::uint32_t instance = truth.instance[i];
    if (instance == kInvalidId) continue;
    if (instance < objects &&
        truth.primitive[i] < scene.meshes[scene.instances[instance].mesh].triangles.size())
      continue;
    throw Error({"frame", "a hit on an object or a triangle that the scene does not have"});
  }
}

/// What pickling and comparing frames need.
void bind_frame_state(nb::module_& module) {
  module.def("frame_state", frame_state, nb::arg("frame"),
             nb::sig("def frame_state(frame: Frame) -> dict[str, typing.Any]"));
  module.def("frame_arrays", arrays_of, nb::arg("frame"),
             nb::sig("def frame_arrays(frame: Frame) -> dict[str, numpy.ndarray]"));
  module.def("restore_frame", restore_frame, nb::arg("state"), nb::arg("arrays"), nb::arg("sensor"),
             nb::sig("def restore_frame(state: dict[str, typing.Any], arrays: dict[str, "
                     "numpy.ndarray], sensor: Sensor) -> Frame"));
  module.def("has_same_columns", has_same_columns, nb::arg("one"), nb::arg("other"));
}

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
  bind_frame_state(module);
}

}  // namespace glidar::python
