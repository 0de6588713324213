// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/file_sink.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/cloud_file.hpp>
#include <glidar/io/cloud_layout.hpp>
#include <glidar/io/kitti_files.hpp>
#include <glidar/io/staged_files.hpp>
#include <glidar/io/stored_columns.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <iterator>
#include <system_error>
#include <utility>

namespace glidar {
namespace {

/// Which misses go into the file, and whether a sidecar belongs to it.
enum class Content : std::uint8_t {
  points,    ///< a cloud: organised or dense, as the options say
  kitti,     ///< a cloud: always dense, with KITTI's intensity
  image,     ///< always the whole frame, with a sidecar
  per_beam,  ///< a picture for people or a pose: always the whole frame, no sidecar
};

struct Format {
  FileFormat told;
  Content content;
  std::vector<Field> (*fields)(const PointCloud&);  ///< what it stores of each point
  void (*write)(const CloudFile&, AtomicFile&);     ///< nullptr: `beside` writes it all
  /// Adds further files; nullptr: there are none.
  void (*beside)(const CloudFile&, const std::filesystem::path&, StagedFiles&) = nullptr;
  const char* pixels = "";  ///< what those of an image are, for its sidecar
};

/// Of formats that are no table of points.
std::vector<Field> no_fields(const PointCloud& /*cloud*/) {
  return {};
}

/// Images besides those of formats().
std::vector<Format> image_formats() {
  return {
      {{".depth.tiff", "32-bit depth image, metres", {"depth"}, false},
       Content::image,
       depth_fields,
       write_depth_tiff,
       nullptr,
       "depth in metres as 32-bit float; NaN: no return"},
      {{".rgb.png", "surface colour, lit at the sensor", {"colour", "incidence"}, false},
       Content::image,
       no_fields,
       write_rgb_png,
       nullptr,
       "surface colour times cosine of incidence times 255 as 8-bit RGB; black: nothing there"},
      {{".normal.png", "16-bit normals", {"normal"}, false},
       Content::image,
       no_fields,
       write_normal_png,
       nullptr,
       "unit normal n in frame_id as 16-bit RGB v: n = 2 v / 65535 - 1; 0 0 0: nothing there"},
      {{".instance.png", "16-bit instance ids", {"instance"}, false},
       Content::image,
       no_fields,
       write_instance_png,
       nullptr,
       "id of the instance as 16-bit grey; 0: nothing there"},
      {{".class.png", "class ids", {"class"}, false},
       Content::image,
       no_fields,
       write_class_png,
       nullptr,
       "id of the class as grey; 0: unlabelled, or nothing there"},
  };
}

std::vector<Format> with_images(std::vector<Format> formats) {
  for (const Format& format : image_formats()) formats.push_back(format);
  return formats;
}

const std::vector<Format>& formats() {
  static const std::vector<Format> kFormats = with_images({
      {{".pcd", "Point Cloud Library", {"xyz"}, true}, Content::points, pcd_fields, write_pcd},
      {{".ply", "Stanford polygon file", {"xyz"}, true}, Content::points, ply_fields, write_ply},
      {{".npz", "NumPy archive of all columns", {"xyz"}, true},
       Content::points,
       native_fields,
       write_npz},
      {{".csv", "text table", {"xyz"}, true}, Content::points, native_fields, write_csv},
      {{".bin", "KITTI Velodyne, with .label", {"xyz", "intensity"}, false},
       Content::kitti,
       kitti_fields,
       write_kitti,
       stage_labels_beside},
      {{".kitti", "folder: velodyne calib label_2 labels", {"xyz", "intensity"}, false, true},
       Content::kitti,
       kitti_fields,
       nullptr,
       stage_kitti_folder},
      {{".npy", "NumPy depth image, metres", {"depth"}, false},
       Content::image,
       depth_fields,
       write_depth_npy,
       nullptr,
       "depth in metres as 32-bit float; NaN: no return"},
      {{".depth.png", "16-bit depth image", {"depth"}, false},
       Content::image,
       no_fields,
       write_depth_png,
       nullptr,
       "depth times units_per_m as 16-bit grey; 0: no return"},
      {{".paper.png", "RGBA picture of --render-target paper", {}, false},
       Content::per_beam,
       no_fields,
       write_paper_png},
      {{".png", "preview picture", {"depth", "intensity"}, false},
       Content::per_beam,
       no_fields,
       write_preview},
      {{".transform", "4x4 pose of the first object", {}, false},
       Content::per_beam,
       no_fields,
       write_transform},
  });
  return kFormats;
}

std::vector<std::string> suffixes() {
  std::vector<std::string> all;
  for (const Format& format : formats()) all.push_back(format.told.suffix);
  return all;
}

std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

const Format& find_format(const std::filesystem::path& path) {
  const std::string name = lower_case(path.filename().string());
  const Format* best = nullptr;
  for (const Format& format : formats()) {
    const std::string& suffix = format.told.suffix;
    if (name.size() <= suffix.size() || !name.ends_with(suffix)) continue;
    if (best == nullptr || suffix.size() > best->told.suffix.size()) best = &format;
  }
  if (best != nullptr) return *best;
  const std::string suffix = lower_case(path.extension().string());
  const std::vector<std::string> all = suffixes();
  const std::string nearest = suffix.empty() ? "" : nearest_word(suffix, all);
  throw Error({path.string(),
               suffix.empty() ? "the name has no suffix that tells the format"
                              : fmt::format("no format has the suffix {}", suffix),
               fmt::format("{}", fmt::join(all, " ")),
               nearest.empty() ? "" : fmt::format("did you mean {}?", nearest)});
}

void check_folder(const std::filesystem::path& path, const Format& format) {
  const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
  std::error_code ignored;  // a folder that cannot be looked at is none for us
  if (!std::filesystem::is_directory(folder, ignored)) {
    throw Error({path.string(), fmt::format("there is no folder {}", folder.string()), "",
                 "make it first, or correct the path"});
  }
  if (::access(folder.c_str(), W_OK | X_OK) != 0) {
    throw Error({path.string(), fmt::format("the folder {} cannot be written to", folder.string()),
                 "", "write to another folder"});
  }
  const bool wants_folder = format.told.is_folder;
  if (std::filesystem::exists(path, ignored) &&
      std::filesystem::is_directory(path, ignored) != wants_folder) {
    throw Error({path.string(), wants_folder ? "is no folder" : "is a folder",
                 wants_folder ? "a folder, or none yet" : "a file name", "choose another name"});
  }
  if (wants_folder) return;
  // a pipe or device would be replaced, not written to
  if (std::filesystem::exists(path, ignored) && !std::filesystem::is_regular_file(path, ignored))
    throw Error({path.string(), "is a pipe, a device or a socket", "a file name",
                 "choose another name, or -o - for standard output"});
}

void check_column_sizes(const PointCloud& cloud, const std::filesystem::path& path) {
  for (const Column& column : cloud.columns) {
    const std::size_t wanted = cloud.size() * column.components.size();
    const std::size_t found =
        std::visit([](const auto& values) { return values.size(); }, column.values);
    if (found != wanted) {
      throw Error({path.string(), fmt::format("column {} has {} numbers", column.name, found),
                   fmt::format("{}", wanted), "fill every column for all rows x cols points"});
    }
  }
}

/// Columns that writers read as what make_point_cloud makes of them.
void check_column_types(const PointCloud& cloud, const std::filesystem::path& path) {
  const auto check = [&](std::string_view name, std::size_t components, Stored type,
                         const char* told) {
    const Column* column = find_column(cloud, name);
    if (column == nullptr) return;
    if (column->components.size() == components && native_type(*column) == type) return;
    throw Error({path.string(), fmt::format("column {} is of another type", name), told,
                 "make the cloud with make_point_cloud"});
  };
  check("xyz", 3, Stored::f64, "three doubles a point");
  check("depth", 1, Stored::f64, "a double a point");
  check("intensity", 1, Stored::f32, "a float a point");
}

void check_needed_columns(const FileFormat& format, const PointCloud& cloud,
                          const std::filesystem::path& path) {
  std::vector<std::string> there;
  for (const Column& column : cloud.columns) there.push_back(column.name);
  for (const std::string& needed : format.columns) {
    if (find_column(cloud, needed) != nullptr) continue;
    throw Error({path.string(), fmt::format("the cloud has no column {}", needed),
                 fmt::format("{} needs {}", format.suffix, fmt::join(format.columns, " ")),
                 fmt::format("it has: {}; ask for {} too", fmt::join(there, " "), needed)});
  }
}

/// Where a sink's bytes go.
struct Target {
  std::filesystem::path path;
  int descriptor = -1;  ///< an open file to send them to; -1: they become the file `path`
};

class FormatSink : public FileSink {
 public:
  FormatSink(Target target, const Format& format, const FileSinkOptions& options,
             SidecarContext context, Report report)
      : target_(std::move(target)),
        format_(format),
        options_(options),
        context_(std::move(context)),
        report_(std::move(report)) {}

  void stage(const PointCloud& cloud, const Frame& frame) override {
    staged_.clear();
    check_column_sizes(cloud, target_.path);
    check_column_types(cloud, target_.path);
    check_needed_columns(format_.told, cloud, target_.path);
    try {
      stage_points(cloud, frame);
    } catch (...) {
      staged_.clear();
      throw;
    }
  }

  void commit() override { staged_.commit(); }

 private:
  void stage_points(const PointCloud& cloud, const Frame& frame) {
    const bool dense =
        format_.content == Content::kitti || (format_.content == Content::points && options_.dense);
    if (dense) compact(cloud, hits_);
    const PointCloud& points = dense ? hits_ : cloud;
    if (format_.content == Content::kitti) {
      deliver(kitti_cloud(points, context_.sensor, context_.beams), frame);
    } else {
      deliver(points, frame);
    }
  }

  void deliver(const PointCloud& cloud, const Frame& frame) {
    if (options_.layout.empty() || !format_.told.takes_more) {
      const std::vector<Field> fields = format_.fields(cloud);
      store({cloud, frame, options_, context_, fields, {}, format_.pixels});
      tell(rounding_told(fields, "write .npz, .csv or .ply, which keep far points"));
      return;
    }
    const PointCloud laid = laid_out(cloud, options_.layout, context_.sensor, context_.beams);
    const std::vector<Field> fields = native_fields(laid);
    store({laid, frame, options_, context_, fields, options_.layout, {}});
    const std::array points = {Field{"x", find_column(cloud, "xyz"), 0, Stored::f32}};
    tell(rounding_told(points, "without a layout .npz, .csv and .ply keep far points"));
  }

  /// All files are complete before the first gets its name; that of the cloud is named last, so
  /// that whoever waits for it finds the others too.
  void store(const CloudFile& job) {
    const std::filesystem::path& path = target_.path;
    const bool is_stream = target_.descriptor >= 0;
    if (format_.write != nullptr) {
      AtomicFile& file = is_stream ? staged_.add(target_.descriptor, path) : staged_.add(path);
      format_.write(job, file);
      file.finish();
    }
    if (is_stream) return;
    if (format_.beside != nullptr) format_.beside(job, path, staged_);
    const bool is_described = format_.content != Content::per_beam && !format_.told.is_folder;
    if (!options_.sidecar || !is_described) return;
    AtomicFile& sidecar = staged_.add(path.string() + ".json");
    sidecar.write(sidecar_text(job, path));
    sidecar.finish();
  }

  void tell(const std::string& warning) const {
    if (!warning.empty()) report_.warn(target_.path.string() + ": " + warning);
  }

  Target target_;
  const Format& format_;
  FileSinkOptions options_;
  SidecarContext context_;
  Report report_;
  PointCloud hits_;  ///< of the last cloud, for its memory
  StagedFiles staged_;
};

void check(const FileSinkOptions& options) {
  if (!options.layout.empty()) layout_named(options.layout);
  if (options.depth_png_units_per_m > 0.0 && !std::isinf(options.depth_png_units_per_m)) return;
  throw Error({"depth_png_units_per_m", fmt::format("{}", options.depth_png_units_per_m),
               "a finite number above 0", "1000 for millimetres"});
}

bool looks_back(const Beams& beams) {
  return std::any_of(beams.directions.begin(), beams.directions.end(),
                     [&](const auto& direction) { return direction.dot(beams.boresight) < 0.0; });
}

}  // namespace

std::span<const FileFormat> file_formats() {
  static const std::vector<FileFormat> kTold = [] {
    std::vector<FileFormat> told;
    for (const Format& format : formats()) told.push_back(format.told);
    return told;
  }();
  return kTold;
}

const FileFormat& format_for(const std::filesystem::path& path) {
  return find_format(path).told;
}

bool is_text(const FileFormat& format, const FileSinkOptions& options) {
  if (format.suffix == ".pcd") return options.pcd == PcdEncoding::ascii;
  if (format.suffix == ".ply") return options.ply_ascii;
  return format.suffix == ".csv" || format.suffix == ".transform";
}

std::string misfit(const FileFormat& format, const Sensor& sensor, const Beams& beams) {
  if (format.suffix != ".depth.png" || std::holds_alternative<Pinhole>(sensor.optics)) return "";
  return looks_back(beams) ? "it has beams that point back, where depths are negative" : "";
}

void FileSink::write(const PointCloud& cloud, const Frame& frame) {
  stage(cloud, frame);
  commit();
}

std::unique_ptr<FileSink> make_file_sink(const std::filesystem::path& path,
                                         const FileSinkOptions& options,
                                         const SidecarContext& context, Report report) {
  const Format& format = find_format(path);
  check_folder(path, format);
  check(options);
  return std::make_unique<FormatSink>(Target{path}, format, options, context, std::move(report));
}

std::unique_ptr<FileSink> make_stream_sink(int descriptor, const std::filesystem::path& name,
                                           const FileSinkOptions& options,
                                           const SidecarContext& context, Report report) {
  const Format& format = find_format(name);
  check(options);
  if (format.told.is_folder) {
    throw Error({name.string(), "is a folder of several files", "a format of one file",
                 "write it to a folder of its own"});
  }
  return std::make_unique<FormatSink>(Target{name, descriptor}, format, options, context,
                                      std::move(report));
}

}  // namespace glidar
