// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "convert.hpp"
#include "report.hpp"

#include <glidar/depth_camera/stereo.hpp>

#include <nanobind/stl/string.h>

namespace glidar::python {
namespace {

using Levels = nb::ndarray<const std::uint16_t, nb::shape<-1, -1>, nb::c_contig, nb::device::cpu>;

GreyImage grey_image(const Levels& levels, std::uint32_t max_level) {
  GreyImage image = {static_cast<std::uint32_t>(levels.shape(1)),
                     static_cast<std::uint32_t>(levels.shape(0)), max_level};
  image.level.assign(levels.data(), levels.data() + levels.size());
  return image;
}

/// Disparities, statuses, and costs or None.
nb::tuple match(const Levels& left, const Levels& right, std::uint32_t max_level,
                const StereoOptions& options, bool keeps_costs, unsigned threads) {
  StereoMatch result = unlocked([&](Watch& watch) {
    ThreadPool pool(threads);
    return match_stereo(grey_image(left, max_level), grey_image(right, max_level), options,
                        {.pool = &pool, .keeps_costs = keeps_costs, .progress = watch.progress()});
  });
  const std::array<std::size_t, 2> shape = {result.height, result.width};
  nb::object cost = nb::none();
  if (keeps_costs) {
    const std::array<std::size_t, 3> cells = {result.height, result.width, result.disparities};
    cost = array_from(std::move(result.cost), cells);
  }
  return nb::make_tuple(array_from(std::move(result.disparity_px), shape),
                        array_from(status_bytes(result.status), shape), cost);
}

nb::object depth(const nb::ndarray<const float, nb::shape<-1, -1>, nb::c_contig>& disparity_px,
                 double focal_length_px, double baseline_m, double column_offset_px,
                 double depth_unit_m) {
  StereoMatch match;
  match.disparity_px.assign(disparity_px.data(), disparity_px.data() + disparity_px.size());
  const std::array<std::size_t, 2> shape = {disparity_px.shape(0), disparity_px.shape(1)};
  return array_from(stereo_depth_m(match, {.focal_length_px = focal_length_px,
                                           .baseline_m = baseline_m,
                                           .column_offset_px = column_offset_px,
                                           .depth_unit_m = depth_unit_m}),
                    shape);
}

nb::dict explain(const Levels& left, const Levels& right, std::uint32_t max_level,
                 const StereoOptions& options, std::uint32_t column, std::uint32_t row) {
  StereoTrace trace = unlocked([&](Watch& watch) {
    ThreadPool pool;
    return explain_stereo(grey_image(left, max_level), grey_image(right, max_level), options,
                          {column, row}, {.pool = &pool, .progress = watch.progress()});
  });
  nb::list tests;
  for (const StereoTest& test : trace.tests) {
    tests.append(nb::make_tuple(to_string(test.failure), test.has_passed, test.finding));
  }
  nb::dict result;
  result["text"] = format_stereo_trace(trace);
  result["status"] = static_cast<unsigned>(trace.status);
  result["winner_px"] = trace.winner_px;
  result["right_winner_px"] = trace.right_winner_px;
  result["offset_px"] = trace.offset_px;
  result["corrected_offset_px"] = trace.corrected_offset_px;
  result["disparity_px"] = trace.disparity_px;
  result["tests"] = tests;
  const std::array<std::size_t, 1> shape = {trace.summed_cost.size()};
  result["matching_cost"] = array_from(std::move(trace.matching_cost), shape);
  result["summed_cost"] = array_from(std::move(trace.summed_cost), shape);
  return result;
}

nb::tuple sample() {
  const auto levels = [](const GreyImage& image) {
    std::vector<std::uint8_t> bytes;
    for (const std::uint16_t level : image.level) bytes.push_back(static_cast<std::uint8_t>(level));
    return array_from(std::move(bytes), std::array<std::size_t, 2>{image.height, image.width});
  };
  const StereoPair pair = sample_stereo_pair();
  return nb::make_tuple(levels(pair.left), levels(pair.right));
}

void bind_options(nb::module_& module) {
  nb::class_<StereoOptions>(module, "StereoOptions")
      .def(nb::init<>())
      .def_rw("min_disparity_px", &StereoOptions::min_disparity_px)
      .def_rw("disparities", &StereoOptions::disparities)
      .def_prop_rw(
          "census", [](const StereoOptions& self) { return static_cast<unsigned>(self.census); },
          [](StereoOptions& self, unsigned kind) { self.census = static_cast<StereoCensus>(kind); })
      .def_rw("box_px", &StereoOptions::box_px)
      .def_rw("paths", &StereoOptions::paths)
      .def_rw("p1", &StereoOptions::p1)
      .def_rw("p2", &StereoOptions::p2)
      .def_prop_rw(
          "subpixel",
          [](const StereoOptions& self) { return static_cast<unsigned>(self.subpixel); },
          [](StereoOptions& self, unsigned curve) {
            self.subpixel = static_cast<StereoSubpixel>(curve);
          })
      .def_rw("a_factor", &StereoOptions::a_factor)
      .def_rw("uniqueness_percent", &StereoOptions::uniqueness_percent)
      .def_rw("has_left_right_test", &StereoOptions::has_left_right_test)
      .def_rw("left_right_px", &StereoOptions::left_right_px)
      .def_rw("min_texture", &StereoOptions::min_texture)
      .def_rw("saturation_level", &StereoOptions::saturation_level)
      .def_rw("steps_per_px", &StereoOptions::steps_per_px);
}

}  // namespace

void bind_stereo(nb::module_& module) {
  bind_options(module);
  module.def("match_stereo", match, nb::arg("left"), nb::arg("right"), nb::arg("max_level"),
             nb::arg("options"), nb::arg("keeps_costs"), nb::arg("threads"),
             nb::sig("def match_stereo(left: object, right: object, max_level: int, options: "
                     "StereoOptions, keeps_costs: bool, threads: int) -> tuple[typing.Any, "
                     "typing.Any, typing.Any]"));
  module.def("stereo_depth", depth, nb::arg("disparity_px"), nb::arg("focal_length_px"),
             nb::arg("baseline_m"), nb::arg("column_offset_px"), nb::arg("depth_unit_m"),
             nb::sig("def stereo_depth(disparity_px: object, focal_length_px: float, baseline_m: "
                     "float, column_offset_px: float, depth_unit_m: float) -> typing.Any"));
  module.def("explain_stereo", explain, nb::arg("left"), nb::arg("right"), nb::arg("max_level"),
             nb::arg("options"), nb::arg("column"), nb::arg("row"),
             nb::sig("def explain_stereo(left: object, right: object, max_level: int, options: "
                     "StereoOptions, column: int, row: int) -> dict[str, typing.Any]"));
  module.def("sample_stereo_pair", sample,
             nb::sig("def sample_stereo_pair() -> tuple[typing.Any, typing.Any]"));
}

}  // namespace glidar::python
