// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/file_sink.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/file_text.hpp>
#include <glidar/io/config/camera_info.hpp>
#include <glidar/io/formats/cloud_file.hpp>
#include <glidar/io/formats/cloud_layout.hpp>
#include <glidar/io/formats/format.hpp>
#include <glidar/io/formats/kitti_file.hpp>
#include <glidar/io/formats/las_crs.hpp>
#include <glidar/io/formats/sidecar_file.hpp>
#include <glidar/io/formats/stored_columns.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <optional>
#include <string_view>
#include <system_error>
#include <type_traits>
#include <utility>

namespace glidar {
namespace {

void check_writable(const std::filesystem::path& path, const std::filesystem::path& folder) {
  if (::faccessat(AT_FDCWD, folder.c_str(), W_OK | X_OK, AT_EACCESS) == 0) return;
  throw Error({path.string(), fmt::format("the folder {} cannot be written to", folder.string()),
               "", "write to another folder"});
}

void check_folder(const std::filesystem::path& path, const Format& format) {
  const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
  std::error_code ignored;  // an inaccessible folder is treated as missing
  if (!path.has_filename()) {
    throw Error(
        {path.string(), "is the name of a folder", "a file name", "remove the trailing separator"});
  }
  if (!std::filesystem::is_directory(folder, ignored)) {
    throw Error({path.string(), fmt::format("there is no folder {}", folder.string()), "",
                 "create it first, or correct the path"});
  }
  const bool wants_folder = format.info.is_folder;
  const bool is_folder = std::filesystem::is_directory(path, ignored);
  check_writable(path, wants_folder && is_folder ? path : folder);
  if (std::filesystem::exists(path, ignored) && is_folder != wants_folder) {
    throw Error({path.string(), wants_folder ? "is not a folder" : "is a folder",
                 wants_folder ? "a folder, or a new name" : "a file name", "choose another name"});
  }
  if (wants_folder) return;
  // a pipe or device would be replaced, not written to
  if (std::filesystem::exists(path, ignored) && !std::filesystem::is_regular_file(path, ignored))
    throw Error({path.string(), "is a pipe, a device or a socket", "a file name",
                 "choose another name, or -o - for standard output"});
}

void check_available(const std::filesystem::path& path, const FileFormat& format) {
  if (format.missing.empty()) return;
  throw Error({path.string(), fmt::format("this build does not write {} files", format.suffix), "",
               fmt::format("install {} and build again", format.missing)});
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

/// Names become members of archives, lines of headers and cells of tables.
void check_column_names(const PointCloud& cloud, const std::filesystem::path& path) {
  const auto check = [&](const std::string& name) {
    if (is_column_name(name)) return;
    throw Error({path.string(), fmt::format("a column '{}'", excerpt(name)),
                 fmt::format("names of 1 to {} letters, digits and _", kMaxColumnName_bytes),
                 "rename the column"});
  };
  for (const Column& column : cloud.columns) {
    check(column.name);
    for (const std::string& component : column.components) check(component);
  }
}

/// Readers find fields by their names.
void check_unique(std::span<const PointField> fields, const std::filesystem::path& path) {
  std::vector<std::string_view> names;
  for (const PointField& field : fields) names.push_back(field.name);
  std::ranges::sort(names);
  const auto same = std::ranges::adjacent_find(names);
  if (same == names.end()) return;
  throw Error({path.string(), fmt::format("two fields '{}'", *same), "each name once",
               "leave out or rename one of the columns"});
}

/// Columns that writers read with the types of make_point_cloud.
void check_column_types(const PointCloud& cloud, const std::filesystem::path& path) {
  const auto check = [&](std::string_view name, std::size_t components, Stored type,
                         const char* expected) {
    const Column* column = find_column(cloud, name);
    if (column == nullptr) return;
    if (column->components.size() == components && native_type(*column) == type) return;
    throw Error({path.string(), fmt::format("column {} has another type", name), expected,
                 "create the cloud with make_point_cloud"});
  };
  check("xyz", 3, Stored::f64, "three doubles per point");
  check("depth", 1, Stored::f64, "a double per point");
  check("intensity", 1, Stored::f32, "a float per point");
}

void check_needed_columns(const FileFormat& format, const PointCloud& cloud,
                          const std::filesystem::path& path) {
  std::vector<std::string> there;
  for (const Column& column : cloud.columns) there.push_back(column.name);
  for (const std::string& needed : format.columns) {
    if (find_column(cloud, needed) != nullptr) continue;
    throw Error({path.string(), fmt::format("the cloud has no column {}", needed),
                 fmt::format("{} needs {}", format.suffix, fmt::join(format.columns, " ")),
                 fmt::format("it has: {}; request {} too", fmt::join(there, " "), needed)});
  }
}

void check_picture_size(const CloudPictureOptions& options) {
  for (const std::uint32_t side : {options.width, options.height}) {
    if (side >= kMinPictureSide && side <= kMaxPictureSide) continue;
    throw Error({"picture size", fmt::format("{} x {} pixels", options.width, options.height),
                 fmt::format("sides from {} to {}", kMinPictureSide, kMaxPictureSide)});
  }
}

/// The target of a sink.
struct Target {
  std::filesystem::path path;
  int descriptor = -1;  ///< an open file; -1: the file `path`
};

class FormatSink : public FileSink {
 public:
  FormatSink(Target target, const Format& format, const FileSinkOptions& options,
             SidecarContext context, Report report)
      : target_(std::move(target)),
        format_(format),
        options_(options),
        context_(std::move(context)),
        report_(std::move(report)) {
    staged_.protect(context_.inputs);
  }

  [[nodiscard]] std::vector<std::filesystem::path> files() const override {
    std::vector<std::filesystem::path> all = {target_.path};
    if (target_.descriptor >= 0) return all;
    if (has_sidecar()) all.push_back(sidecar_path(target_.path));
    if (format_.extra_path != nullptr) all.push_back(format_.extra_path(target_.path));
    return all;
  }

  void stage(const PointCloud& cloud, const Frame& frame) override {
    staged_.clear();
    entry_.reset();
    check_column_names(cloud, target_.path);
    check_column_sizes(cloud, target_.path);
    check_column_types(cloud, target_.path);
    check_needed_columns(format_.info, cloud, target_.path);
    try {
      if (const auto ranges = range_image(cloud, frame)) {
        stage_points(*ranges, frame);
      } else {
        stage_points(cloud, frame);
      }
    } catch (...) {
      staged_.clear();
      throw;
    }
  }

  [[nodiscard]] const std::optional<SidecarEntry>& sidecar_entry() const override { return entry_; }

  void stage_text(const std::filesystem::path& path, const std::string& text) override {
    AtomicFile& file = staged_.add(path);
    file.write(text);
    file.finish();
  }

  void commit() override { staged_.commit(); }

  void write(const PointCloud& cloud, const Frame& frame) override {
    stage(cloud, frame);
    if (entry_) {
      const std::filesystem::path path = sidecar_path(target_.path);
      stage_text(path, sidecar_text(context_, frame, std::span(&*entry_, 1), path));
    }
    commit();
  }

 private:
  [[nodiscard]] bool has_sidecar() const {
    return options_.sidecar && glidar::has_sidecar(format_) && target_.descriptor < 0;
  }

  [[nodiscard]] std::vector<PointField> fields_of(const PointCloud& cloud) const {
    return format_.fields != nullptr ? format_.fields(cloud) : std::vector<PointField>();
  }

  /// The cloud of an image with ranges in place of depths; empty: its depths are right.
  [[nodiscard]] std::optional<PointCloud> range_image(const PointCloud& cloud,
                                                      const Frame& frame) const {
    const bool has_depths =
        format_.content == Content::image && find_column(cloud, "depth") != nullptr;
    const bool is_array = format_.info.suffix == ".npy";
    const bool has_ranges = images_have_range(context_.sensor, context_.beams) ||
                            (is_array && !std::holds_alternative<Pinhole>(context_.sensor.optics));
    if (!has_depths || !has_ranges) return std::nullopt;
    PointCloud made = cloud;
    const auto is_named = [](const char* name) {
      return [name](const Column& column) { return column.name == name; };
    };
    if (std::ranges::any_of(made.columns, is_named("range"))) {
      std::erase_if(made.columns, is_named("depth"));
      return made;
    }
    if (frame.range_m.size() != cloud.size()) {
      throw Error({target_.path.string(), "the cloud has no column range",
                   "ranges, because this sensor has no depths", "request range too"});
    }
    std::vector<double> ranges_m = frame.range_m;
    for (double& range_m : ranges_m) range_m += context_.beams.range_offset_m;
    *std::ranges::find_if(made.columns, is_named("depth")) = {
        "range", {"range"}, std::move(ranges_m)};
    return made;
  }

  /// The meaning of an image's pixels: "depth ..." unless they are ranges.
  [[nodiscard]] std::string pixels_of(const PointCloud& cloud) const {
    std::string text = format_.pixels;
    if (text.starts_with("depth") && find_column(cloud, "depth") == nullptr)
      text.replace(0, 5, "range along the beam");
    return text;
  }

  void stage_points(const PointCloud& cloud, const Frame& frame) {
    const bool drops_invalid = format_.content == Content::kitti ||
                               format_.content == Content::hits ||
                               (format_.content == Content::points && options_.drop_invalid);
    if (drops_invalid) remove_invalid_points(cloud, hits_);
    const PointCloud& points = drops_invalid ? hits_ : cloud;
    if (format_.content == Content::kitti) {
      deliver(kitti_cloud(points, context_.sensor, context_.beams), frame);
    } else {
      deliver(points, frame);
    }
  }

  void deliver(const PointCloud& cloud, const Frame& frame) {
    // formats of hits have point records of their own
    if (options_.layout.empty() || !format_.info.takes_more || format_.content != Content::points) {
      const std::vector<PointField> fields = fields_of(cloud);
      store({cloud, frame, options_, context_, fields, {}, pixels_of(cloud)});
      warn_rounding(
          format_.rounding_warning != nullptr
              ? format_.rounding_warning(cloud)
              : rounding_warning(fields,
                                 "write .npz, .csv or .ply, which store distant points exactly"));
      return;
    }
    const PointCloud laid = apply_layout(cloud, options_.layout, context_.sensor, context_.beams);
    const std::vector<PointField> fields = native_fields(laid);
    store({laid, frame, options_, context_, fields, options_.layout, {}});
    const std::array points = {PointField{"x", find_column(cloud, "xyz"), 0, Stored::f32}};
    warn_rounding(rounding_warning(
        points, "without a layout .npz, .csv and .ply store distant points exactly"));
  }

  /// All files are complete before the first is renamed. The cloud's file is renamed last, so
  /// that the others exist when it appears.
  void store(const CloudFile& job) {
    const std::filesystem::path& path = target_.path;
    check_unique(job.fields, path);
    const bool is_stream = target_.descriptor >= 0;
    if (format_.write != nullptr) {
      AtomicFile& file = is_stream ? staged_.add(target_.descriptor, path) : staged_.add(path);
      format_.write(job, file);
      file.finish();
    }
    if (is_stream) return;
    if (format_.stage_extra_files != nullptr) format_.stage_extra_files(job, path, staged_);
    if (has_sidecar()) entry_ = glidar::sidecar_entry(job, path);
  }

  void warn_rounding(const std::string& warning) const {
    if (!warning.empty()) report_.warn(target_.path.string() + ": " + warning);
  }

  Target target_;
  const Format& format_;
  FileSinkOptions options_;
  SidecarContext context_;
  Report report_;
  PointCloud hits_;  ///< of the last cloud; reuses its memory
  StagedFiles staged_;
  std::optional<SidecarEntry> entry_;
};

/// The points in the order of time; misses stay if the format has them.
PointCloud in_time_order(const PointCloud& cloud) {
  const auto& stamps = std::get<std::vector<std::int64_t>>(find_column(cloud, "stamp")->values);
  std::vector<std::uint32_t> order(cloud.size());
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::stable_sort(order, {}, [&](std::uint32_t i) { return stamps[i]; });
  PointCloud sorted{
      1, static_cast<std::uint32_t>(cloud.size()), cloud.frame_id, cloud.world_from_cloud, {}};
  sorted.columns.resize(cloud.columns.size());
  for (std::size_t i = 0; i < cloud.columns.size(); ++i)
    select_points(cloud.columns[i], order, sorted.columns[i]);
  return sorted;
}

void check(const FileSinkOptions& options) {
  if (!options.layout.empty()) find_layout(options.layout);
  if (!options.crs.empty()) crs_text(options.crs);
  check_picture_size(options.picture);
  if (options.depth_png_units_per_m > 0.0 && !std::isinf(options.depth_png_units_per_m)) return;
  throw Error({"depth_png_units_per_m", fmt::format("{}", options.depth_png_units_per_m),
               "a finite number above 0", "1000 for millimetres"});
}

}  // namespace

std::string frame_for(const FileFormat& format, const std::string& requested) {
  if (!requested.empty()) return requested;
  return format.is_survey ? "world" : "sensor";
}

std::span<const std::string> colour_by_names() {
  static const std::vector<std::string> kSinkNames = {
      "height", "range", "intensity", "ring", "class", "instance", "radial_velocity"};
  return kSinkNames;
}

std::filesystem::path sidecar_path(const std::filesystem::path& path) {
  std::string name = path.string();
  name.resize(name.size() - format_for(path).suffix.size());
  return name + ".glidar.json";
}

struct RunFile::State {
  std::filesystem::path path;
  const Format& format;
  FileSinkOptions options;
  SidecarContext context;
  Report report;
  StagedFiles staged = {};
  AtomicFile* file = nullptr;  ///< nullptr: there was no frame
  RunTotals totals = {};
  PointCloud columns = {};  ///< of the first frame, without its points
  Frame first = {};         ///< with its stamp only
  bool has_warned = false;
  bool has_moved = false;  ///< the axes of a later frame are others than those of the first

  /// The columns of the first frame as those of all points.
  [[nodiscard]] CloudFile job(std::span<const PointField> fields) const {
    return {columns, first, options, context, fields, {}, {}, has_moved};
  }

  void begin(const PointCloud& cloud, const Frame& frame, std::span<const PointField> fields) {
    columns = {1, 0, cloud.frame_id, cloud.world_from_cloud, {}};
    for (const Column& column : cloud.columns) {
      Column& empty = columns.columns.emplace_back(Column{column.name, column.components, {}});
      std::visit([&](const auto& values) { empty.values = std::decay_t<decltype(values)>(); },
                 column.values);
    }
    first.stamp_ns = frame.stamp_ns;
    file = &staged.add(path);
    file->write(format.run_start(job(fields), totals));
  }

  /// Throws Error for a cloud with other columns or axes than the first one, or too many points.
  void check_same(const PointCloud& cloud) const {
    const auto is_same = [](const Column& one, const Column& other) {
      return one.name == other.name && one.values.index() == other.values.index();
    };
    if (cloud.frame_id != columns.frame_id ||
        !std::ranges::equal(cloud.columns, columns.columns, is_same))
      throw Error({path.string(), "a frame with other columns or axes than the first one", "",
                   "open an output for each"});
    if (totals.points + cloud.size() <= std::numeric_limits<std::uint32_t>::max()) return;
    throw Error({path.string(), "more than 2^32 - 1 points", "fewer points in a file",
                 "write a file for each frame (--per-frame, per_frame=True in Python)"});
  }
};

RunFile::RunFile(const std::filesystem::path& path, const FileSinkOptions& options,
                 const SidecarContext& context, Report report)
    : state_(new State{path, find_format(path), options, context, std::move(report)}) {
  check_available(path, state_->format.info);
  check_folder(path, state_->format);
  check(options);
  state_->staged.protect(context.inputs);
}

RunFile::~RunFile() = default;

std::uint64_t RunFile::append(const PointCloud& cloud, const Frame& frame, const Beams& beams) {
  State& s = *state_;
  check_column_names(cloud, s.path);
  check_column_sizes(cloud, s.path);
  check_column_types(cloud, s.path);
  check_needed_columns(s.format.info, cloud, s.path);
  const bool has_hits_only = s.format.content == Content::hits;
  PointCloud points = cloud;
  if (has_hits_only || s.options.drop_invalid) remove_invalid_points(cloud, points);
  if (!has_hits_only) points = in_time_order(points);
  points.columns.push_back(
      {kFrameColumn, {kFrameColumn}, std::vector<std::uint32_t>(points.size(), frame.number)});
  const std::vector<PointField> fields = s.format.fields(points);
  check_unique(fields, s.path);
  if (s.file == nullptr) s.begin(points, frame, fields);
  s.check_same(points);
  s.has_moved |= cloud.world_from_cloud.matrix() != s.columns.world_from_cloud.matrix();
  const SidecarContext context{s.context.scene,    s.context.sensor,  beams,
                               s.context.renderer, s.context.command, s.context.inputs};
  s.format.append({points, frame, s.options, context, fields}, s.totals, *s.file);
  const std::string warning = s.format.rounding_warning != nullptr
                                  ? s.format.rounding_warning(points)
                                  : rounding_warning(fields,
                                                     "write .csv or .ply, which store "
                                                     "distant points exactly");
  if (!warning.empty() && !std::exchange(s.has_warned, true))
    s.report.warn(s.path.string() + ": " + warning);
  return points.size();
}

SidecarEntry RunFile::finish() {
  State& s = *state_;
  const std::vector<PointField> fields = s.format.fields(s.columns);
  s.columns.cols = static_cast<std::uint32_t>(s.totals.points);
  s.file->seek(0);
  s.file->write(s.format.run_start(s.job(fields), s.totals));
  s.file->finish();
  return sidecar_entry(s.job(fields), s.path);
}

void RunFile::stage_text(const std::filesystem::path& path, const std::string& text) {
  AtomicFile& file = state_->staged.add(path);
  file.write(text);
  file.finish();
}

void RunFile::commit() {
  state_->staged.commit();
}

std::unique_ptr<FileSink> make_file_sink(const std::filesystem::path& path,
                                         const FileSinkOptions& options,
                                         const SidecarContext& context, Report report) {
  const Format& format = find_format(path);
  check_available(path, format.info);
  const std::filesystem::path output = output_path(path);
  check_folder(output, format);
  check(options);
  return std::make_unique<FormatSink>(Target{output}, format, options, context, std::move(report));
}

std::unique_ptr<FileSink> make_stream_sink(int descriptor, const std::filesystem::path& name,
                                           const FileSinkOptions& options,
                                           const SidecarContext& context, Report report) {
  const Format& format = find_format(name);
  check_available(name, format.info);
  check(options);
  if (format.info.is_folder) {
    throw Error({name.string(), "is a folder of several files", "a format of one file",
                 "write to a folder instead"});
  }
  return std::make_unique<FormatSink>(Target{name, descriptor}, format, options, context,
                                      std::move(report));
}

}  // namespace glidar
