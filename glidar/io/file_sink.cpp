// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/file_sink.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/cloud_file.hpp>
#include <glidar/io/cloud_layout.hpp>
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
  points,     ///< a cloud: organised or dense, as the options say
  hits_only,  ///< a cloud: always dense
  per_beam,   ///< an image or a pose: always the whole frame, no sidecar
};

struct Format {
  FileFormat told;
  Content content;
  std::vector<Field> (*fields)(const PointCloud&);  ///< what it stores of each point
  void (*write)(const CloudFile&, AtomicFile&);
};

/// Of formats that are no table of points.
std::vector<Field> no_fields(const PointCloud& /*cloud*/) {
  return {};
}

const std::vector<Format>& formats() {
  static const std::vector<Format> kFormats = {
      {{".pcd", "Point Cloud Library", {"xyz"}, true}, Content::points, pcd_fields, write_pcd},
      {{".ply", "Stanford polygon file", {"xyz"}, true}, Content::points, ply_fields, write_ply},
      {{".npz", "NumPy archive of all columns", {"xyz"}, true},
       Content::points,
       native_fields,
       write_npz},
      {{".csv", "text table", {"xyz"}, true}, Content::points, native_fields, write_csv},
      {{".bin", "KITTI Velodyne", {"xyz", "intensity"}, false},
       Content::hits_only,
       kitti_fields,
       write_kitti},
      {{".npy", "NumPy depth image, metres", {"depth"}, false},
       Content::per_beam,
       depth_fields,
       write_depth_npy},
      {{".depth.png", "16-bit depth image", {"depth"}, false},
       Content::per_beam,
       no_fields,
       write_depth_png},
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
      {{".bev.png", "picture of the cloud from above", cloud_picture_columns(), false},
       Content::per_beam,
       no_fields,
       write_bird_eye},
      {{".view.png", "picture of the cloud in perspective", cloud_picture_columns(), false},
       Content::per_beam,
       no_fields,
       write_perspective},
  };
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

void check_folder(const std::filesystem::path& path) {
  const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
  std::error_code ignored;  // a folder that cannot be looked at is none for us
  if (!std::filesystem::is_directory(folder, ignored)) {
    throw Error({path.string(), fmt::format("there is no folder {}", folder.string()), "",
                 "make it first"});
  }
  if (::access(folder.c_str(), W_OK | X_OK) != 0) {
    throw Error({path.string(), fmt::format("the folder {} cannot be written to", folder.string()),
                 "", "write to another folder"});
  }
  if (std::filesystem::is_directory(path, ignored))
    throw Error({path.string(), "is a folder", "a file name", ""});
  // a pipe or device would be replaced, not written to
  if (std::filesystem::exists(path, ignored) && !std::filesystem::is_regular_file(path, ignored))
    throw Error({path.string(), "is a pipe, a device or a socket", "a file name", ""});
}

void check_column_sizes(const PointCloud& cloud, const std::filesystem::path& path) {
  for (const Column& column : cloud.columns) {
    const std::size_t wanted = cloud.size() * column.components.size();
    const std::size_t found =
        std::visit([](const auto& values) { return values.size(); }, column.values);
    if (found != wanted) {
      throw Error({path.string(), fmt::format("column {} has {} numbers", column.name, found),
                   fmt::format("{}", wanted), ""});
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
    throw Error({path.string(), fmt::format("column {} is of another type", name), told, ""});
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

void check_picture_size(const CloudPictureOptions& options) {
  for (const std::uint32_t side : {options.width, options.height}) {
    if (side >= kMinPictureSide && side <= kMaxPictureSide) continue;
    throw Error({"picture size", fmt::format("{} x {} pixels", options.width, options.height),
                 fmt::format("sides from {} to {}", kMinPictureSide, kMaxPictureSide), ""});
  }
}

class FileSink : public CloudSink {
 public:
  FileSink(std::filesystem::path path, const Format& format, const FileSinkOptions& options,
           SidecarContext context, Report report)
      : path_(std::move(path)),
        format_(format),
        options_(options),
        context_(std::move(context)),
        report_(std::move(report)) {}

  void write(const PointCloud& cloud, const Frame& frame) override {
    check_column_sizes(cloud, path_);
    check_column_types(cloud, path_);
    check_needed_columns(format_.told, cloud, path_);
    const bool dense = format_.content == Content::hits_only ||
                       (format_.content == Content::points && options_.dense);
    if (dense) {
      compact(cloud, hits_);
      deliver(hits_, frame);
    } else {
      deliver(cloud, frame);
    }
  }

 private:
  void deliver(const PointCloud& cloud, const Frame& frame) const {
    if (options_.layout.empty() || !format_.told.takes_more) {
      const std::vector<Field> fields = format_.fields(cloud);
      store({cloud, frame, options_, context_, fields});
      tell(rounding_told(fields, "write .npz, .csv or .ply, which keep far points"));
      return;
    }
    const PointCloud laid = laid_out(cloud, options_.layout, context_.sensor, context_.beams);
    const std::vector<Field> fields = native_fields(laid);
    store({laid, frame, options_, context_, fields, options_.layout});
    const std::array points = {Field{"x", find_column(cloud, "xyz"), 0, Stored::f32}};
    tell(rounding_told(points, "without a layout .npz, .csv and .ply keep far points"));
  }

  /// Both files are complete before either gets its name; the sidecar first, so that whoever
  /// waits for the cloud finds it.
  void store(const CloudFile& job) const {
    AtomicFile file(path_);
    format_.write(job, file);
    file.finish();
    if (options_.sidecar && format_.content != Content::per_beam) {
      AtomicFile sidecar(path_.string() + ".json");
      sidecar.write(sidecar_text(job, path_));
      sidecar.commit();
    }
    file.commit();
  }

  void tell(const std::string& warning) const {
    if (!warning.empty()) report_.warn(path_.string() + ": " + warning);
  }

  std::filesystem::path path_;
  const Format& format_;
  FileSinkOptions options_;
  SidecarContext context_;
  Report report_;
  PointCloud hits_;  ///< of the last cloud, for its memory
};

}  // namespace

std::span<const std::string> colour_by_names() {
  static const std::vector<std::string> kNames = {"height", "range", "intensity",
                                                  "ring",   "class", "instance"};
  return kNames;
}

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

std::unique_ptr<CloudSink> make_file_sink(const std::filesystem::path& path,
                                          const FileSinkOptions& options,
                                          const SidecarContext& context, Report report) {
  const Format& format = find_format(path);
  check_folder(path);
  if (!options.layout.empty()) layout_named(options.layout);
  if (!(options.depth_png_units_per_m > 0.0) || std::isinf(options.depth_png_units_per_m)) {
    throw Error({"depth_png_units_per_m", fmt::format("{}", options.depth_png_units_per_m),
                 "a number above 0", "1000 for millimetres"});
  }
  check_picture_size(options.picture);
  return std::make_unique<FileSink>(path, format, options, context, std::move(report));
}

}  // namespace glidar
