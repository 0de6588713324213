// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause

#include <glidar/core/error.hpp>
#include <glidar/core/output_frame.hpp>
#include <glidar/explain/trace_text.hpp>
#include <glidar/io/config/camera_info.hpp>
#include <glidar/io/files/atomic_file.hpp>
#include <glidar/io/formats/cloud_layout.hpp>
#include <glidar/io/pictures/beam_picture.hpp>
#include <glidar/io/pictures/colour_scale.hpp>
#include <glidar/output/output.hpp>
#include <glidar/simulate/explain.hpp>
#include <glidar/simulate/simulator.hpp>

#include "convert.hpp"
#include "objects.hpp"
#include "report.hpp"

#include <nanobind/eigen/dense.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <numeric>
#include <span>

namespace glidar::python {
namespace {

constexpr std::size_t kMaxSpareBeams = std::size_t{1} << 24U;  // about 2 GiB with all ground truth

/// One column of a frame as an array of rows x cols, or rows x cols x components; None when the
/// frame does not have it.
template <class T, int kComponents = 1, class Values>
nb::object column(const Measured& measured, nb::handle owner, const Values& values) {
  if (values.empty() && measured.beams->size() > 0) return nb::none();
  const T* data = reinterpret_cast<const T*>(values.data());
  const std::size_t rows = measured.frame.rows;
  const std::size_t cols = measured.frame.cols;
  if constexpr (kComponents == 1) {
    return nb::cast(array_at(data, std::array<std::size_t, 2>{rows, cols}, owner));
  } else {
    return nb::cast(array_at(data, std::array<std::size_t, 3>{rows, cols, kComponents}, owner));
  }
}

nb::object measured_column(nb::handle self, const std::string& name) {
  const auto& m = nb::cast<const Measured&>(self);
  if (name == "range_m") return column<double>(m, self, m.frame.range_m);
  if (name == "intensity") return column<float>(m, self, m.frame.intensity);
  if (name == "status") return column<std::uint8_t>(m, self, m.frame.status);
  if (name == "return_source") return column<std::uint8_t>(m, self, m.frame.return_source);
  if (name == "sigma_m") return column<float>(m, self, m.frame.sigma_m);
  if (name == "radial_velocity_m_s") return column<double>(m, self, m.frame.radial_velocity_m_s);
  if (name == "tof_amplitude") return column<float>(m, self, m.frame.tof_amplitude);
  if (name == "bounced_share") return column<float>(m, self, m.frame.bounced_share);
  if (name == "disparity_px") return column<float>(m, self, m.frame.disparity_px);
  if (name == "projector_px") return column<float>(m, self, m.frame.projector_px);
  if (name == "sensor_pose")
    return column<double, 7>(m, self, m.frame.beam_poses.world_from_sensor);
  if (name == "object_pose")
    return column<double, 7>(m, self, m.frame.beam_poses.world_from_object);
  throw nb::attribute_error(name.c_str());
}

/// Name, greatest level, levels and electrons of each raw image.
nb::list raw_images(nb::handle self) {
  const auto& m = nb::cast<const Measured&>(self);
  nb::list images;
  for (const RawImage& image : m.frame.raw_images) {
    images.append(nb::make_tuple(image.name, image.grey.max_level,
                                 column<std::uint16_t>(m, self, image.grey.level),
                                 column<float>(m, self, image.electrons)));
  }
  return images;
}

nb::object true_column(nb::handle self, const std::string& name) {
  const auto& m = nb::cast<const Measured&>(self);
  const Hits& truth = m.frame.ground_truth;
  if (name == "range_m") return column<double>(m, self, truth.range_m);
  if (name == "instance") return column<std::uint32_t>(m, self, truth.instance);
  if (name == "primitive") return column<std::uint32_t>(m, self, truth.primitive);
  if (name == "depth_m") return column<double>(m, self, truth.depth_m);
  if (name == "normal") return column<float, 3>(m, self, truth.normal);
  if (name == "shading_normal") return column<float, 3>(m, self, truth.shading_normal);
  if (name == "cos_incidence") return column<float>(m, self, truth.cos_incidence);
  if (name == "cos_shading") return column<float>(m, self, truth.cos_shading);
  if (name == "barycentrics") return column<float, 2>(m, self, truth.barycentrics);
  if (name == "colour") return column<float, 3>(m, self, truth.colour);
  if (name == "diffuse") return column<float>(m, self, truth.diffuse);
  if (name == "reflectance") return column<float, 4>(m, self, truth.reflectance);
  if (name == "object_point_m") return column<double, 3>(m, self, truth.object_point_m);
  if (name == "noise_scale") return column<float>(m, self, truth.noise_scale);
  if (name == "radial_velocity_m_s")
    return column<double>(m, self, m.frame.true_radial_velocity_m_s);
  throw nb::attribute_error(name.c_str());
}

std::vector<Matrix4> object_poses(const Measured& measured) {
  std::vector<Matrix4> poses;
  for (const Pose& pose : measured.frame.world_from_instance) poses.push_back(matrix_of(pose));
  return poses;
}

/// A cloud whose memory its arrays share, and what it was made from.
struct CloudHandle {
  PointCloud cloud;
  std::shared_ptr<const Scene> scene;
  std::vector<std::string> inputs;  ///< files that no output may replace
  std::shared_ptr<SensorHandle> sensor;
  std::shared_ptr<const Beams> beams;
  Pose world_from_sensor = Pose::Identity();
  std::int64_t stamp_ns = 0;
};

PointCloud make_cloud(const Measured& m, const std::vector<std::string>& columns,
                      const std::string& frame, bool deskew) {
  OutputFrame axes = output_frame(frame, *m.beams, m.frame.world_from_sensor);
  axes.deskew = deskew;
  if (const auto& renderer = m.scene().renderer) axes.thread_pool = &renderer->thread_pool();
  PointCloud cloud;
  make_point_cloud(m.frame, *m.beams, *m.scene().scene, axes, columns, cloud);
  return cloud;
}

CloudHandle cloud_of(const Measured& measured, const std::vector<std::string>& columns,
                     const std::string& frame, bool deskew, bool drop_invalid) {
  const nb::gil_scoped_release release;
  check_columns(measured.sensor->sensor(), columns);
  CloudHandle handle{.cloud = make_cloud(measured, columns, frame, deskew),
                     .scene = measured.scene().scene,
                     .inputs = measured.scene().files,
                     .sensor = measured.sensor,
                     .beams = measured.beams,
                     .world_from_sensor = measured.frame.world_from_sensor,
                     .stamp_ns = measured.frame.stamp_ns};
  if (drop_invalid) {
    PointCloud hits;
    remove_invalid_points(handle.cloud, hits);
    handle.cloud = std::move(hits);
  }
  return handle;
}

nb::object cloud_column(nb::handle self, std::size_t index) {
  auto& cloud = nb::cast<CloudHandle&>(self).cloud;
  Column& column = cloud.columns.at(index);
  std::vector<std::size_t> shape = {cloud.rows, cloud.cols};
  if (column.components.size() > 1) shape.push_back(column.components.size());
  return std::visit([&](auto& values) { return nb::cast(array_at(values.data(), shape, self)); },
                    column.values);
}

using AnyArray = nb::ndarray<nb::ro, nb::c_contig, nb::device::cpu>;

/// Sets the values if the array is of this type.
template <class T>
bool take_values(const AnyArray& array, Column& column) {
  if (array.dtype() != nb::dtype<T>()) return false;
  const auto* data = static_cast<const T*>(array.data());
  column.values = std::vector<T>(data, data + array.size());
  return true;
}

/// A column of a cloud from Python, with the components of a frame's.
Column column_of(const std::string& name, const AnyArray& array) {
  PointCloud empty;
  make_point_cloud({}, {}, {}, {}, std::span(&name, 1), empty);  // throws for an unknown name
  Column column{name, empty.columns.front().components, {}};
  const bool is_known =
      take_values<double>(array, column) || take_values<float>(array, column) ||
      take_values<std::uint8_t>(array, column) || take_values<std::uint16_t>(array, column) ||
      take_values<std::uint32_t>(array, column) || take_values<std::int64_t>(array, column);
  if (!is_known) throw Error({"cloud", "a column " + name + " of another type", "its own type"});
  return column;
}

/// Whether a file has only what its cloud has: .las also stores scan angles and the order of time,
/// and .bin intensities from 0 to 1.
bool stores_columns_only(const FileFormat& format) {
  return format.takes_more && !format.is_survey;
}

/// Writes a cloud with the columns, which may have been changed since `from` was made; None: the
/// cloud was unpickled.
void save_cloud(const std::filesystem::path& path, const PointCloud& cloud, const CloudHandle& from,
                const OutputOptions& options, const Report& report) {
  const FileFormat& format = format_for(path);
  if (!stores_columns_only(format)) {
    std::string suffixes;
    for (const FileFormat& one : file_formats()) {
      if (stores_columns_only(one)) suffixes += (suffixes.empty() ? "" : " ") + one.suffix;
    }
    throw Error({path.string(), "not a file of a cloud alone", suffixes,
                 "write " + format.suffix + " of a frame with Frame.save"});
  }
  refuse_overwrite_of_inputs(from.inputs, path);
  check_options_used(path.string(), options);
  const Scene nothing;
  const Sensor unknown;
  const Beams none;
  Frame frame;
  frame.world_from_sensor = from.world_from_sensor;
  frame.stamp_ns = from.stamp_ns;
  make_file_sink(path, options.sink,
                 {.scene = from.scene ? *from.scene : nothing,
                  .sensor = from.sensor ? from.sensor->sensor() : unknown,
                  .beams = from.beams ? *from.beams : none,
                  .renderer = {}},
                 report)
      ->write(cloud, frame);
}

void save_columns(const std::filesystem::path& path, const nb::dict& columns, nb::handle core,
                  const OutputOptions& options, const nb::object& log) {
  const bool is_made_here = nb::isinstance<CloudHandle>(core);
  const CloudHandle unknown;
  const CloudHandle& from = is_made_here ? nb::cast<const CloudHandle&>(core) : unknown;
  PointCloud cloud{nb::cast<std::uint32_t>(core.attr("rows")),
                   nb::cast<std::uint32_t>(core.attr("cols")),
                   nb::cast<std::string>(core.attr("frame_id")),
                   Pose(nb::cast<Eigen::Matrix4d>(core.attr("world_from_cloud"))),
                   {}};
  for (const auto& [name, array] : columns)
    cloud.columns.push_back(column_of(nb::cast<std::string>(name), nb::cast<AnyArray>(array)));
  unlocked([&](Watch& watch) { save_cloud(path, cloud, from, options, report_to(log, watch)); });
}

std::vector<std::string> column_names_of(const CloudHandle& handle) {
  std::vector<std::string> names;
  for (const Column& column : handle.cloud.columns) names.push_back(column.name);
  return names;
}

/// Whether boxes of objects are to be found before the file is written.
bool needs_boxes(const Measured& m, const std::filesystem::path& path,
                 const OutputOptions& options) {
  return has_boxes(format_for(path), options.sink) && lacks_boxes(m);
}

void save_to(Measured& m, const std::filesystem::path& path, const OutputOptions& options,
             const Report& report) {
  std::vector<std::string> inputs = m.scene().files;
  const std::vector<std::string>& more = m.sensor->sensor().files;
  inputs.insert(inputs.end(), more.begin(), more.end());
  refuse_overwrite_of_inputs(inputs, path);
  check_options_used(path.string(), options);
  const FileFormat& format = format_for(path);
  std::vector<std::string> columns = format.columns;
  if (format.takes_more) {
    columns = options.columns.empty() ? default_columns() : options.columns;
    check_columns(m.sensor->sensor(), columns);
  }
  if (!options.sink.layout.empty() && format.takes_more) {
    columns = find_layout(options.sink.layout).columns;
  }
  for (const std::string& name : needed_columns(format)) {
    if (std::find(columns.begin(), columns.end(), name) == columns.end()) columns.push_back(name);
  }
  if (needs_boxes(m, path, options)) ensure_boxes(m);
  const auto sink = make_file_sink(path, options.sink,
                                   {.scene = *m.scene().scene,
                                    .sensor = m.sensor->sensor(),
                                    .beams = *m.beams,
                                    .renderer = m.scene().kind,
                                    .inputs = inputs},
                                   report);
  sink->write(
      make_cloud(m, columns, frame_for(format, options.frame), options.deskew || format.is_survey),
      m.frame);
}

void save(Measured& measured, const std::filesystem::path& path, OutputOptions options,
          const nb::object& log) {
  unlocked([&](Watch& watch) {
    options.sink.progress = watch.progress();
    save_to(measured, path, options, report_to(log, watch));
  });
}

/// Options of .bev.png and .view.png; the name is one of colour_by_names().
void set_picture(OutputOptions& self, const std::string& colour_by, std::uint32_t width,
                 std::uint32_t height) {
  const auto names = colour_by_names();
  const auto place = std::find(names.begin(), names.end(), colour_by);
  self.sink.picture.colour_by = static_cast<ColourBy>(std::distance(names.begin(), place));
  self.sink.picture.width = width;
  self.sink.picture.height = height;
}

template <auto kMember>
auto sink_member() {
  return [](OutputOptions& self, std::remove_reference_t<decltype(self.sink.*kMember)> value) {
    self.sink.*kMember = std::move(value);
  };
}

void bind_save_options(nb::module_& module) {
  nb::class_<OutputOptions>(module, "OutputOptions")
      .def(nb::init<>())
      .def_rw("columns", &OutputOptions::columns)
      .def_rw("frame", &OutputOptions::frame)
      .def_rw("deskew", &OutputOptions::deskew)
      .def_rw("per_frame", &OutputOptions::per_frame)
      .def(
          "set_pcd",
          [](OutputOptions& self, int encoding) {
            self.sink.pcd = static_cast<PcdEncoding>(encoding);
          },
          nb::arg("encoding"))
      .def("set_picture", set_picture, nb::arg("colour_by"), nb::arg("width"), nb::arg("height"))
      .def(
          "set_view_eye",
          [](OutputOptions& self, const Eigen::Vector3d& at) { self.sink.picture.eye_m = at; },
          nb::arg("eye_m"))
      .def(
          "set_view_target",
          [](OutputOptions& self, const Eigen::Vector3d& at) { self.sink.picture.target_m = at; },
          nb::arg("target_m"))
      .def("set_ply_ascii", sink_member<&FileSinkOptions::ply_ascii>(), nb::arg("value"))
      .def("set_drop_invalid", sink_member<&FileSinkOptions::drop_invalid>(), nb::arg("value"))
      .def("set_sidecar", sink_member<&FileSinkOptions::sidecar>(), nb::arg("value"))
      .def("set_crs", sink_member<&FileSinkOptions::crs>(), nb::arg("value"))
      .def(
          "set_driver",
          [](OutputOptions& self, const std::string& name) { set_driver(name, self); },
          nb::arg("name"))
      .def(
          "set_ouster_profile",
          [](OutputOptions& self, const std::string& name) { set_ouster_profile(name, self); },
          nb::arg("name"))
      .def(
          "set_livox_type", [](OutputOptions& self, int number) { set_livox_type(number, self); },
          nb::arg("number"))
      .def("set_layout", sink_member<&FileSinkOptions::layout>(), nb::arg("value"))
      .def("set_depth_units_per_m", sink_member<&FileSinkOptions::depth_png_units_per_m>(),
           nb::arg("value"));
}

std::vector<std::string> known_columns() {
  return {cloud_column_names().begin(), cloud_column_names().end()};
}

void bind_cloud(nb::module_& module) {
  nb::class_<CloudHandle>(module, "Cloud")
      .def_prop_ro("rows", [](const CloudHandle& self) { return self.cloud.rows; })
      .def_prop_ro("cols", [](const CloudHandle& self) { return self.cloud.cols; })
      .def_prop_ro("frame_id", [](const CloudHandle& self) { return self.cloud.frame_id; })
      .def_prop_ro("world_from_cloud",
                   [](const CloudHandle& self) { return matrix_of(self.cloud.world_from_cloud); })
      .def_prop_ro("columns", column_names_of)
      .def("column", cloud_column, nb::arg("index"),
           nb::sig("def column(self, index: int) -> numpy.ndarray"));
  module.def("save_cloud", save_columns, nb::arg("path"), nb::arg("columns"), nb::arg("core"),
             nb::arg("options"), nb::arg("log"),
             nb::sig("def save_cloud(path: str, columns: dict[str, numpy.ndarray], core: object, "
                     "options: OutputOptions, log: object) -> None"));
}

/// Whether the pixels of a camera have depths.
bool has_depths(const Measured& measured) {
  const Sensor& sensor = measured.sensor->sensor();
  return std::holds_alternative<Pinhole>(sensor.optics) &&
         !images_have_range(sensor, *measured.beams);
}

std::vector<std::string> known_colours() {
  return {colour_by_names().begin(), colour_by_names().end()};
}

ColourScale scale_of(const nb::ndarray<const double, nb::ndim<1>, nb::c_contig>& values,
                     bool from_zero) {
  return make_colour_scale(std::span(values.data(), values.size()),
                           from_zero ? ColourScale::Start::zero : ColourScale::Start::lowest);
}

/// The picture's beams as rows x cols, 0xFFFFFFFF for none.
nb::object shown_beams(nb::handle self) {
  auto& picture = nb::cast<BeamPicture&>(self);
  if (picture.beams.empty()) {
    picture.beams.resize(std::size_t{picture.rows} * picture.cols);
    std::iota(picture.beams.begin(), picture.beams.end(), picture.first);
  }
  return nb::cast(
      array_at(picture.beams.data(), std::array<std::size_t, 2>{picture.rows, picture.cols}, self));
}

void bind_pictures(nb::module_& module) {
  nb::class_<ColourScale>(module, "ColourScale")
      .def_ro("low", &ColourScale::low)
      .def_ro("high", &ColourScale::high)
      .def_ro("clips_low", &ColourScale::clips_low)
      .def_ro("clips_high", &ColourScale::clips_high)
      .def_ro("has_values", &ColourScale::has_values)
      .def(
          "ends",
          [](const ColourScale& self, const std::string& unit) {
            const auto [low, high] = scale_ends(self, unit);
            return std::vector<std::string>{low, high};
          },
          nb::arg("unit"));
  module.def("colour_scale", scale_of, nb::arg("values"), nb::arg("from_zero"),
             nb::sig("def colour_scale(values: numpy.ndarray, from_zero: bool) -> ColourScale"));
  module.def("colour_by_names", known_colours);
  nb::class_<BeamPicture>(module, "BeamPicture")
      .def_prop_ro("kind", [](const BeamPicture& self) { return static_cast<int>(self.kind); })
      .def_prop_ro("beams", shown_beams, nb::sig("def beams(self) -> numpy.ndarray"))
      .def_ro("left", &BeamPicture::left)
      .def_ro("right", &BeamPicture::right)
      .def_ro("top", &BeamPicture::top)
      .def_ro("bottom", &BeamPicture::bottom)
      .def_ro("row_elevations_deg", &BeamPicture::row_elevations_deg);
}

BeamPicture beam_picture(const Measured& measured, std::uint32_t number_of_return) {
  return make_beam_picture(*measured.beams, measured.frame.range_m, number_of_return);
}

}  // namespace

FramePool::FramePool() {
  constexpr std::size_t kMaxSpareFrames = 1024;
  spare_.reserve(kMaxSpareFrames);  // so that returning one cannot fail
}

Frame FramePool::take() {
  const std::lock_guard lock(mutex_);
  if (spare_.empty()) return {};
  Frame frame = std::move(spare_.back());
  spare_.pop_back();
  spare_beams_ -= frame.range_m.capacity();
  return frame;
}

void FramePool::release(Frame frame) noexcept {
  const std::size_t beams = frame.range_m.capacity();
  if (beams == 0) return;
  const std::lock_guard lock(mutex_);
  if (spare_beams_ + beams > kMaxSpareBeams || spare_.size() == spare_.capacity()) return;
  spare_beams_ += beams;
  spare_.push_back(std::move(frame));
}

const PreparedScene& Measured::scene() const {
  if (unrendered) return *unrendered;
  return rendered();
}

PreparedScene& Measured::rendered() const {
  if (prepared) return *prepared;
  throw Error({.where = "frame",
               .found = "its scene is not there yet",
               .allowed = "a frame that was given its scene"});
}

void bind_frame(nb::module_& module) {
  bind_save_options(module);
  module.def("cloud_column_names", known_columns);
  bind_cloud(module);
  bind_pictures(module);
  nb::class_<Measured>(module, "Frame")
      .def_prop_ro("rows", [](const Measured& self) { return self.frame.rows; })
      .def_prop_ro("cols", [](const Measured& self) { return self.frame.cols; })
      .def_prop_ro("stamp_ns", [](const Measured& self) { return self.frame.stamp_ns; })
      .def_prop_ro("seed", [](const Measured& self) { return self.frame.seed; })
      .def_prop_ro("number", [](const Measured& self) { return self.frame.number; })
      .def_prop_ro("sensor_id", [](const Measured& self) { return self.frame.sensor_id; })
      .def_prop_ro("frame_id", [](const Measured& self) { return self.frame.frame_id; })
      .def_prop_ro("world_from_sensor",
                   [](const Measured& self) { return matrix_of(self.frame.world_from_sensor); })
      .def_prop_ro("world_from_objects", object_poses)
      .def("measured", measured_column, nb::arg("name"),
           nb::sig("def measured(self, name: str) -> numpy.ndarray | None"))
      .def("raw_images", raw_images,
           nb::sig("def raw_images(self) -> list[tuple[str, int, numpy.ndarray, numpy.ndarray | "
                   "None]]"))
      .def("ground_truth", true_column, nb::arg("name"),
           nb::sig("def ground_truth(self, name: str) -> numpy.ndarray | None"))
      .def_prop_ro("returns", [](const Measured& self) { return self.beams->returns; })
      .def_prop_ro("has_depths", has_depths)
      .def_prop_ro("range_offset_m",
                   [](const Measured& self) { return self.beams->range_offset_m; })
      .def("picture", beam_picture, nb::arg("number_of_return"))
      .def("cloud", cloud_of, nb::arg("columns"), nb::arg("frame"), nb::arg("deskew"),
           nb::arg("drop_invalid"))
      .def("needs_boxes", needs_boxes, nb::arg("path"), nb::arg("options"),
           nb::sig("def needs_boxes(self, path: str, options: OutputOptions) -> bool"))
      .def(
          "save", save, nb::arg("path"), nb::arg("options"), nb::arg("log").none(),
          nb::sig("def save(self, path: str, options: OutputOptions, log: object | None) -> None"));
}

namespace {

std::vector<ObjectBox> find_boxes(Measured& measured, const BoxedClasses& classes) {
  PreparedScene& prepared = measured.rendered();
  Simulator simulator(*prepared.scene, measured.sensor, *prepared.renderer);
  simulator.set_boxed_classes(classes);
  return simulator.find_boxes(*measured.motion, measured.frame, BoxSelection::with_class);
}

/// The boxes of all objects, or of those of the classes; no classes: those of the scene.
std::vector<ObjectBox> boxes_of(Measured& measured, bool all,
                                const std::vector<std::string>& names) {
  return unlocked([&](Watch&) {
    if (!all && names.empty()) {
      ensure_boxes(measured);
      return measured.frame.boxes;
    }
    const Scene& scene = *measured.scene().scene;
    BoxedClasses classes(scene.class_names.size(), true);
    if (!all) classes = boxed_classes(scene.class_names, names, "classes");
    const std::lock_guard lock(measured.rendered().mutex);
    return find_boxes(measured, classes);
  });
}

/// The pose of a coordinate frame of clouds.
Matrix4 cloud_from_sensor(const Measured& measured, const std::string& frame) {
  return matrix_of(
      output_frame(frame, *measured.beams, measured.frame.world_from_sensor).cloud_from_sensor);
}

std::string class_of(const Measured& measured, const ObjectBox& box) {
  const Scene& scene = *measured.scene().scene;
  return scene.class_names.at(scene.instances.at(box.instance).class_id);
}

}  // namespace

bool lacks_boxes(const Measured& measured) {
  return !measured.has_boxes && has_classes(*measured.scene().scene);
}

void ensure_boxes(Measured& measured) {
  const std::lock_guard lock(measured.rendered().mutex);
  if (measured.has_boxes) return;
  measured.frame.boxes = find_boxes(measured, measured.rendered().boxed_classes);
  measured.has_boxes = true;
}

void bind_boxes(nb::module_& module) {
  nb::class_<ObjectBox>(module, "ObjectBox")
      .def_ro("instance", &ObjectBox::instance)
      .def_prop_ro("sensor_from_box",
                   [](const ObjectBox& self) { return matrix_of(self.sensor_from_box); })
      .def_ro("size_m", &ObjectBox::size_m)
      .def_ro("velocity_m_s", &ObjectBox::velocity_m_s)
      .def_ro("points", &ObjectBox::points)
      .def_ro("beams", &ObjectBox::beams)
      .def_ro("visible_beams", &ObjectBox::visible_beams)
      .def_prop_ro("occlusion", [](const ObjectBox& self) { return occlusion(self); });
  module.def("boxes", boxes_of, nb::arg("frame"), nb::arg("all"), nb::arg("names"));
  module.def("cloud_from_sensor", cloud_from_sensor, nb::arg("frame"), nb::arg("name"));
  module.def(
      "object_name",
      [](const Measured& measured, const ObjectBox& box) {
        return measured.scene().scene->instances.at(box.instance).name;
      },
      nb::arg("frame"), nb::arg("box"));
  module.def(
      "object_id",
      [](const Measured& measured, const ObjectBox& box) {
        return measured.scene().scene->instances.at(box.instance).id;
      },
      nb::arg("frame"), nb::arg("box"));
  module.def("object_class", class_of, nb::arg("frame"), nb::arg("box"));
}

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
