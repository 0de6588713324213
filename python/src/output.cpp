// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "convert.hpp"
#include "objects.hpp"
#include "report.hpp"

#include <glidar/core/error.hpp>
#include <glidar/output/output.hpp>

#include <nanobind/eigen/dense.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <memory>
#include <mutex>
#include <string_view>
#include <utility>

namespace glidar::python {
namespace {

/// An output of frames, for one call at a time. The first frame determines the scene and, unless a
/// rig is given, the sensor.
class OutputHandle {
 public:
  OutputHandle(std::string path, OutputOptions options)
      : path_(std::move(path)), options_(std::move(options)) {
    if (path_.find("://") == std::string::npos) (void)output_kind(path_);  // an unknown suffix
  }

  void add_sensor(const std::string& name, std::uint32_t number,
                  std::shared_ptr<SensorHandle> sensor, const PoseArray& rig_from_sensor) {
    sensors_.push_back({name, std::move(sensor), pose_of(rig_from_sensor, 0, "rig_from_sensor")});
    numbers_.push_back(number);
  }
  void add_imu(const std::string& name, const ImuHandle& imu, const PoseArray& rig_from_imu) {
    imus_.push_back({name, imu.imu, pose_of(rig_from_imu, 0, "rig_from_imu")});
  }
  void set_motion(const Trajectories& world_from_rig, std::int64_t start_ns, std::uint64_t seed,
                  const Eigen::Vector3d& gravity_m_s2) {
    world_from_rig_ = world_from_rig.all.at(0);
    start_ns_ = start_ns;
    seed_ = seed;
    gravity_m_s2_ = gravity_m_s2;
  }

  /// Throws Error when it has ended, or the frame is of another sensor or scene. The frame needs
  /// its renderer if needs_boxes().
  void write(Measured& measured, const nb::object& log) {
    unlocked([&](Watch& /*watch*/) {
      const std::lock_guard turn(turn_);
      check_columns(measured.sensor->sensor(), options_.columns);
      if (has_ended_) {
        throw Error({path_, "the output has ended", "frames before it is closed or discarded",
                     "open another output"});
      }
      if (!opened_) opened_ = open(measured);
      const std::size_t sensor = sensor_of(measured, *opened_);
      check_scene(measured);
      if (opened_->output->hit_columns(sensor).boxes && lacks_boxes(measured))
        ensure_boxes(measured);
      opened_->output->write({.frame = measured.frame,
                              .beams = *measured.beams,
                              .sensor = sensor,
                              .index = opened_->counts[sensor]++});
    });
    pass_messages(log);
  }
  /// Returns what was written, in lines; nothing when it has ended before.
  std::string finish(const nb::object& log) {
    const std::string text = unlocked([&](Watch& /*watch*/) -> std::string {
      const std::lock_guard turn(turn_);
      if (has_ended_) return {};
      if (!opened_) throw Error({path_, "there is no frame", "one frame or more"});
      opened_->output->finish();
      std::string written = opened_->output->written_text();
      end();
      return written;
    });
    pass_messages(log);
    return text;
  }
  /// Ends it; nothing of a recording remains.
  void discard() {
    unlocked([&](Watch& /*watch*/) {
      const std::lock_guard turn(turn_);
      end();
    });
  }

 private:
  /// The output reports from any thread and after the call that opens it.
  void add_message(Severity severity, std::string_view message) {
    const std::lock_guard lock(mutex_);
    messages_.emplace_back(severity == Severity::warning ? "warning" : "info", message);
  }
  void pass_messages(const nb::object& log) {
    std::vector<std::pair<std::string, std::string>> messages;
    {
      const std::lock_guard lock(mutex_);
      messages.swap(messages_);
    }
    for (const auto& [severity, message] : messages) log(severity, text_of(message));
  }

  /// What the first frame determines. The output refers to the rest, so it is the last member.
  struct Opened {
    std::vector<MountedSensor> sensors;
    std::vector<std::uint32_t> numbers;  ///< of these sensors on their rig
    std::vector<std::uint64_t> counts;   ///< frames of each sensor
    std::shared_ptr<PreparedScene> prepared;
    std::shared_ptr<const PreparedScene> unrendered;
    std::vector<std::shared_ptr<const Beams>> beams;
    std::unique_ptr<Output> output;
  };

  void end() {
    opened_.reset();
    has_ended_ = true;
  }

  [[nodiscard]] std::unique_ptr<Opened> open(const Measured& measured) {
    check_options_used(path_, options_);
    (void)measured.scene();  // restores it when the frame was unpickled
    auto opened = std::make_unique<Opened>();
    opened->sensors = sensors_;
    opened->numbers = numbers_;
    opened->prepared = measured.prepared;
    opened->unrendered = measured.unrendered;
    if (sensors_.empty()) {
      opened->sensors.push_back({{}, measured.sensor, Pose::Identity()});
      opened->numbers.push_back(measured.frame.sensor_id);
    }
    opened->counts.assign(opened->sensors.size(), 0);
    OutputRig rig{.scene = *measured.scene().scene, .sensors = {}};
    rig.inputs = measured.scene().files;
    for (std::size_t i = 0; i < opened->sensors.size(); ++i) {
      const MountedSensor& mounted = opened->sensors[i];
      opened->beams.push_back(mounted.sensor->beams(0));
      rig.sensors.push_back({.name = mounted.name,
                             .label = mounted.name,
                             .id = opened->numbers[i],
                             .sensor = mounted.sensor->sensor(),
                             .beams = *opened->beams.back(),
                             .rig_from_sensor = mounted.rig_from_sensor});
      const std::vector<std::string>& files = mounted.sensor->sensor().files;
      rig.inputs.insert(rig.inputs.end(), files.begin(), files.end());
    }
    (void)sensor_of(measured, *opened);
    if (world_from_rig_) rig.motion = {*world_from_rig_, measured.motion->world_from_instance};
    rig.imus = imus_;
    rig.gravity_m_s2 = gravity_m_s2_;
    rig.seed = seed_;
    rig.start_ns = start_ns_;
    rig.renderer = measured.scene().kind;
    options_.messages.has_colour = !measured.frame.ground_truth.colour.empty();
    const Report report{
        [this](Severity severity, std::string_view message) { add_message(severity, message); },
        {}};
    opened->output = open_output(path_, rig, options_, report);
    return opened;
  }

  /// The index of the frame's sensor in the rig. Throws Error when it is another sensor.
  [[nodiscard]] std::size_t sensor_of(const Measured& measured, const Opened& opened) const {
    const auto found_number = std::ranges::find(opened.numbers, measured.frame.sensor_id);
    const auto index = opened.sensors.size() == 1
                           ? std::size_t{0}
                           : static_cast<std::size_t>(found_number - opened.numbers.begin());
    const Sensor& found = measured.sensor->sensor();
    if (index < opened.sensors.size() &&
        opened.sensors[index].sensor->sensor().name == found.name &&
        opened.beams[index]->rows == measured.beams->rows)
      return index;
    throw Error({path_, "a frame of another sensor", "frames of one sensor, or of a rig's sensors",
                 "open an output for each sensor"});
  }

  /// Throws Error when the objects of the frame's scene are not those of the first frame, which the
  /// output names by their indices.
  void check_scene(const Measured& measured) const {
    const Scene& first =
        *(opened_->prepared ? opened_->prepared->scene : opened_->unrendered->scene);
    const Scene& scene = *measured.scene().scene;
    const auto is_same = [](const Instance& one, const Instance& other) {
      return one.id == other.id && one.class_id == other.class_id && one.name == other.name;
    };
    if (&first == &scene || (first.class_names == scene.class_names &&
                             std::ranges::equal(first.instances, scene.instances, is_same)))
      return;
    throw Error({path_, "a frame of a scene with other objects than the first frame's",
                 "frames of scenes with the same objects, ids and classes",
                 "open an output for each scene"});
  }

  std::string path_;
  OutputOptions options_;
  std::vector<MountedSensor> sensors_;
  std::vector<std::uint32_t> numbers_;  ///< of these sensors on their rig
  std::vector<RigImu> imus_;
  std::optional<Trajectory> world_from_rig_;
  std::int64_t start_ns_ = 0;
  std::uint64_t seed_ = 1;
  Eigen::Vector3d gravity_m_s2_ = standard_gravity_m_s2();
  std::mutex turn_;                                            ///< of a call
  std::mutex mutex_;                                           ///< of the messages
  std::vector<std::pair<std::string, std::string>> messages_;  ///< severity and text
  bool has_ended_ = false;
  std::unique_ptr<Opened> opened_;  ///< ends first: threads of the output report
};

std::vector<std::pair<std::string, std::string>> known_formats() {
  std::vector<std::pair<std::string, std::string>> formats;
  for (const OutputFormat& format : output_formats()) {
    if (format.missing.empty()) formats.emplace_back(format.suffix, format.description);
  }
  return formats;
}

/// Whether the name is that of files of one frame, such as those in a KITTI folder.
bool is_frame_file(const std::string& path) {
  if (path.find("://") != std::string::npos) return false;
  const OutputKind kind = output_kind(path);
  return kind == OutputKind::frame_file || kind == OutputKind::kitti_folder;
}

}  // namespace

void bind_output(nb::module_& module) {
  module.def("output_formats", known_formats);
  module.def("is_frame_file", is_frame_file, nb::arg("path"));
  module.def("lacks_boxes", lacks_boxes, nb::arg("frame"));
  nb::class_<OutputHandle>(module, "Output")
      .def(nb::init<std::string, OutputOptions>(), nb::arg("path"), nb::arg("options"))
      .def("add_sensor", &OutputHandle::add_sensor, nb::arg("name"), nb::arg("number"),
           nb::arg("sensor"), nb::arg("rig_from_sensor"))
      .def("add_imu", &OutputHandle::add_imu, nb::arg("name"), nb::arg("imu"),
           nb::arg("rig_from_imu"))
      .def("set_motion", &OutputHandle::set_motion, nb::arg("world_from_rig"), nb::arg("start_ns"),
           nb::arg("seed"), nb::arg("gravity_m_s2"))
      .def("write", &OutputHandle::write, nb::arg("frame"), nb::arg("log"),
           nb::sig("def write(self, frame: Frame, log: object) -> None"))
      .def("finish", &OutputHandle::finish, nb::arg("log"),
           nb::sig("def finish(self, log: object) -> str"))
      .def("discard", &OutputHandle::discard);
}

}  // namespace glidar::python
