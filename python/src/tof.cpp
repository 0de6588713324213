// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "convert.hpp"
#include "frame.hpp"
#include "report.hpp"

#include <glidar/depth_camera/time_of_flight.hpp>

#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

namespace glidar::python {
namespace {

using Levels = nb::ndarray<const float, nb::shape<-1, -1, -1, -1>, nb::c_contig, nb::device::cpu>;
using Floats = std::optional<Numbers<float>>;
using Bytes = std::optional<Numbers<std::uint8_t>>;

/// Raw images of frequencies x taps x rows x columns.
TofImages images_of(const Levels& levels) {
  TofImages images{
      static_cast<std::uint32_t>(levels.shape(3)), static_cast<std::uint32_t>(levels.shape(2)),
      static_cast<std::uint32_t>(levels.shape(0)), static_cast<std::uint32_t>(levels.shape(1))};
  images.level.assign(levels.data(), levels.data() + levels.size());
  return images;
}

template <class T>
std::span<const T> span_of(const std::optional<Numbers<T>>& values) {
  return values ? std::span<const T>(values->data(), values->size()) : std::span<const T>();
}

TofCalibration calibration_of(const Floats& depth_per_range, const Floats& phase_offset_rad,
                              const Bytes& is_illuminated) {
  return {span_of(depth_per_range), span_of(phase_offset_rad), span_of(is_illuminated)};
}

/// Ranges, statuses, amplitudes, phases and misfits.
nb::tuple decode(const Levels& levels, const TofOptions& options, const Floats& depth_per_range,
                 const Floats& phase_offset_rad, const Bytes& is_illuminated, unsigned threads) {
  const TofCalibration calibration =
      calibration_of(depth_per_range, phase_offset_rad, is_illuminated);
  TofMeasurement result = unlocked([&](Watch& /*watch*/) {
    ThreadPool pool(threads);
    return decode_tof(images_of(levels), options, calibration, {.pool = &pool});
  });
  const std::array<std::size_t, 2> image = {result.height, result.width};
  const std::array<std::size_t, 3> images = {result.frequencies, result.height, result.width};
  return nb::make_tuple(array_from(std::move(result.range_m), image),
                        array_from(status_bytes(result.status), image),
                        array_from(std::move(result.amplitude), images),
                        array_from(std::move(result.phase_rad), images),
                        array_from(std::move(result.misfit_rad), image));
}

nb::dict trace_dict(const TofTrace& trace) {
  nb::list tests;
  for (const TofTest& test : trace.tests) {
    tests.append(nb::make_tuple(to_string(test.failure), test.has_passed, test.finding));
  }
  nb::list candidates;
  for (const TofCandidate& candidate : trace.candidates) {
    candidates.append(nb::make_tuple(candidate.range_m, candidate.misfit_rad, candidate.periods));
  }
  nb::dict result;
  result["text"] = format_tof_trace(trace);
  result["status"] = static_cast<unsigned>(trace.status);
  result["range_m"] = trace.range_m;
  result["depth_m"] = trace.depth_m;
  result["misfit_rad"] = trace.misfit_rad;
  result["levels"] = trace.levels;
  result["amplitude"] = trace.amplitude;
  result["phase_rad"] = trace.phase_rad;
  result["tests"] = tests;
  result["candidates"] = candidates;
  return result;
}

nb::dict explain(const Levels& levels, const TofOptions& options, const nb::tuple& calibration,
                 std::uint32_t column, std::uint32_t row) {
  const auto depth_per_range = nb::cast<Floats>(calibration[0]);
  const auto phase_offset_rad = nb::cast<Floats>(calibration[1]);
  const auto is_illuminated = nb::cast<Bytes>(calibration[2]);
  const TofCalibration known = calibration_of(depth_per_range, phase_offset_rad, is_illuminated);
  return trace_dict(unlocked([&](Watch& /*watch*/) {
    ThreadPool pool;
    return explain_tof(images_of(levels), options, {column, row}, known, {.pool = &pool});
  }));
}

nb::tuple sample() {
  TofSample result = sample_tof_images();
  const TofImages& images = result.images;
  const std::array<std::size_t, 2> image = {images.height, images.width};
  const std::array<std::size_t, 4> raw = {images.frequencies, images.taps, images.height,
                                          images.width};
  return nb::make_tuple(array_from(std::move(result.images.level), raw),
                        array_from(std::move(result.depth_per_range), image),
                        array_from(std::move(result.is_illuminated), image));
}

void bind_tests(nb::module_& module) {
  nb::class_<TofMisfitTest>(module, "TofMisfitTest")
      .def(nb::init<>())
      .def_rw("min_rad", &TofMisfitTest::min_rad)
      .def_rw("max_rad", &TofMisfitTest::max_rad)
      .def_rw("scale", &TofMisfitTest::scale)
      .def_rw("exponent", &TofMisfitTest::exponent);
  nb::class_<TofFilter>(module, "TofFilter")
      .def(nb::init<>())
      .def_rw("min_amplitude", &TofFilter::min_amplitude)
      .def_rw("phase_weight", &TofFilter::phase_weight)
      .def_rw("max_phase_change", &TofFilter::max_phase_change);
  nb::class_<TofEdgeTest>(module, "TofEdgeTest")
      .def(nb::init<>())
      .def_rw("amplitude_deviation", &TofEdgeTest::amplitude_deviation)
      .def_rw("min_mean_amplitude", &TofEdgeTest::min_mean_amplitude)
      .def_rw("near_step_m", &TofEdgeTest::near_step_m)
      .def_rw("far_step_m", &TofEdgeTest::far_step_m)
      .def_rw("max_step_m", &TofEdgeTest::max_step_m)
      .def_rw("mean_step_m", &TofEdgeTest::mean_step_m);
}

void bind_options(nb::module_& module) {
  nb::class_<TofOptions>(module, "TofOptions")
      .def(nb::init<>())
      .def_rw("frequencies_hz", &TofOptions::frequencies_hz)
      .def_rw("taps", &TofOptions::taps)
      .def_rw("amplitude_gain", &TofOptions::amplitude_gain)
      .def_rw("saturation_level", &TofOptions::saturation_level)
      .def_prop_rw(
          "unwrapping",
          [](const TofOptions& self) { return static_cast<unsigned>(self.unwrapping); },
          [](TofOptions& self, unsigned method) {
            self.unwrapping = static_cast<TofUnwrapping>(method);
          })
      .def_rw("min_amplitude", &TofOptions::min_amplitude)
      .def_rw("min_amplitude_sum", &TofOptions::min_amplitude_sum)
      .def_rw("misfit_test", &TofOptions::misfit_test)
      .def_rw("filter", &TofOptions::filter, nb::arg().none())
      .def_rw("edge_test", &TofOptions::edge_test, nb::arg().none())
      .def_rw("near_m", &TofOptions::near_m)
      .def_rw("far_m", &TofOptions::far_m);
}

/// Raw images of a frame, frequencies x taps x rows x columns, or None.
nb::object frame_tof_images(nb::handle self) {
  const TofImages& images = nb::cast<const Measured&>(self).frame.tof_images;
  if (images.level.empty()) return nb::none();
  const std::array<std::size_t, 4> shape = {images.frequencies, images.taps, images.height,
                                            images.width};
  return nb::cast(array_at(images.level.data(), shape, self));
}

}  // namespace

void bind_tof(nb::module_& module) {
  bind_tests(module);
  bind_options(module);
  module.def("kinect_v2_options", kinect_v2_options);
  module.def("decode_tof", decode, nb::arg("levels"), nb::arg("options"),
             nb::arg("depth_per_range").none(), nb::arg("phase_offset_rad").none(),
             nb::arg("is_illuminated").none(), nb::arg("threads"),
             nb::sig("def decode_tof(levels: object, options: TofOptions, depth_per_range: object, "
                     "phase_offset_rad: object, is_illuminated: object, threads: int) -> "
                     "tuple[typing.Any, typing.Any, typing.Any, typing.Any, typing.Any]"));
  module.def("explain_tof", explain, nb::arg("levels"), nb::arg("options"), nb::arg("calibration"),
             nb::arg("column"), nb::arg("row"),
             nb::sig("def explain_tof(levels: object, options: TofOptions, calibration: "
                     "tuple[object, object, object], column: int, row: int) -> dict[str, "
                     "typing.Any]"));
  module.def("frame_tof_images", frame_tof_images, nb::arg("frame"),
             nb::sig("def frame_tof_images(frame: Frame) -> numpy.ndarray | None"));
  module.def("sample_tof_images", sample,
             nb::sig("def sample_tof_images() -> tuple[typing.Any, typing.Any, typing.Any]"));
}

}  // namespace glidar::python
