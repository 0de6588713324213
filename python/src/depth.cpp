// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "convert.hpp"

#include <glidar/depth_camera/depth_filters.hpp>
#include <glidar/io/config/depth_camera_files.hpp>

#include <nanobind/stl/string.h>

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

}  // namespace glidar::python
