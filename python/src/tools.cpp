// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "convert.hpp"
#include "objects.hpp"
#include "report.hpp"

#include <glidar/io/config/surface_presets.hpp>
#include <glidar/io/files/atomic_file.hpp>
#include <glidar/io/formats/fisher_information_file.hpp>
#include <glidar/math/portable.hpp>
#include <glidar/sensor/fisher_information.hpp>
#include <glidar/verify/verify.hpp>

#include <nanobind/eigen/dense.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <map>

namespace glidar::python {
namespace {

FisherInformation information(const Measured& measured, double sigma_m,
                              const PoseArray& sensor_from_reference,
                              std::optional<std::uint32_t> instance) {
  FisherOptions options;
  options.sigma_m = sigma_m;
  options.sensor_from_reference = pose_of(sensor_from_reference, 0, "reference");
  options.instance = instance;
  const nb::gil_scoped_release release;
  return pose_information(measured.frame, *measured.beams, options);
}

std::vector<AccuracyCase> verified(const std::string& renderer, unsigned threads) {
  return unlocked([&](Watch& watch) {
    return verify({.kind = renderer, .threads = threads}, watch.progress());
  });
}

std::vector<std::string> surface_names() {
  std::vector<std::string> names;
  for (const SurfacePreset& surface : load_surfaces()) names.push_back(surface.name);
  return names;
}

nb::dict state_of(const FisherInformation& information) {
  nb::list directions;
  for (const EigenDirection& one : information.directions) {
    directions.append(nb::make_tuple(one.eigenvalue, one.degenerate, one.displacement, one.words));
  }
  nb::dict state;
  state["matrix"] = information.matrix;
  state["covariance"] = information.covariance;
  state["bound"] = information.bound;
  state["directions"] = directions;
  state["condition"] = information.condition;
  state["length_m"] = information.length_m;
  state["middle_m"] = information.middle_m;
  state["returns"] = information.returns;
  state["left_out"] = information.left_out;
  state["assumed_sigma_m"] = information.assumed_sigma_m;
  return state;
}

FisherInformation restore_information(const nb::dict& state) {
  FisherInformation information;
  information.matrix = nb::cast<Matrix6>(state["matrix"]);
  information.covariance = nb::cast<Matrix6>(state["covariance"]);
  information.bound = nb::cast<Vector6>(state["bound"]);
  const auto directions = nb::cast<nb::list>(state["directions"]);
  for (std::size_t k = 0; k < information.directions.size(); ++k) {
    const auto one = nb::cast<nb::tuple>(directions[k]);
    information.directions[k] = {nb::cast<double>(one[0]), nb::cast<bool>(one[1]),
                                 nb::cast<Vector6>(one[2]), nb::cast<std::string>(one[3])};
  }
  information.condition = nb::cast<double>(state["condition"]);
  information.length_m = nb::cast<double>(state["length_m"]);
  information.middle_m = nb::cast<Eigen::Vector3d>(state["middle_m"]);
  information.returns = nb::cast<std::size_t>(state["returns"]);
  information.left_out = nb::cast<std::size_t>(state["left_out"]);
  information.assumed_sigma_m = nb::cast<std::optional<double>>(state["assumed_sigma_m"]);
  return information;
}

/// Writes a file atomically.
void write_file(const std::filesystem::path& path, const nb::bytes& data) {
  AtomicFile file(path);
  file.write(std::string_view(data.c_str(), data.size()));
  file.commit();
}

/// A function with the same bits on any machine, of every number. NumPy's and SciPy's differ.
nb::object portable(const std::string& name, const Numbers<double>& numbers) {
  using Function = double (*)(double);
  static const std::map<std::string, Function> kFunctions = {
      {"sin", portable_sin},        {"cos", portable_cos},     {"arcsin", portable_asin},
      {"cbrt", portable_cbrt},      {"exp", portable_exp},     {"log", portable_log},
      {"ndtr", normal_probability}, {"ndtri", normal_quantile}};
  const Function function = kFunctions.at(name);
  std::vector<double> results(numbers.data(), numbers.data() + numbers.size());
  for (double& number : results) number = function(number);
  const std::size_t size = results.size();
  return array_from(std::move(results), std::array{size});
}

void bind_information(nb::module_& module) {
  nb::class_<EigenDirection>(module, "EigenDirection")
      .def_ro("eigenvalue", &EigenDirection::eigenvalue)
      .def_ro("degenerate", &EigenDirection::degenerate)
      .def_ro("displacement", &EigenDirection::displacement)
      .def_ro("words", &EigenDirection::words);
  nb::class_<FisherInformation>(module, "FisherInformation")
      .def_ro("matrix", &FisherInformation::matrix)
      .def_ro("covariance", &FisherInformation::covariance)
      .def_ro("bound", &FisherInformation::bound)
      .def_ro("directions", &FisherInformation::directions)
      .def_ro("condition", &FisherInformation::condition)
      .def_ro("length_m", &FisherInformation::length_m)
      .def_ro("middle_m", &FisherInformation::middle_m)
      .def_ro("returns", &FisherInformation::returns)
      .def_ro("left_out", &FisherInformation::left_out)
      .def_ro("assumed_sigma_m", &FisherInformation::assumed_sigma_m)
      .def("text", information_text)
      .def("json", information_json)
      .def("save", write_information, nb::arg("path"),
           nb::sig("def save(self, path: str) -> None"));
  module.def("fisher_information", information, nb::arg("frame"), nb::arg("sigma_m"),
             nb::arg("sensor_from_reference"), nb::arg("instance").none());
  module.def(
      "information_state", state_of, nb::arg("fisher_information"),
      nb::sig("def information_state(information: FisherInformation) -> dict[str, typing.Any]"));
  module.def("restore_information", restore_information, nb::arg("state"),
             nb::sig("def restore_information(state: dict[str, typing.Any]) -> FisherInformation"));
}

}  // namespace

void bind_tools(nb::module_& module) {
  bind_information(module);
  module.def("portable", portable, nb::arg("name"), nb::arg("numbers"));
  nb::class_<AccuracyCase>(module, "AccuracyCase")
      .def_ro("name", &AccuracyCase::name)
      .def_ro("shape", &AccuracyCase::shape)
      .def_ro("distance_m", &AccuracyCase::distance_m)
      .def_prop_ro("rays", [](const AccuracyCase& self) { return self.result.rays; })
      .def_prop_ro("compared_hits",
                   [](const AccuracyCase& self) { return self.result.compared_hits; })
      .def_prop_ro("compared_misses",
                   [](const AccuracyCase& self) { return self.result.compared_misses; })
      .def_prop_ro("near_edges", [](const AccuracyCase& self) { return self.result.near_edges; })
      .def_prop_ro("wrong_hits", [](const AccuracyCase& self) { return self.result.wrong_hits; })
      .def_prop_ro("wrong_misses",
                   [](const AccuracyCase& self) { return self.result.wrong_misses; })
      .def_prop_ro("wrong_ids", [](const AccuracyCase& self) { return self.result.wrong_ids; })
      .def_prop_ro("range_error_m",
                   [](const AccuracyCase& self) { return self.result.range_error_m; })
      .def_prop_ro("range_error_ulp",
                   [](const AccuracyCase& self) { return self.result.range_error_ulp; })
      .def_prop_ro("normal_error_rad",
                   [](const AccuracyCase& self) { return self.result.normal_error_rad; })
      .def_prop_ro("other_error", [](const AccuracyCase& self) { return self.result.other_error; })
      .def_prop_ro("known_failure", [](const AccuracyCase& self) { return self.known.reason; })
      .def_prop_ro("verdict", [](const AccuracyCase& self) {
        return std::string(verdict_name(self.verdict()));
      });
  module.def("verify", verified, nb::arg("renderer"), nb::arg("threads"));
  module.def("surface_names", surface_names);
  module.def("write_file", write_file, nb::arg("path"), nb::arg("data"),
             nb::sig("def write_file(path: str, data: bytes) -> None"));
}

}  // namespace glidar::python
