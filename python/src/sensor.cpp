// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause

#include <glidar/core/error.hpp>
#include <glidar/core/field_visitor.hpp>
#include <glidar/io/config/imu_file.hpp>
#include <glidar/io/config/sensor_document.hpp>
#include <glidar/io/config/sensor_file.hpp>
#include <glidar/io/config/sensor_options.hpp>
#include <glidar/io/config/sensor_presets.hpp>
#include <glidar/io/formats/sidecar.hpp>
#include <glidar/simulate/simulate_imu.hpp>

#include "bind.hpp"
#include "convert.hpp"
#include "motion.hpp"
#include "objects.hpp"

#include <nanobind/eigen/dense.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <tuple>

namespace glidar::python {
namespace {

using Shared = std::shared_ptr<SensorHandle>;

/// Throws Error when a frame of this camera cannot fit into the machine's memory.
void require_memory(const Sensor& sensor) {
  const auto* pinhole = std::get_if<Pinhole>(&sensor.optics);
  if (pinhole == nullptr) return;
  constexpr double kBytesPerBeam = 250.0;  // beam, ground truth, measurement and cloud together
  constexpr double kGibibyte = 1024.0 * 1024.0 * 1024.0;
  const double needed = kBytesPerBeam * pinhole->intrinsics.width * pinhole->intrinsics.height;
  const double there =
      static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
  if (needed <= there) return;
  throw Error(
      {.where = "image size",
       .found = "a frame takes about " + number_text(std::round(needed / kGibibyte)) + " GiB",
       .allowed = "this machine's memory, " + number_text(std::round(there / kGibibyte)) + " GiB",
       .remedy = "measure fewer pixels"});
}

Shared make(Sensor sensor) {
  require_memory(sensor);
  const nb::gil_scoped_release release;
  return std::make_shared<SensorHandle>(std::move(sensor));
}

Shared load(const std::string& name_or_path, const std::string& mode) {
  return make(load_sensor_file(find_sensor_file(name_or_path, mode)));
}

Shared load_content(const std::filesystem::path& path, const std::string& content,
                    const std::string& variant, const std::string& mode) {
  return make(load_sensor_content({path, variant, mode}, content));
}

/// A table of beams from Python: `shape` (rows, cols), `period_ns`, and arrays of one row per
/// beam, of which only `directions` is required.
RayTable table_of(const nb::dict& arrays) {
  RayTable table;
  std::tie(table.rows, table.cols) =
      nb::cast<std::pair<std::uint32_t, std::uint32_t>>(arrays["shape"]);
  table.period_ns = nb::cast<double>(arrays["period_ns"]);
  table.directions = vectors<Eigen::Vector3d>(entry<Table<double, 3>>(arrays, "directions"));
  table.origins_m = vectors<Eigen::Vector3d>(entry<Table<double, 3>>(arrays, "origins_m"));
  table.times_ns = vectors<double>(entry<Numbers<double>>(arrays, "times_ns"));
  table.rings = vectors<std::uint16_t>(entry<Numbers<std::uint16_t>>(arrays, "rings"));
  return table;
}

/// A sensor from the keys of a sensor file; `files` lists the files that it was originally read
/// from, and the pair names the variant and mode of these.
Shared parse(const std::string& text, const std::optional<nb::dict>& table,
             const std::vector<std::string>& files,
             const std::pair<std::string, std::string>& variant_and_mode) {
  Sensor sensor = table ? parse_sensor(text, table_of(*table)) : parse_sensor(text);
  sensor.files.insert(sensor.files.end(), files.begin(), files.end());
  const auto& [variant, mode] = variant_and_mode;
  if (!variant.empty()) sensor.variant = variant;
  if (!mode.empty()) sensor.mode = mode;
  return make(std::move(sensor));
}

/// Options that change a sensor, as on the command line.
Shared changed(const SensorHandle& handle, const SensorOptions& options) {
  const SensorOptionNames names;
  Sensor sensor = handle.sensor();
  apply_calibrations(options, sensor);
  apply_scan(options, names, sensor);
  apply_depth_model(options, names, sensor);
  apply_weather(options, names, sensor);
  apply_returns(options, names, sensor);
  return make(std::move(sensor));
}

Shared made_ground_truth(const SensorHandle& handle) {
  return make(ground_truth_sensor(handle.sensor()));
}

/// An array of one number, or one vector, per beam.
template <class T, class Values, class Shape>
nb::object per_beam(const Values& values, const Shape& shape, nb::handle owner) {
  const T* data = values.empty() ? nullptr : reinterpret_cast<const T*>(values.data());
  return nb::cast(array_at(data, shape, owner));
}

/// The table of a sensor with such optics, as restore_sensor() accepts it; None for other optics.
/// Its arrays are views of the sensor's memory.
nb::object beam_table(const nb::handle& self) {
  const auto* table = std::get_if<RayTable>(&nb::cast<const SensorHandle&>(self).sensor().optics);
  if (table == nullptr) return nb::none();
  const std::array<std::size_t, 1> count = {table->directions.size()};
  const std::array<std::size_t, 2> triples = {count[0], 3};
  const auto kept = [](const auto& values, const nb::object& array) {
    return values.empty() ? nb::none() : array;
  };
  nb::dict arrays;
  arrays["shape"] = nb::make_tuple(table->rows, table->cols);
  arrays["period_ns"] = table->period_ns;
  arrays["directions"] = per_beam<const double>(table->directions, triples, self);
  arrays["origins_m"] =
      kept(table->origins_m, per_beam<const double>(table->origins_m, triples, self));
  arrays["times_ns"] = kept(table->times_ns, per_beam<const double>(table->times_ns, count, self));
  arrays["rings"] = kept(table->rings, per_beam<const std::uint16_t>(table->rings, count, self));
  return arrays;
}

nb::object directions(const nb::handle& self) {
  const auto beams = nb::cast<const SensorHandle&>(self).beams(0);
  const std::array<std::size_t, 3> shape = {beams->rows, beams->cols, 3};
  return per_beam<double>(beams->directions, shape, self);
}

/// One entry per number of the file: key, value, source, whether it is verified.
nb::list sheet(const std::string& name_or_path, const std::string& mode) {
  nb::list list;
  const SensorReference reference = find_sensor_file(name_or_path, mode);
  for (const DatasheetEntry& entry : load_datasheet(reference).entries) {
    list.append(nb::make_tuple(entry.key, entry.value, entry.source, entry.verified));
  }
  return list;
}

std::string description(const SensorHandle& handle) {
  return sensor_to_json(handle.sensor(), *handle.beams(0));
}

/// What equal sensors have in common: all numbers and the name.
std::string values(const SensorHandle& handle) {
  Sensor sensor = handle.sensor();
  sensor.notes.clear();
  return sensor_document(sensor);
}

/// One entry per preset: name, title, aliases, modes, default mode ("": none).
nb::list presets(const std::string& text) {
  nb::list list;
  for (const SensorPreset& preset : matching_presets(text)) {
    list.append(nb::make_tuple(preset.name, preset.title, preset.aliases, preset.modes,
                               preset.default_mode));
  }
  return list;
}

/// The file, and the variant of a family or an empty text.
nb::tuple sensor_file(const std::string& name_or_path) {
  const SensorReference reference = find_sensor_file(name_or_path);
  return nb::make_tuple(reference.file, reference.variant);
}

void bind_options(nb::module_& module) {
  nb::class_<SensorOptions>(module, "SensorOptions")
      .def(nb::init<>())
      .def_rw("calibration_files", &SensorOptions::calibration_files)
      .def_rw("rate_hz", &SensorOptions::rate_hz)
      .def_rw("columns_per_turn", &SensorOptions::columns_per_turn)
      .def_rw("visibility_m", &SensorOptions::visibility_m)
      .def_rw("rain_mm_per_h", &SensorOptions::rain_mm_per_h)
      .def_rw("snow_mm_per_h", &SensorOptions::snow_mm_per_h)
      .def(
          "set_depth_model",
          [](SensorOptions& self, const std::string& name) {
            self.depth_model = depth_model_named("depth_model", name);
          },
          nb::arg("name"))
      .def(
          "set_returns",
          [](SensorOptions& self, const std::vector<std::string>& words) {
            self.returns = parse_returns("returns", words);
          },
          nb::arg("words"));
}

}  // namespace

void bind_sensor(nb::module_& module) {
  bind_options(module);
  nb::class_<SensorHandle>(module, "Sensor")
      .def_prop_ro("name", [](const SensorHandle& self) { return self.sensor().name; })
      .def_prop_ro("rate_hz", [](const SensorHandle& self) { return self.sensor().rate_hz; })
      .def_prop_ro("kind",
                   [](const SensorHandle& self) { return type_info(self.sensor().optics).name; })
      .def_prop_ro("rows", [](const SensorHandle& self) { return self.beams(0)->rows; })
      .def_prop_ro("cols", [](const SensorHandle& self) { return self.beams(0)->cols; })
      .def_prop_ro("returns", [](const SensorHandle& self) { return self.beams(0)->returns; })
      .def_prop_ro("frame_id", [](const SensorHandle& self) { return self.beams(0)->frame_id; })
      .def_prop_ro("directions", directions, nb::sig("def directions(self) -> numpy.ndarray"))
      .def_prop_ro("variant", [](const SensorHandle& self) { return self.sensor().variant; })
      .def_prop_ro("mode", [](const SensorHandle& self) { return self.sensor().mode; })
      .def_prop_ro("notes", [](const SensorHandle& self) { return self.sensor().notes; })
      .def_prop_ro("files", [](const SensorHandle& self) { return self.sensor().files; })
      .def("description", description)
      .def("document", [](const SensorHandle& self) { return sensor_document(self.sensor()); })
      .def("values", values)
      .def("beam_table", beam_table,
           nb::sig("def beam_table(self) -> dict[str, typing.Any] | None"))
      .def("changed", changed, nb::arg("options"))
      .def("ground_truth", made_ground_truth);
  module.def("load_sensor", load, nb::arg("name_or_path"), nb::arg("mode") = "");
  module.def("load_sensor_content", load_content, nb::arg("path"), nb::arg("content"),
             nb::arg("variant"), nb::arg("mode"),
             nb::sig("def load_sensor_content(path: str, content: str, variant: str, mode: str) "
                     "-> Sensor"));
  module.def(
      "parse_sensor", parse, nb::arg("text"), nb::arg("table").none() = nb::none(),
      nb::arg("files") = std::vector<std::string>(),
      nb::arg("variant_and_mode") = std::pair<std::string, std::string>(),
      nb::sig("def parse_sensor(text: str, table: dict[str, typing.Any] | None = None, "
              "files: list[str] = [], variant_and_mode: tuple[str, str] = ('', '')) -> Sensor"));
  module.def("datasheet", sheet, nb::arg("name_or_path"), nb::arg("mode") = "",
             nb::sig("def datasheet(name_or_path: str, mode: str = '') -> "
                     "list[tuple[str, str, str, bool]]"));
  module.def("sensor_file", sensor_file, nb::arg("name_or_path"),
             nb::sig("def sensor_file(name_or_path: str) -> tuple[pathlib.Path, str]"));
  module.def("sensor_folder", sensor_folder);
  module.def("sensor_presets", presets, nb::arg("text") = "",
             nb::sig("def sensor_presets(text: str = '') -> "
                     "list[tuple[str, str, list[str], list[str], str]]"));
}

namespace {

using Rows3 = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
using Rows16 = Eigen::Matrix<double, Eigen::Dynamic, 16, Eigen::RowMajor>;
using Times = Eigen::Matrix<std::int64_t, Eigen::Dynamic, 1>;

Rows3 rows(const ImuSamples::Vectors& vectors) {
  Rows3 result(static_cast<Eigen::Index>(vectors.size()), 3);
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    result.row(static_cast<Eigen::Index>(i)) = vectors[i].transpose();
  }
  return result;
}

/// Poses row by row, 16 numbers each.
Rows16 rows(const std::vector<Pose>& poses) {
  Rows16 result(static_cast<Eigen::Index>(poses.size()), 16);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Matrix4 matrix = matrix_of(poses[i]);
    result.row(static_cast<Eigen::Index>(i)) =
        Eigen::Map<const Eigen::Matrix<double, 1, 16>>(matrix.data());
  }
  return result;
}

nb::dict arrays_of(const ImuSamples& samples) {
  const ImuSamples::GroundTruth& truth = samples.ground_truth;
  const auto count = static_cast<Eigen::Index>(samples.t_ns.size());
  nb::dict arrays;
  arrays["t_ns"] = Times(Eigen::Map<const Times>(samples.t_ns.data(), count));
  arrays["angular_velocity"] = rows(samples.angular_velocity_rad_s);
  arrays["specific_force"] = rows(samples.specific_force_m_s2);
  arrays["true_angular_velocity"] = rows(truth.angular_velocity_rad_s);
  arrays["true_specific_force"] = rows(truth.specific_force_m_s2);
  arrays["gyroscope_bias"] = rows(truth.gyroscope_bias_rad_s);
  arrays["accelerometer_bias"] = rows(truth.accelerometer_bias_m_s2);
  arrays["velocity"] = rows(truth.velocity_m_s);
  arrays["world_from_imu"] = rows(truth.world_from_imu);
  return arrays;
}

/// The run of an IMU, and the times of its samples.
struct ImuRunHandle {
  ImuRun run;
  std::int64_t from_ns = 0;
  std::int64_t until_ns = 0;
};

nb::dict simulate(const ImuHandle& imu, const Trajectories& motion, const ImuRunHandle& run) {
  ImuSamples samples;
  {
    const nb::gil_scoped_release release;
    samples = simulate_imu(imu.imu, motion.all.at(0), run.run, run.from_ns, run.until_ns);
  }
  return arrays_of(samples);
}

std::vector<std::string> preset_names() {
  std::vector<std::string> names;
  for (const std::filesystem::path& file : imu_preset_files())
    names.push_back(file.stem().string());
  return names;
}

void bind_run(nb::module_& module) {
  nb::class_<ImuRunHandle>(module, "ImuRun", "Seed, start and times of an IMU's samples.")
      .def(nb::init<>())
      .def_prop_rw(
          "seed", [](const ImuRunHandle& self) { return self.run.seed; },
          [](ImuRunHandle& self, std::uint64_t seed) { self.run.seed = seed; })
      .def_prop_rw(
          "imu", [](const ImuRunHandle& self) { return self.run.imu; },
          [](ImuRunHandle& self, std::uint32_t imu) { self.run.imu = imu; })
      .def_prop_rw(
          "start_ns", [](const ImuRunHandle& self) { return self.run.start_ns; },
          [](ImuRunHandle& self, std::int64_t start_ns) { self.run.start_ns = start_ns; })
      .def_prop_rw(
          "gravity_m_s2",
          [](const ImuRunHandle& self) { return Eigen::Vector3d(self.run.gravity_m_s2); },
          [](ImuRunHandle& self, const Eigen::Vector3d& g) { self.run.gravity_m_s2 = g; })
      .def_rw("from_ns", &ImuRunHandle::from_ns)
      .def_rw("until_ns", &ImuRunHandle::until_ns);
}

}  // namespace

void bind_imu(nb::module_& module) {
  nb::class_<ImuHandle>(module, "Imu", "An inertial measurement unit.")
      .def_prop_ro("name", [](const ImuHandle& self) { return self.imu.name; })
      .def_prop_ro("rate_hz", [](const ImuHandle& self) { return self.imu.rate_hz; })
      .def("document", [](const ImuHandle& self) { return imu_document(self.imu); })
      .def("ground_truth",
           [](const ImuHandle& self) { return ImuHandle{ground_truth_imu(self.imu)}; });
  bind_run(module);
  module.def("imu_names", preset_names);
  module.def(
      "load_imu",
      [](const std::string& name) { return ImuHandle{load_imu_file(find_imu_file(name))}; },
      nb::arg("name_or_path"));
  module.def(
      "parse_imu", [](const std::string& text) { return ImuHandle{parse_imu(text)}; },
      nb::arg("text"));
  module.def("simulate_imu", simulate, nb::arg("imu"), nb::arg("motion"), nb::arg("run"),
             nb::sig("def simulate_imu(imu: Imu, motion: Trajectories, run: ImuRun) -> "
                     "dict[str, numpy.ndarray]"));
}

}  // namespace glidar::python
