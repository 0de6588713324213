// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "frame.hpp"
#include "report.hpp"

#include <glidar/core/error.hpp>
#include <glidar/explain/trace_text.hpp>
#include <glidar/simulate/explain.hpp>

#include <nanobind/eigen/dense.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

namespace glidar::python {
namespace {

/// A trace as text and as data.
struct TracedPoint {
  PointTrace trace;
  std::string text;
};

TracedPoint trace_point(const Measured& measured, std::size_t entry) {
  return unlocked([&](Watch& watch) {
    Frame frame;
    frame.stamp_ns = measured.frame.stamp_ns;
    frame.seed = measured.frame.seed;
    frame.sensor_id = measured.frame.sensor_id;
    frame.number = measured.frame.number;
    PreparedScene& prepared = measured.rendered();
    const std::lock_guard lock(prepared.mutex);
    Simulator simulator(*prepared.scene, measured.sensor, *prepared.renderer);
    TracedPoint traced{explain(simulator, *measured.motion, entry, frame, watch.progress()), ""};
    traced.text = format_trace(traced.trace, simulator, frame);
    return traced;
  });
}

std::vector<Measurement> measurements(const TracedPoint& traced) {
  std::vector<Measurement> all = {traced.trace.measured};
  for (const PointTrace::Step& step : traced.trace.noise) all.push_back(step.after);
  all.push_back(traced.trace.reported);
  return all;
}

std::vector<RandomSample> samples(const TracedPoint& traced, std::size_t step) {
  return traced.trace.noise.at(step).samples;
}

void bind_parts(nb::module_& module) {
  nb::class_<Measurement>(module, "Measurement")
      .def_prop_ro("status", [](const Measurement& self) { return static_cast<int>(self.status); })
      .def_prop_ro("return_source",
                   [](const Measurement& self) { return static_cast<int>(self.return_source); })
      .def_ro("range_m", &Measurement::range_m)
      .def_ro("intensity", &Measurement::intensity)
      .def_ro("sigma_m", &Measurement::sigma_m)
      .def_ro("radial_velocity_m_s", &Measurement::radial_velocity_m_s);
  nb::class_<RandomSample>(module, "RandomSample")
      .def_prop_ro("is_normal",
                   [](const RandomSample& self) {
                     return self.distribution == RandomSample::Distribution::normal;
                   })
      .def_ro("value", &RandomSample::value)
      .def_ro("use", &RandomSample::use)
      .def_ro("probability", &RandomSample::probability);
  nb::class_<PulseEcho>(module, "Echo")
      .def_ro("range_m", &PulseEcho::range_m)
      .def_ro("signal", &PulseEcho::signal)
      .def_ro("sigma_m", &PulseEcho::sigma_m)
      .def_ro("is_mixed", &PulseEcho::is_mixed);
}

}  // namespace

void bind_point_trace(nb::module_& module) {
  bind_parts(module);
  nb::class_<TracedPoint>(module, "PointTrace")
      .def_ro("text", &TracedPoint::text)
      .def_prop_ro("entry", [](const TracedPoint& self) { return self.trace.entry; })
      .def_prop_ro("direction", [](const TracedPoint& self) { return self.trace.direction; })
      .def_prop_ro("measurements", measurements)
      .def("samples", samples, nb::arg("step"))
      .def_prop_ro("echoes", [](const TracedPoint& self) {
        return self.trace.waveform ? self.trace.waveform->received : std::vector<PulseEcho>{};
      });
  module.def("explain", trace_point, nb::arg("frame"), nb::arg("entry"));
}

}  // namespace glidar::python
