// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause

#include <glidar/depth_camera/depth_filters.hpp>
#include <glidar/depth_camera/stereo.hpp>
#include <glidar/depth_camera/structured_light.hpp>
#include <glidar/depth_camera/time_of_flight.hpp>
#include <glidar/io/config/depth_camera_files.hpp>

#include "convert.hpp"
#include "objects.hpp"
#include "report.hpp"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

namespace glidar::python {
namespace {

using Depths = nb::ndarray<const std::uint16_t, nb::shape<-1, -1>, nb::c_contig, nb::device::cpu>;

DepthImage depth_image(const Depths& depth) {
  DepthImage image = {static_cast<std::uint32_t>(depth.shape(1)),
                      static_cast<std::uint32_t>(depth.shape(0))};
  image.depth.assign(depth.data(), depth.data() + depth.size());
  return image;
}

nb::object array_of(DepthImage image) {
  const std::array<std::size_t, 2> shape = {image.height, image.width};
  return array_from(std::move(image.depth), shape);
}

nb::object apply(DepthFilterChain& chain, const Depths& depth) {
  const DepthImage image = depth_image(depth);
  DepthImage filtered;
  {
    const nb::gil_scoped_release unlocked;
    filtered = chain.apply(image);
  }
  return array_of(std::move(filtered));
}

/// The aligned image, and the source of each of its pixels.
nb::tuple align(const DepthAligner& aligner, const Depths& depth) {
  const DepthImage image = depth_image(depth);
  AlignedDepth aligned;
  {
    const nb::gil_scoped_release unlocked;
    aligned = aligner.align(image);
  }
  const std::array<std::size_t, 2> shape = {aligned.image.height, aligned.image.width};
  nb::object source = array_from(std::move(aligned.source), shape);
  return nb::make_tuple(array_of(std::move(aligned.image)), source);
}

}  // namespace

void bind_depth(nb::module_& module) {
  nb::class_<DepthFilterChain>(module, "DepthFilterChain")
      .def(
          "__init__",
          [](DepthFilterChain* self, const std::string& filters, double focal_length_px,
             double unit_m) {
            new (self) DepthFilterChain(parse_depth_filters(filters),
                                        {.focal_length_px = focal_length_px, .unit_m = unit_m});
          },
          nb::arg("filters"), nb::arg("focal_length_px"), nb::arg("unit_m"))
      .def("apply", apply, nb::arg("depth"),
           nb::sig("def apply(self, depth: object) -> typing.Any"))
      .def("reset", &DepthFilterChain::reset);
  module.def("recommended_depth_filters", [](double baseline_m) {
    return depth_filters_document(recommended_depth_filters(baseline_m));
  });
  nb::class_<DepthAligner>(module, "DepthAligner")
      .def(
          "__init__",
          [](DepthAligner* self, const std::string& source, bool is_file) {
            new (self) DepthAligner(is_file ? load_depth_alignment(source)
                                            : parse_depth_alignment(source));
          },
          nb::arg("source"), nb::arg("is_file"))
      .def_prop_ro("unit_m", [](const DepthAligner& self) { return self.alignment().unit_m; })
      .def("align", align, nb::arg("depth"),
           nb::sig("def align(self, depth: object) -> tuple[typing.Any, typing.Any]"));
  module.attr("NO_SOURCE") = kNoSource;
}

namespace {

using StereoLevels =
    nb::ndarray<const std::uint16_t, nb::shape<-1, -1>, nb::c_contig, nb::device::cpu>;

GreyImage grey_image(const StereoLevels& levels, std::uint32_t max_level) {
  GreyImage image = {static_cast<std::uint32_t>(levels.shape(1)),
                     static_cast<std::uint32_t>(levels.shape(0)), max_level};
  image.level.assign(levels.data(), levels.data() + levels.size());
  return image;
}

/// Disparities, statuses, and costs or None.
nb::tuple match(const StereoLevels& left, const StereoLevels& right, std::uint32_t max_level,
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

nb::dict explain_stereo_pixel(const StereoLevels& left, const StereoLevels& right,
                              std::uint32_t max_level, const StereoOptions& options,
                              std::uint32_t column, std::uint32_t row) {
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

nb::tuple stereo_sample() {
  const auto levels = [](const GreyImage& image) {
    std::vector<std::uint8_t> bytes;
    for (const std::uint16_t level : image.level) bytes.push_back(static_cast<std::uint8_t>(level));
    return array_from(std::move(bytes), std::array<std::size_t, 2>{image.height, image.width});
  };
  const StereoPair pair = sample_stereo_pair();
  return nb::make_tuple(levels(pair.left), levels(pair.right));
}

void bind_stereo_options(nb::module_& module) {
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
  bind_stereo_options(module);
  module.def("match_stereo", match, nb::arg("left"), nb::arg("right"), nb::arg("max_level"),
             nb::arg("options"), nb::arg("keeps_costs"), nb::arg("threads"),
             nb::sig("def match_stereo(left: object, right: object, max_level: int, options: "
                     "StereoOptions, keeps_costs: bool, threads: int) -> tuple[typing.Any, "
                     "typing.Any, typing.Any]"));
  module.def("stereo_depth", depth, nb::arg("disparity_px"), nb::arg("focal_length_px"),
             nb::arg("baseline_m"), nb::arg("column_offset_px"), nb::arg("depth_unit_m"),
             nb::sig("def stereo_depth(disparity_px: object, focal_length_px: float, baseline_m: "
                     "float, column_offset_px: float, depth_unit_m: float) -> typing.Any"));
  module.def("explain_stereo", explain_stereo_pixel, nb::arg("left"), nb::arg("right"),
             nb::arg("max_level"), nb::arg("options"), nb::arg("column"), nb::arg("row"),
             nb::sig("def explain_stereo(left: object, right: object, max_level: int, options: "
                     "StereoOptions, column: int, row: int) -> dict[str, typing.Any]"));
  module.def("sample_stereo_pair", stereo_sample,
             nb::sig("def sample_stereo_pair() -> tuple[typing.Any, typing.Any]"));
}

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

nb::dict decode_fringe_images(const StructuredLight& setup, const LevelStack& levels,
                              std::uint32_t max_level, unsigned threads) {
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

nb::dict explain_fringe_pixel(const StructuredLight& setup, const LevelStack& levels,
                              std::uint32_t max_level, std::uint32_t column, std::uint32_t row) {
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
      .def("explain", explain_fringe_pixel, nb::arg("levels"), nb::arg("max_level"),
           nb::arg("column"), nb::arg("row"),
           nb::sig("def explain(self, levels: object, max_level: int, column: int, row: int) -> "
                   "dict[str, typing.Any]"))
      .def("decode", decode_fringe_images, nb::arg("levels"), nb::arg("max_level"),
           nb::arg("threads"),
           nb::sig("def decode(self, levels: object, max_level: int, threads: int) -> "
                   "dict[str, typing.Any]"));
}

namespace {

using TofLevels =
    nb::ndarray<const float, nb::shape<-1, -1, -1, -1>, nb::c_contig, nb::device::cpu>;
using Floats = std::optional<Numbers<float>>;
using Bytes = std::optional<Numbers<std::uint8_t>>;

/// Raw images of frequencies x taps x rows x columns.
TofImages images_of(const TofLevels& levels) {
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
nb::tuple decode_tof_images(const TofLevels& levels, const TofOptions& options,
                            const Floats& depth_per_range, const Floats& phase_offset_rad,
                            const Bytes& is_illuminated, unsigned threads) {
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

nb::dict explain_tof_pixel(const TofLevels& levels, const TofOptions& options,
                           const nb::tuple& calibration, std::uint32_t column, std::uint32_t row) {
  const auto depth_per_range = nb::cast<Floats>(calibration[0]);
  const auto phase_offset_rad = nb::cast<Floats>(calibration[1]);
  const auto is_illuminated = nb::cast<Bytes>(calibration[2]);
  const TofCalibration known = calibration_of(depth_per_range, phase_offset_rad, is_illuminated);
  return trace_dict(unlocked([&](Watch& /*watch*/) {
    ThreadPool pool;
    return explain_tof(images_of(levels), options, {column, row}, known, {.pool = &pool});
  }));
}

nb::tuple tof_sample() {
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

void bind_tof_options(nb::module_& module) {
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
  bind_tof_options(module);
  module.def("kinect_v2_options", kinect_v2_options);
  module.def("decode_tof", decode_tof_images, nb::arg("levels"), nb::arg("options"),
             nb::arg("depth_per_range").none(), nb::arg("phase_offset_rad").none(),
             nb::arg("is_illuminated").none(), nb::arg("threads"),
             nb::sig("def decode_tof(levels: object, options: TofOptions, depth_per_range: object, "
                     "phase_offset_rad: object, is_illuminated: object, threads: int) -> "
                     "tuple[typing.Any, typing.Any, typing.Any, typing.Any, typing.Any]"));
  module.def("explain_tof", explain_tof_pixel, nb::arg("levels"), nb::arg("options"),
             nb::arg("calibration"), nb::arg("column"), nb::arg("row"),
             nb::sig("def explain_tof(levels: object, options: TofOptions, calibration: "
                     "tuple[object, object, object], column: int, row: int) -> dict[str, "
                     "typing.Any]"));
  module.def("frame_tof_images", frame_tof_images, nb::arg("frame"),
             nb::sig("def frame_tof_images(frame: Frame) -> numpy.ndarray | None"));
  module.def("sample_tof_images", tof_sample,
             nb::sig("def sample_tof_images() -> tuple[typing.Any, typing.Any, typing.Any]"));
}

}  // namespace glidar::python
