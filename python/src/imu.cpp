// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "imu.hpp"

#include "bind.hpp"

#include "motion.hpp"

#include <glidar/io/config/imu_file.hpp>
#include <glidar/simulate/simulate_imu.hpp>

#include <nanobind/eigen/dense.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

namespace glidar::python {
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
