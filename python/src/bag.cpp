// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "bag.hpp"

#include "report.hpp"

#include <glidar/core/error.hpp>
#include <glidar/io/files/atomic_file.hpp>

#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <utility>

namespace glidar::python {
namespace {

void refuse_inputs(const Measured& m, const std::filesystem::path& path) {
  refuse_overwrite_of_inputs(m.scene().files, path);
  refuse_overwrite_of_inputs(m.sensor->sensor().files, path);
}

void add_frame(BagWriter& bag, Measured& frame) {
  unlocked([&](Watch& /*watch*/) { bag.add(frame); });
}

void finish_bag(BagWriter& bag) {
  unlocked([&](Watch& /*watch*/) { bag.finish(); });
}

}  // namespace

BagWriter::BagWriter(std::filesystem::path path, FrameBagOptions options)
    : path_(std::move(path)), options_(std::move(options)) {}

void BagWriter::add(Measured& measured) {
  check_columns(measured.sensor->sensor(), options_.columns);
  if (lacks_boxes(measured)) ensure_boxes(measured);
  if (!bag_) {
    refuse_inputs(measured, path_);
    sensor_ = measured.sensor;
    beams_ = measured.beams;
    (void)measured.scene();  // restores it when the frame was unpickled
    prepared_ = measured.prepared;
    unrendered_ = measured.unrendered;
    bag_ = std::make_unique<FrameBag>(path_, *measured.scene().scene, sensor_->sensor(), *beams_,
                                      options_);
  }
  if (measured.beams->rows != beams_->rows ||
      measured.sensor->sensor().name != sensor_->sensor().name) {
    throw Error({"bag " + path_.string(), "a frame of another sensor", "frames of one sensor",
                 "write a bag for each sensor"});
  }
  bag_->write(measured.frame, *measured.beams);
}

void BagWriter::finish() {
  if (!bag_) throw Error({"bag " + path_.string(), "there is no frame", "one frame or more"});
  bag_->finish();
  bag_.reset();
}

void bind_bag(nb::module_& module) {
  module.def(
      "is_bag_name", [](const std::string& path) { return is_frame_bag_name(path); },
      nb::arg("path"));
  module.def("lacks_boxes", lacks_boxes, nb::arg("frame"));
  nb::class_<BagWriter>(module, "BagWriter")
      .def(
          "__init__",
          [](BagWriter* self, const std::string& path, const std::string& layout,
             const std::vector<std::string>& columns, bool deskew) {
            new (self) BagWriter(path, {layout, columns, deskew});
          },
          nb::arg("path"), nb::arg("layout"), nb::arg("columns"), nb::arg("deskew"))
      .def("add", add_frame, nb::arg("frame"))
      .def("finish", finish_bag);
}

}  // namespace glidar::python
