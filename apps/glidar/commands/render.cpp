// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/commands/commands.hpp>
#include <apps/glidar/run/advice.hpp>
#include <apps/glidar/run/console.hpp>
#include <apps/glidar/run/delivery.hpp>
#include <apps/glidar/run/fisher_output.hpp>
#include <apps/glidar/run/outputs.hpp>
#include <apps/glidar/run/prepared_scene.hpp>
#include <apps/glidar/run/recorded_command.hpp>
#include <glidar/core/error.hpp>
#include <glidar/io/files/atomic_file.hpp>
#include <glidar/output/frame_files.hpp>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <filesystem>
#include <memory>
#include <optional>

namespace glidar::app {
namespace {

constexpr const char* kRenderExamples = R"(Examples:
  glidar render builtin:asteroid -o asteroid.pcd -o asteroid.png
  glidar render builtin:box --eye 4,-6,3 --target 0,0,0 --width 640 --height 480 --fov 40 -o box.ply
  glidar render builtin:torus --fx 500 --cx 300 --cy 250 -w 640 --height 480 -o torus.depth.png
  glidar render builtin:sphere --columns all -o sphere.npz
  glidar render builtin:torus --sensor D435 --depth-model physical -o d.png -o torus.ir_left.png
  glidar render builtin:box --sensor VLP-16 --eye 0,0,0 --columns all -o room.pcd -o room.png
  glidar render builtin:box --sensor OS1-128 --eye 0,0,0 --colour-by range -o room.bev.png
  glidar render builtin:box --sensor VLP-16 --eye 0,0,0 --layout velodyne --drop-invalid -o scan.pcd
  glidar render builtin:box --sensor OS1-32 --eye 0,0,0 --sensor-rate 0,1,0 --duration 1 -o scan.pcd
  glidar render builtin:box --sensor VLP-16 --eye 0,0,0 --duration 1 -o scans.mcap -o scans.pcap
  glidar render builtin:box --sensor VLP-16 --eye 0,0,0 --duration 0.2 -o drive.kitti
  glidar render builtin:box -o - --format csv
  glidar render builtin:box --object-rate 0,0,2 --columns xyz,true_radial_velocity -o spin.ply
  glidar render builtin:asteroid --model-q 0.7,0,0.7,0 --camera-z 10 --legacy-output view
With your own files:
  glidar render part.stl --unit mm --up y -o part.pcd
  glidar render scene.yaml --sensor camera.yaml --frame ros -o cloud.npz
  glidar render traffic.yaml --sensor fmcw.yaml --colour-by radial_velocity -o traffic.view.png
  glidar render builtin:box --sensor VLP-16 --imu BMI088 --trajectory walk.tum
      --trajectory-interpolation spline --duration 5 -o scan.pcd -o walk.imu.csv

Woods 2016 compatibility: quaternions are attitudes, which rotate inertial vectors into the body.
The object is at the inertial origin, the sensor at (0, 0, -D), and
  p_sensor = R(camera-q) (R(model-q)^T p_object + (0, 0, D))
in the frame x left, y up, z forward. --model-q works with any other pose option.
Exit codes: 0 done (also when nothing was hit), 2 bad input, 130 interrupted,
141 standard output was closed.)";

/// Measures the scene and shows the progress.
void measure(const ActiveSensor& active, const HitColumnMask& hit_columns, Console& console,
             Frame& frame) {
  const ProgressScope progress(console, fmt::format("casting {} beams", active.beams.size()));
  active.simulator->simulate(active.motion, hit_columns, frame,
                             [&console](double fraction) { console.set_progress(fraction); });
}

void print_summary(const View& view, const std::vector<std::filesystem::path>& files,
                   std::FILE* to) {
  const FrameSummary s = summarise(view.frame);
  const double percent =
      100.0 * static_cast<double>(s.hits) / static_cast<double>(view.beams.size());
  print(to, "{} x {} beams", view.beams.rows / view.beams.returns, view.beams.cols);
  if (view.beams.returns > 1) print(to, ", {} returns", view.beams.returns);
  print(to, ", {} hits ({:.1f} %)", s.hits, percent);
  const double offset_m = view.beams.range_offset_m;
  if (s.hits > 0) {
    print(to, ", range {:.6g} to {:.6g} m", s.nearest_m + offset_m, s.farthest_m + offset_m);
  }
  print(to, "\nwrote");
  for (const std::filesystem::path& file : files) print(to, " {}", file.string());
  print(to, "\n");
}

/// Where results are printed; nullptr: nowhere.
std::FILE* result_stream(const RenderFlags& flags) {
  if (flags.quiet) return nullptr;
  return writes_standard_output(flags.output) ? stderr : stdout;
}

/// The output beside which the Fisher information of a frame is: its first file, else the first
/// file or recording of all frames.
std::filesystem::path fisher_neighbour(const RenderFlags& flags, const ActiveSensor& active,
                                       const std::vector<std::filesystem::path>& files) {
  if (!files.empty()) return files.front();
  const OutputFlags& outputs = flags.output;
  std::filesystem::path path =
      (outputs.paths.empty() ? outputs.recording_paths : outputs.paths).front();
  if (!path.has_filename()) path = path.parent_path();
  const std::string label = label_of(flags, active);
  const std::string stem = path.stem().string() + (label.empty() ? "" : "_" + label);
  return path.replace_filename(stem + path.extension().string());
}

/// A run of `render`.
struct Job {
  const RenderFlags& flags;
  const PreparedScene& prepared;
  FrameFiles files;                                 ///< of each frame
  std::vector<std::unique_ptr<Output>> recordings;  ///< bags and packet captures
  std::unique_ptr<Output> imu;                      ///< samples of IMUs; nullptr: none
  std::vector<std::filesystem::path> written = {};  ///< so far
};

HitColumnMask needed_hit_columns(const Job& job, std::size_t sensor) {
  HitColumnMask hit_columns = job.files.hit_columns(sensor);
  hit_columns.normal = hit_columns.normal || job.flags.fisher.is_requested;
  for (const auto& recording : job.recordings)
    hit_columns = hit_columns | recording->hit_columns(sensor);
  return hit_columns;
}

/// The error, with the outputs that were written before it.
Error after_writing(const Error& error, const std::vector<std::filesystem::path>& written) {
  ErrorParts parts = error.parts();
  parts.remedy += parts.remedy.empty() ? "" : "; ";
  parts.remedy += fmt::format("{} output{} written before that, from {} to {}", written.size(),
                              written.size() == 1 ? " was" : "s were", written.front().string(),
                              written.back().string());
  return Error(parts);
}

/// Appends a frame to the recordings, and writes its files.
void write(Job& job, const MeasuredFrame& measured, Console& console) {
  const ProgressScope progress(console, "writing");
  for (const auto& recording : job.recordings) recording->write(measured.view());
  job.files.write(measured.view());
}

/// Completes an output of all frames.
void finish(Job& job, Output& output) {
  output.finish();
  for (const std::filesystem::path& file : output.files()) job.written.push_back(file);
  if (std::FILE* to = result_stream(job.flags)) print_lines(to, output.written_text());
}

/// Measures a frame and writes it to files of its own and to the recordings.
void measure_and_write(Job& job, const SensorFrame& which, Console& console,
                       MeasuredFrame& measured) {
  const RenderFlags& flags = job.flags;
  const PreparedScene& prepared = job.prepared;
  const ActiveSensor& active = prepared.sensors[which.sensor_index];
  measured.sensor_index = which.sensor_index;
  measured.index = which.number;
  measured.beams = active.simulator->beams(which.number);
  const View view{prepared.scene, active.sensor, *measured.beams, measured.frame};
  set_frame_header(flags, prepared, active, which.number, measured.frame);
  measure(active, needed_hit_columns(job, which.sensor_index), console, measured.frame);
  if (which.number == 0) print_advice(view_advice(view), console);
  write(job, measured, console);
  const std::vector<std::filesystem::path> files = job.files.files();
  std::FILE* to = result_stream(flags);
  if (to != nullptr && !files.empty()) print_summary(view, files, to);
  if (flags.fisher.is_requested) {
    std::optional<std::uint32_t> number;
    if (is_sequence(flags)) number = which.number;
    write_fisher(flags.fisher, measured.frame, *measured.beams,
                 fisher_neighbour(flags, active, files), number, to);
  }
  job.written.insert(job.written.end(), files.begin(), files.end());
}

/// All frames of all sensors, in the order of time.
void measure_all(Job& job, Console& console) {
  std::vector<MeasuredFrame> frames(job.prepared.sensors.size());  // sensors have their own sizes
  FrameOrder order(job.prepared.sensors);
  const auto is_written = [&](std::size_t sensor) {
    return job.files.has_files(sensor) || !job.recordings.empty();
  };
  std::size_t count = 0;
  for (std::size_t i = 0; i < frames.size(); ++i)
    count += is_written(i) ? job.prepared.sensors[i].frames : 0;
  std::optional<ProgressScope> progress;
  if (count > 1) progress.emplace(console, "frame", count);
  while (const std::optional<SensorFrame> which = order.next()) {
    if (!is_written(which->sensor_index)) continue;
    if (progress) progress->next();
    measure_and_write(job, *which, console, frames[which->sensor_index]);
  }
}

/// The files of the first frame, checked before the work begins.
std::vector<std::filesystem::path> first_files(const OutputFlags& flags) {
  if (has_outputs(flags)) return check_frame_files(flags);
  if (has_run_outputs(flags)) return {};
  throw Error(
      {.where = "--output",
       .found = "there is no -o, so nothing would be written",
       .allowed = "files by suffix: " + all_suffixes(),
       .remedy = "for example: glidar render " + flags.input + " -o cloud.pcd -o picture.png"});
}

/// Measures and writes all frames of a prepared scene.
void run(const RenderFlags& flags, const PreparedScene& prepared, const CommandRecord& command,
         Console& console) {
  OutputRig rig = output_rig(flags, prepared, PoseOrigin::motion);
  rig.command = command;
  rig.end_ns = end_ns(prepared);
  const FrameFileRequest& files = flags.output;
  Job job{flags, prepared, FrameFiles(files, is_sequence(flags), rig, console.report()),
          open_recordings(flags.output, rig), open_imu_outputs(flags.output, rig, console)};
  try {
    measure_all(job, console);
    job.files.finish();
    if (std::FILE* to = result_stream(flags)) print_lines(to, job.files.run_text());
    for (const auto& recording : job.recordings) finish(job, *recording);
    if (job.imu) finish(job, *job.imu);
  } catch (const Error& error) {
    if (job.written.empty()) throw;
    throw after_writing(error, job.written);
  }
}

/// Throws Error if IMU samples are requested without a duration.
void check_imu_outputs(const RenderFlags& flags) {
  if (flags.output.imu_paths.empty() || is_sequence(flags)) return;
  throw Error({"--output, " + flags.output.imu_paths.front(), "samples of IMUs without a duration",
               "this output with --duration", "add --duration 1, for example"});
}

int run_render(RenderFlags flags, const std::vector<std::string>& arguments) {
  flags.output.input = flags.input;
  Console console(flags.quiet);
  check_fisher(flags);
  check_imu_outputs(flags);
  if (is_sequence(flags)) numbered(flags.output, 0);  // for its errors only
  CommandRecord command = {.arguments = reproducible_arguments(arguments),
                           .folder = std::filesystem::current_path()};
  const std::vector<std::filesystem::path> files = first_files(flags.output);
  check_layout(flags.output);
  PreparedScene prepared;
  prepare_scene(
      flags,
      [&] {
        for (const std::filesystem::path& file : files)
          refuse_overwrite_of_inputs(prepared.files, file);
      },
      console, prepared);
  set_start_time(prepared.recorded_start, command);
  refuse_unused_output_options(flags.output, prepared, {});
  refuse_unused_imu(flags, prepared, {}, PoseOrigin::motion);
  run(flags, prepared, command, console);
  return kDone;
}

}  // namespace

Command add_render(CLI::App& program, const std::vector<std::string>& arguments) {
  CLI::App& command =
      *program.add_subcommand("render", "Measure a model or scene with a 3D sensor");
  const auto flags = std::make_shared<RenderFlags>();
  command.footer(output_names_text() + kRenderExamples);
  add_render_options(command, *flags);
  add_per_frame_option(command, flags->output);
  return [flags, arguments] { return run_render(*flags, arguments); };
}

}  // namespace glidar::app
