// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "convert.hpp"

#include <glidar/depth_camera/structured_light.hpp>
#include <glidar/io/config/depth_camera_files.hpp>

#include <nanobind/stl/string.h>

namespace glidar::python {
namespace {

using LevelStack =
    nb::ndarray<const std::uint16_t, nb::shape<-1, -1, -1>, nb::c_contig, nb::device::cpu>;

std::vector<GreyImage> grey_images(const LevelStack& levels, std::uint32_t max_level) {
  std::vector<GreyImage> images(levels.shape(0));
  const std::size_t pixels = levels.shape(1) * levels.shape(2);
  for (std::size_t i = 0; i < images.size(); ++i) {
    images[i] = {static_cast<std::uint32_t>(levels.shape(2)),
                 static_cast<std::uint32_t>(levels.shape(1)), max_level};
    images[i].level.assign(levels.data() + i * pixels, levels.data() + (i + 1) * pixels);
  }
  return images;
}

nb::object patterns(const StructuredLight& setup) {
  const FringePatterns& sequence = setup.patterns;
  std::vector<std::uint8_t> levels;
  for (std::size_t i = 0; i < image_count(sequence); ++i) {
    const GreyImage pattern = make_pattern(sequence, i);
    levels.insert(levels.end(), pattern.level.begin(), pattern.level.end());
  }
  const std::array<std::size_t, 3> shape = {image_count(sequence), sequence.height, sequence.width};
  return array_from(std::move(levels), shape);
}

nb::dict decode(const StructuredLight& setup, const LevelStack& levels, std::uint32_t max_level,
                unsigned threads) {
  const std::vector<GreyImage> images = grey_images(levels, max_level);
  MeasuredFringes measured;
  {
    const nb::gil_scoped_release unlocked;
    ThreadPool pool(threads);
    measured = measure_fringes(images, setup, &pool);
  }
  DecodedFringes& decoded = measured.decoded;
  const std::array<std::size_t, 2> shape = {decoded.height, decoded.width};
  std::vector<std::uint8_t> status;
  for (const FringeStatus one : decoded.status) status.push_back(static_cast<std::uint8_t>(one));
  nb::dict result;
  result["depth_m"] = array_from(std::move(measured.depth_m), shape);
  result["coordinate_px"] = array_from(std::move(decoded.coordinate_px), shape);
  result["phase_rad"] = array_from(std::move(decoded.phase_rad), shape);
  result["modulation"] = array_from(std::move(decoded.modulation), shape);
  result["mean_level"] = array_from(std::move(decoded.mean_level), shape);
  result["status"] = array_from(std::move(status), shape);
  return result;
}

nb::dict explain(const StructuredLight& setup, const LevelStack& levels, std::uint32_t max_level,
                 std::uint32_t column, std::uint32_t row) {
  FringeTrace trace = explain_fringes(grey_images(levels, max_level), setup, {column, row});
  nb::list tests;
  for (const FringeTest& test : trace.tests) {
    tests.append(nb::make_tuple(to_string(test.failure), test.has_passed, test.finding));
  }
  nb::dict result;
  result["text"] = format_fringe_trace(trace);
  result["status"] = static_cast<unsigned>(trace.status);
  result["phase_rad"] = trace.phase_rad;
  result["modulation"] = trace.modulation;
  result["mean_level"] = trace.mean_level;
  result["stripe"] = trace.stripe;
  result["period"] = trace.period;
  result["code_error"] = trace.code_error;
  result["coordinate_px"] = trace.coordinate_px;
  result["tests"] = tests;
  const std::array<std::size_t, 1> shape = {trace.levels.size()};
  result["levels"] = array_from(std::move(trace.levels), shape);
  return result;
}

}  // namespace

void bind_structured_light(nb::module_& module) {
  nb::class_<StructuredLight>(module, "StructuredLight")
      .def(
          "__init__",
          [](StructuredLight* self, const std::string& source, bool is_file) {
            new (self) StructuredLight(is_file ? load_structured_light(source)
                                               : parse_structured_light(source));
          },
          nb::arg("source"), nb::arg("is_file"))
      .def("patterns", patterns, nb::sig("def patterns(self) -> typing.Any"))
      .def("explain", explain, nb::arg("levels"), nb::arg("max_level"), nb::arg("column"),
           nb::arg("row"),
           nb::sig("def explain(self, levels: object, max_level: int, column: int, row: int) -> "
                   "dict[str, typing.Any]"))
      .def("decode", decode, nb::arg("levels"), nb::arg("max_level"), nb::arg("threads"),
           nb::sig("def decode(self, levels: object, max_level: int, threads: int) -> "
                   "dict[str, typing.Any]"));
}

}  // namespace glidar::python
