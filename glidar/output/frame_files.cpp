// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/output/frame_files.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/option_name.hpp>
#include <glidar/core/text.hpp>
#include <glidar/io/files/atomic_file.hpp>
#include <glidar/io/formats/cloud_layout.hpp>
#include <glidar/io/formats/sidecar_file.hpp>

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <map>
#include <set>
#include <string_view>
#include <utility>

namespace glidar {

/// A file to be written.
struct PlannedFile {
  std::filesystem::path path;
  std::vector<std::string> columns;
  std::string frame_name;  ///< optical, ros, gl, world or legacy
  bool deskew = false;
  bool has_all_frames = false;  ///< and not one of them
  std::unique_ptr<FileSink> sink;
};

namespace {

void add_missing(const std::string& name, std::vector<std::string>& names) {
  if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
}

std::vector<std::string> requested_columns(const FrameFileRequest& request) {
  if (!request.sink.layout.empty()) return find_layout(request.sink.layout).columns;
  return request.columns.empty() ? default_columns() : request.columns;
}

/// Throws Error unless there is at most one standard output and its format is given.
void check_standard_output(const FrameFileRequest& request) {
  const auto count = std::count(request.paths.begin(), request.paths.end(), kStandardOutput);
  if (count > 1) {
    throw Error(
        {"--output -", "is given twice", "one standard output", "write the other one to a file"});
  }
  if (count == 0 && !request.format.empty()) {
    throw Error({"--format " + request.format, "there is no -o -", "--format with -o -",
                 "leave it out: the suffix of a file selects its format"});
  }
  if (count == 1 && request.format.empty()) {
    throw Error({"--output -", "the format of standard output is not given", "-o - with --format",
                 "add --format csv, or another of those that --help lists"});
  }
}

void check_picture(const CloudPictureOptions& picture) {
  if (!picture.eye_m || !picture.target_m || *picture.eye_m != *picture.target_m) return;
  throw Error({.where = "--view-eye (view_eye in Python)",
               .found = "it is the point that the camera looks at",
               .allowed = "a position other than that of --view-target (view_target)"});
}

void refuse_terminal(const FileFormat& format, const FileSinkOptions& options) {
  if (::isatty(STDOUT_FILENO) == 0 || is_text(format, options)) return;
  throw Error({"--output -", "standard output is a terminal, and this format is binary",
               "text on a terminal",
               "pipe it to a program or a file, or write text: --format csv"});
}

/// Formats that hold no points (images, poses) have a fixed set of columns.
std::vector<std::string> columns_of(const FileFormat& format,
                                    const std::vector<std::string>& requested) {
  if (!format.takes_more) return needed_columns(format);
  std::vector<std::string> columns = requested;
  for (const std::string& name : needed_columns(format)) add_missing(name, columns);
  return columns;
}

/// The names of the files of the original GLIDAR, and their columns.
std::vector<std::filesystem::path> legacy_paths(const std::string& name) {
  return {name + ".pcd", name + ".transform"};
}

std::vector<std::string> legacy_columns(const std::filesystem::path& path) {
  return columns_of(format_for(path), {"xyz", "intensity"});
}

/// Whether a path of a sequence gets all frames.
bool has_all_frames(const FrameFileRequest& request, const std::string& path) {
  return request.is_sequence && !request.per_frame && path != kStandardOutput &&
         takes_runs(path, request.sink);
}

/// The path of one file.
PlannedFile plan_file(const std::string& path, const FrameFileRequest& request,
                      const FileSinkOptions& options, const SidecarContext& context,
                      const Report& report) {
  const FileFormat& format = format_of(request, path);
  PlannedFile file{
      .path = path == kStandardOutput ? std::filesystem::path(path) : output_path(path),
      .columns = columns_of(format, requested_columns(request)),
      .frame_name = frame_for(format, request.frame),
      .deskew = request.deskew || format.is_survey,
      .has_all_frames = has_all_frames(request, path),
      .sink = nullptr};
  if (file.has_all_frames) {
    add_missing("stamp", file.columns);
    if (request.frame.empty()) file.frame_name = "world";
    file.deskew = true;
  }
  if (path == kStandardOutput) {
    refuse_terminal(format, options);
    file.sink =
        make_stream_sink(STDOUT_FILENO, "stdout." + request.format, options, context, report);
  } else {
    file.sink = make_file_sink(path, options, context, report);
  }
  return file;
}

/// Standard output comes last: when its reader closes it early, all files exist.
std::vector<std::string> in_order(std::vector<std::string> paths) {
  std::stable_partition(paths.begin(), paths.end(),
                        [](const std::string& path) { return path != kStandardOutput; });
  return paths;
}

void check_names(const std::vector<PlannedFile>& files, const FrameFileRequest& request) {
  std::set<std::filesystem::path> seen;
  for (const PlannedFile& file : files) {
    const bool is_input = !request.input.empty() && is_same_file(file.path, request.input);
    const bool is_repeated = !seen.insert(real_path(file.path)).second;
    if (!is_input && !is_repeated) continue;
    with_option_name(request.option, [&] {
      throw Error({.where = file.path.string(),
                   .found = is_input ? "is an input file" : "is given twice as output",
                   .remedy = "choose another name"});
    });
  }
}

/// The options of a file whose writing is part of the progress.
FileSinkOptions with_progress(FileSinkOptions options, const std::string& path,
                              const Report& report) {
  if (!report.progress) return options;
  options.progress = [progress = report.progress, task = "writing " + path](double fraction) {
    progress(task, fraction);
  };
  return options;
}

/// Adds the files of the original program.
void plan_legacy_files(const std::string& name, const SidecarContext& context, const Report& report,
                       std::vector<PlannedFile>& files) {
  const FileSinkOptions options{.drop_invalid = true, .sidecar = false};
  for (const std::filesystem::path& path : legacy_paths(name)) {
    files.push_back({.path = path,
                     .columns = legacy_columns(path),
                     .frame_name = "legacy",
                     .sink = make_file_sink(path, options, context, report)});
  }
}

/// All files of a frame. Writing uses the context and sends warnings to `report`.
std::vector<PlannedFile> plan_files(const FrameFileRequest& request, const SidecarContext& context,
                                    const Report& report) {
  check_standard_output(request);
  check_picture(request.sink.picture);
  std::vector<PlannedFile> files;
  for (const std::string& path : in_order(request.paths)) {
    const FileSinkOptions options = with_progress(request.sink, path, report);
    with_option_name(request.option,
                     [&] { files.push_back(plan_file(path, request, options, context, report)); });
  }
  if (!request.legacy_name.empty()) {
    with_option_name("--legacy-output",
                     [&] { plan_legacy_files(request.legacy_name, context, report, files); });
  }
  // what is added to a file of all frames stays there, so all others are complete before
  std::ranges::stable_partition(files,
                                [](const PlannedFile& file) { return !file.has_all_frames; });
  check_names(files, request);
  return files;
}

/// Gives the files of a frame their names, one after the other.
void commit_all(const std::vector<PlannedFile>& files) {
  std::string written;
  for (const PlannedFile& file : files) {
    try {
      file.sink->commit();
    } catch (const ClosedPipe&) {
      throw;
    } catch (const Error& error) {
      ErrorParts parts = error.parts();
      parts.remedy += (parts.remedy.empty() ? "" : "; ") +
                      (written.empty() ? "no file of this frame was written"
                                       : "these outputs are written:" + written);
      throw Error(parts);
    }
    written += " " + file.path.string();
  }
}

/// Throws Error when a coordinate reference system is given, but no output takes one.
void check_crs(const FrameFileRequest& request) {
  if (request.sink.crs.empty()) return;
  const auto is_survey = [&](const std::string& path) {
    return format_of(request, path).is_survey;
  };
  if (std::any_of(request.paths.begin(), request.paths.end(), is_survey)) return;
  throw Error({.where = "--crs",
               .found = "no output takes a coordinate reference system",
               .allowed = "an output with the suffix .las",
               .remedy = "add one, such as -o survey.las, or leave --crs out"});
}

/// The same for one sensor of a rig: NAME_lidar.pcd for NAME.pcd.
FrameFileRequest labelled(const FrameFileRequest& request, const std::string& label) {
  if (writes_standard_output(request)) {
    throw Error({"--output -", "several clouds are written, which one stream cannot separate",
                 "one frame of one sensor on standard output",
                 "use glidar render without --duration, and --sensor-name to choose one of a rig's "
                 "sensors, or write files"});
  }
  FrameFileRequest result = request;
  for (std::string& path : result.paths) {
    path = output_path(path);
    path.insert(path.size() - format_for(path).suffix.size(), "_" + label);
  }
  if (!result.legacy_name.empty()) result.legacy_name += "_" + label;
  return result;
}

/// Adds a path to the requests of the sensors that it fits.
void distribute(const std::string& path, const FrameFileRequest& request, const OutputRig& rig,
                std::vector<FrameFileRequest>& of_sensor, const Report& report) {
  const FileFormat& format = format_of(request, path);
  std::string reasons;
  std::string remedy;
  std::size_t fitting = 0;
  for (std::size_t i = 0; i < rig.sensors.size(); ++i) {
    const OutputSensor& sensor = rig.sensors[i];
    const Misfit misfit = find_misfit(format, request.sink.picture, sensor.sensor, sensor.beams);
    if (misfit.reason.empty()) {
      of_sensor[i].paths.push_back(path);
      ++fitting;
      continue;
    }
    reasons += fmt::format("{}{}: {}", reasons.empty() ? "" : "; ", sensor.name, misfit.reason);
    remedy = misfit.remedy;
  }
  if (fitting == 0) {
    with_option_name(request.option, [&] {
      throw Error({.where = path,
                   .found = "fits none of the sensors on the rig: " + reasons,
                   .allowed = "an output that fits at least one of them",
                   .remedy = remedy});
    });
  }
  if (!reasons.empty()) report.info(fmt::format("{} is not written for {}", path, reasons));
}

std::vector<FrameFileRequest> request_by_sensor(const FrameFileRequest& request,
                                                const OutputRig& rig, const Report& report) {
  std::vector<FrameFileRequest> of_sensor(rig.sensors.size(), request);
  if (rig.sensors.size() == 1) return of_sensor;
  for (FrameFileRequest& one : of_sensor) one.paths.clear();
  for (const std::string& path : request.paths) distribute(path, request, rig, of_sensor, report);
  return of_sensor;
}

}  // namespace

const std::vector<std::string>& default_columns() {
  static const std::vector<std::string> kColumns = {"xyz",    "intensity", "range",
                                                    "normal", "instance",  "class"};
  return kColumns;
}

const FileFormat& format_of(const FrameFileRequest& request, const std::string& path) {
  return format_for(path == kStandardOutput ? "stdout." + request.format : path);
}

bool writes_standard_output(const FrameFileRequest& request) {
  return std::ranges::find(request.paths, kStandardOutput) != request.paths.end();
}

bool has_outputs(const FrameFileRequest& request) {
  return !request.paths.empty() || !request.legacy_name.empty();
}

FrameFileRequest numbered(const FrameFileRequest& request, std::uint32_t frame) {
  FrameFileRequest result = labelled(request, fmt::format("{:06}", frame));
  result.is_sequence = true;
  for (std::size_t i = 0; i < request.paths.size(); ++i) {
    const std::string& path = request.paths[i];
    if (format_of(request, path).is_folder || has_all_frames(result, path)) result.paths[i] = path;
  }
  return result;
}

void check_layout(const FrameFileRequest& request, bool has_bag) {
  check_crs(request);
  if (request.sink.layout.empty() || has_bag) return;
  const auto is_laid_out = [&](const std::string& path) {
    return takes_layout(path == kStandardOutput ? "stdout." + request.format : path);
  };
  if (std::any_of(request.paths.begin(), request.paths.end(), is_laid_out)) return;
  throw Error({.where = "--layout",
               .found = "no output takes a layout",
               .allowed = "a bag, or an output with the suffix " + suffixes_with_layouts(),
               .remedy = "add one, such as -o scan.pcd, or leave --layout out"});
}

std::vector<std::filesystem::path> check_frame_files(const FrameFileRequest& request) {
  const Scene scene;
  const Sensor sensor;
  const Beams beams;
  std::vector<std::filesystem::path> all;
  for (const PlannedFile& file : plan_files(
           request, {.scene = scene, .sensor = sensor, .beams = beams, .renderer = {}}, {})) {
    const std::vector<std::filesystem::path> made = file.sink->files();
    all.insert(all.end(), made.begin(), made.end());
  }
  return all;
}

/// The sidecar of the run for that of a frame: NAME.glidar.json for NAME_000007.glidar.json.
std::filesystem::path run_sidecar_path(const std::filesystem::path& sidecar, std::uint64_t index) {
  constexpr std::string_view kSuffix = ".glidar.json";
  std::string name = sidecar.string();
  name.resize(name.size() - kSuffix.size() - fmt::format("_{:06}", index).size());
  return name + std::string(kSuffix);
}

struct FrameFiles::Run {
  RunSidecar sidecar;
  bool is_written = false;
  // of the frame that is being written:
  std::vector<FramePoints> points = {};      ///< in files that have all frames
  Pose world_from_cloud = Pose::Identity();  ///< of the first of them

  /// Adds the points of a frame in one of the files.
  void add(FramePoints added, const Pose& pose) {
    if (points.empty()) world_from_cloud = pose;
    points.push_back(std::move(added));
  }
  /// Lists the frame once all its files have it.
  void end_frame(const SidecarContext& context, const Frame& frame) {
    if (points.empty()) return;
    sidecar.add_frame(frame_entry(context, frame, sidecar, points, world_from_cloud));
    points.clear();
  }
};

FrameFiles::FrameFiles(FrameFileRequest request, bool is_numbered, const OutputRig& rig,
                       Report report)
    : request_(std::move(request)),
      is_numbered_(is_numbered),
      rig_(rig),
      report_(std::move(report)),
      of_sensor_(request_by_sensor(request_, rig_, report_)) {
  for (std::size_t i = 0; i < rig_.sensors.size(); ++i) {
    if (!has_files(i)) continue;
    for (const std::filesystem::path& file : check_frame_files(request_of(i, 0))) {
      refuse_overwrite_of_inputs(rig_.inputs, file);
      if (is_numbered_ && file.string().ends_with("_000000.glidar.json"))
        refuse_overwrite_of_inputs(rig_.inputs, run_sidecar_path(file, 0));
    }
  }
}

FrameFiles::~FrameFiles() = default;

FrameFileRequest FrameFiles::request_of(std::size_t sensor, std::uint64_t index) const {
  const std::string& label = rig_.sensors[sensor].label;
  const FrameFileRequest request =
      label.empty() ? of_sensor_[sensor] : labelled(of_sensor_[sensor], label);
  return is_numbered_ ? numbered(request, static_cast<std::uint32_t>(index)) : request;
}

HitColumnMask FrameFiles::hit_columns(std::size_t sensor) const {
  const FrameFileRequest& request = of_sensor_[sensor];
  std::vector<std::string> columns;
  bool has_box = false;
  for (const std::string& path : request.paths) {
    const FileFormat& format = format_of(request, path);
    for (const std::string& name : columns_of(format, requested_columns(request)))
      add_missing(name, columns);
    has_box = has_box || (path != kStandardOutput && has_boxes(format, request.sink));
  }
  if (!request.legacy_name.empty()) {
    for (const std::filesystem::path& path : legacy_paths(request.legacy_name)) {
      for (const std::string& name : legacy_columns(path)) add_missing(name, columns);
    }
  }
  HitColumnMask hit_columns = hit_columns_for(columns);
  hit_columns.boxes = has_box;
  return hit_columns;
}

SidecarContext FrameFiles::context_of(std::size_t index, const Beams& beams) const {
  const OutputSensor& sensor = rig_.sensors[index];
  SidecarContext context{.scene = rig_.scene,
                         .sensor = sensor.sensor,
                         .beams = beams,
                         .renderer = rig_.renderer,
                         .command = rig_.command,
                         .inputs = rig_.inputs};
  std::vector<std::string>& arguments = context.command.arguments;
  if (!sensor.label.empty() && !arguments.empty())
    arguments.insert(arguments.end(), {"--sensor-name", sensor.label});
  return context;
}

FrameFiles::Run& FrameFiles::run_at(const std::filesystem::path& path,
                                    const SidecarContext& context, const Frame& frame) {
  std::unique_ptr<Run>& run = runs_[path];
  if (!run) run = std::make_unique<Run>(Run{run_sidecar(context, frame, path)});
  return *run;
}

void FrameFiles::write(const RigFrame& written) {
  files_.clear();
  if (!has_files(written.sensor)) return;
  const SidecarContext context = context_of(written.sensor, written.beams);
  const std::vector<PlannedFile> files =
      plan_files(request_of(written.sensor, written.index), context, report_);
  for (const PlannedFile& file : files) {
    for (const std::filesystem::path& made : file.sink->files())
      refuse_overwrite_of_inputs(rig_.inputs, made);
  }
  stage(files, written, context);
  commit_all(files);
  for (const PlannedFile& file : files) {
    if (!file.has_all_frames) files_.push_back(file.path);
  }
  if (files_.empty()) return;
  if (count_ == 0) first_ = files_.front();
  last_ = files_.back();
  count_ += files_.size();
}

void FrameFiles::stage(const std::vector<PlannedFile>& files, const RigFrame& written,
                       const SidecarContext& context) {
  PointCloud cloud;
  const PlannedFile* previous = nullptr;
  bool has_sidecars = false;
  for (const PlannedFile& file : files) {
    if (file.has_all_frames && !std::exchange(has_sidecars, true))
      stage_sidecars(files, written, context);
    if (report_.progress) report_.progress("writing " + file.path.string(), -1.0);
    const bool is_same_cloud = previous != nullptr && previous->columns == file.columns &&
                               previous->frame_name == file.frame_name &&
                               previous->deskew == file.deskew;
    if (!is_same_cloud) {
      OutputFrame axes =
          output_frame(file.frame_name, written.beams, written.frame.world_from_sensor);
      axes.deskew = file.deskew;
      make_point_cloud(written.frame, written.beams, rig_.scene, axes, file.columns, cloud);
      previous = &file;
    }
    if (file.has_all_frames) {
      append(file, cloud, written, context);
    } else {
      file.sink->stage(cloud, written.frame);
    }
  }
  if (!has_sidecars) stage_sidecars(files, written, context);
  for (const auto& [path, run] : runs_) run->end_frame(context, written.frame);
}

void FrameFiles::append(const PlannedFile& file, const PointCloud& cloud, const RigFrame& written,
                        const SidecarContext& context) {
  std::unique_ptr<RunFile>& to = run_files_[file.path];
  if (!to) {
    to = std::make_unique<RunFile>(file.path, request_.sink,
                                   context_of(written.sensor, rig_.sensors[written.sensor].beams),
                                   report_);
  }
  const std::uint64_t points = to->append(cloud, written.frame, written.beams);
  if (!request_.sink.sidecar) return;
  Run& run = run_at(sidecar_path(file.path), context, written.frame);
  run.add({file.path.filename().string(), points}, cloud.world_from_cloud);
}

void FrameFiles::stage_sidecars(const std::vector<PlannedFile>& files, const RigFrame& written,
                                const SidecarContext& context) {
  std::map<std::filesystem::path, std::vector<const PlannedFile*>> by_sidecar;
  for (const PlannedFile& file : files) {
    if (file.sink->sidecar_entry()) by_sidecar[sidecar_path(file.path)].push_back(&file);
  }
  for (const auto& [path, described] : by_sidecar) {
    std::vector<SidecarEntry> entries;
    for (const PlannedFile* file : described) entries.push_back(*file->sink->sidecar_entry());
    FileSink& first = *described.front()->sink;
    if (!is_numbered_) {
      first.stage_text(path, sidecar_text(context, written.frame, entries, path));
      continue;
    }
    const std::filesystem::path run_path = run_sidecar_path(path, written.index);
    Run& run = run_at(run_path, context, written.frame);
    if (!std::exchange(run.is_written, true))
      first.stage_text(run_path, sidecar_text(run.sidecar, {}));
    first.stage_text(path, sidecar_text(context, written.frame, entries, run.sidecar));
  }
}

void FrameFiles::finish() {
  std::map<std::filesystem::path, std::vector<SidecarEntry>> entries;
  for (const auto& [path, file] : run_files_) {
    const SidecarEntry entry = file->finish();
    if (request_.sink.sidecar) entries[sidecar_path(path)].push_back(entry);
  }
  for (const auto& [path, file] : run_files_) {
    const auto listed = entries.find(sidecar_path(path));
    if (listed != entries.end()) {
      const Run& run = *runs_.at(listed->first);
      file->stage_text(listed->first, sidecar_text(run.sidecar, listed->second));
      entries.erase(listed);
    }
    file->commit();
    run_paths_.push_back(path);
  }
  run_files_.clear();
}

std::string FrameFiles::run_text() const {
  std::string text;
  for (const std::filesystem::path& path : run_paths_) text += " " + printable_line(path.string());
  return text.empty() ? text : "wrote" + text + "\n";
}

std::string FrameFiles::written_text() const {
  if (count_ == 0) return run_text();
  if (count_ == 1) return "wrote " + printable_line(first_.string()) + "\n" + run_text();
  return fmt::format("wrote {} to {} ({} files)\n", printable_line(first_.string()),
                     printable_line(last_.string()), count_) +
         run_text();
}

}  // namespace glidar
