// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/lockstep_run.hpp>

#include <apps/glidar/run/console.hpp>
#include <apps/glidar/run/pose_source.hpp>
#include <glidar/core/error.hpp>
#include <glidar/core/point_cloud.hpp>
#include <glidar/core/report.hpp>
#include <glidar/io/files/atomic_file.hpp>
#include <glidar/io/files/input_file.hpp>
#include <glidar/link/socket.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <exception>
#include <filesystem>
#include <new>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

namespace glidar::app {

namespace {

struct ColumnSize {
  std::string_view name;
  std::int64_t bytes;  ///< of a point
};

/// As documented for make_point_cloud(); lockstep_run_test.cpp compares all of them with clouds.
constexpr std::array kSizes = {
    ColumnSize{"xyz", 24},
    ColumnSize{"true_xyz", 24},
    ColumnSize{"intensity", 4},
    ColumnSize{"range", 8},
    ColumnSize{"true_range", 8},
    ColumnSize{"sigma", 4},
    ColumnSize{"radial_velocity", 8},
    ColumnSize{"true_radial_velocity", 8},
    ColumnSize{"depth", 8},
    ColumnSize{"normal", 12},
    ColumnSize{"shading_normal", 12},
    ColumnSize{"incidence", 4},
    ColumnSize{"instance", 4},
    ColumnSize{"class", 4},
    ColumnSize{"primitive", 4},
    ColumnSize{"barycentrics", 8},
    ColumnSize{"colour", 12},
    ColumnSize{"object_point", 24},
    ColumnSize{"status", 1},
    ColumnSize{"row", 4},
    ColumnSize{"col", 4},
    ColumnSize{"ring", 2},
    ColumnSize{"time", 4},
    ColumnSize{"return", 1},
    ColumnSize{"return_source", 1},
    ColumnSize{"azimuth", 8},
    ColumnSize{"elevation", 8},
    ColumnSize{"stamp", 8},
    ColumnSize{"sensor_pose", 56},
    ColumnSize{"object_pose", 56},
};

constexpr std::int64_t kMax_bytes = 56;
constexpr std::int64_t kHead_bytes = 120;

}  // namespace

std::int64_t point_bytes(std::span<const std::string> columns) {
  (void)glidar::hit_columns_for(columns);  // throws on an unknown name
  std::int64_t bytes = 0;
  for (const std::string& name : columns) {
    const auto* const found = std::find_if(
        kSizes.begin(), kSizes.end(), [&](const ColumnSize& size) { return size.name == name; });
    bytes += found == kSizes.end() ? kMax_bytes : found->bytes;
  }
  return bytes;
}

std::int64_t reply_bytes(std::span<const std::string> columns, std::size_t points,
                         std::size_t clouds) {
  const std::int64_t cloud = static_cast<std::int64_t>(points) * point_bytes(columns) + kHead_bytes;
  return static_cast<std::int64_t>(clouds) * cloud;
}

namespace {

/// Creates a file of new keys, and prints the public one.
link::CurveKeys make_key_file(const std::string& path, Console& console) {
  const link::CurveKeys keys = link::make_curve_keys();
  AtomicFile file(path, AtomicFile::Permissions::owner_only);
  file.write("public " + keys.public_key + "\nsecret " + keys.secret_key + "\n");
  file.commit();
  console.info("created new keys in " + path + "; clients need the public one: " + keys.public_key);
  return keys;
}

/// The keys in a file of two lines, "public KEY" and "secret KEY". If the file does not exist, it
/// is created with new keys, readable by its owner only, and the public key is printed. Throws
/// Error.
link::CurveKeys curve_keys(const std::string& path, Console& console) {
  if (!std::filesystem::exists(path)) return make_key_file(path, console);
  const InputFileKind kind{.name = "a file of two keys", .max_mib = 1, .remedy_if_larger = ""};
  std::istringstream file(read_input_file(path, kind));
  std::string first;
  std::string second;
  link::CurveKeys keys;
  constexpr std::size_t kLetters = 40;
  const bool is_read = file >> first >> keys.public_key >> second >> keys.secret_key &&
                       first == "public" && second == "secret" &&
                       keys.public_key.size() == kLetters && keys.secret_key.size() == kLetters;
  if (is_read) return keys;
  throw Error({.where = "--curve-keys, " + path,
               .found = "no keys",
               .allowed = "two lines, 'public KEY' and 'secret KEY', with 40 letters of Z85 each",
               .remedy = "name a file that does not exist: it is created with new keys"});
}

lockstep::ServerOptions server_options(const StreamFlags& flags, Console& console) {
  lockstep::ServerOptions options{.endpoint = link::parse_endpoint(flags.lockstep),
                                  .limits = flags.limits};
  if (!flags.curve_keys.empty()) options.curve = curve_keys(flags.curve_keys, console);
  return options;
}

std::vector<double> json_of(const Pose& pose) {
  const PoseVector numbers = to_xyz_wxyz(pose);
  return {numbers.begin(), numbers.end()};
}

[[noreturn]] void refuse_request(std::string where, std::string found, std::string allowed) {
  throw Error({"request, " + std::move(where), std::move(found), std::move(allowed)});
}

}  // namespace

LockstepRun::LockstepRun(const StreamFlags& flags, Console& console)
    : flags_(flags),
      console_(console),
      errors_(console.report()),
      server_(context_, server_options(flags, console), errors_) {
  if (!flags_.stats.empty()) stats_file_ = std::make_unique<AtomicFile>(flags_.stats);
  if (!flags_.record.empty()) {
    recorder_ = std::make_unique<Recorder>(flags_.record, flags_.is_durable);
  }
  prepare_scene(flags_.render, {}, console_, prepared_);
  (void)reserved_files(flags_, prepared_.files);
  if (recorder_) recorder_->begin(prepared_, flags_.command);
  frame_s_.resize(prepared_.sensors.size());
}

int LockstepRun::run() {
  const StopRequest stop;
  if (!flags_.render.quiet) print("listening at {}\n", server_.socket().bound_to());
  std::fflush(stdout);  // scripts wait for this line
  try {
    while (!stop.is_requested()) serve(stop);
  } catch (const std::exception& error) {
    recorder_.reset();  // incomplete
    finish(error.what());
    throw;
  }
  stop.disarm();
  for (const Job& job : std::exchange(jobs_, {})) {
    server_.reply_error(job.to, "request: GLIDAR was stopped by a signal");
  }
  finish(signal_text(stop.signal()));
  constexpr int kSignalExitBase = 128;  // as in shells
  return kSignalExitBase + stop.signal();
}

/// Receives the next request and continues an open one, in turn; waits if there is none.
void LockstepRun::serve(const StopRequest& stop) {
  if (std::optional<lockstep::Received> received = server_.receive()) start(std::move(*received));
  if (jobs_.empty()) {
    link::wait_for({&server_.socket()}, stop.descriptor(), server_.poll_timeout());
    return;
  }
  Job job = std::move(jobs_.front());
  jobs_.pop_front();
  const Step progress = try_advance(job);
  if (progress == Step::answered) return record(job);
  jobs_.push_back(std::move(job));
  constexpr std::chrono::milliseconds kForMemory{5};
  if (progress == Step::waits_for_memory) link::wait_for({}, stop.descriptor(), kForMemory);
}

void LockstepRun::start(lockstep::Received received) {
  const lockstep::ReplyTo to = std::move(received.to);
  try {
    auto* const measure = std::get_if<lockstep::Measure>(&received.request);
    if (measure == nullptr) return server_.reply_description(to, description().dump());
    const std::int64_t bytes = check(*measure);
    jobs_.push_back({.measure = std::move(*measure), .to = to, .bytes = bytes});
  } catch (const std::exception& error) {
    server_.reply_error(to, error.what());
  }
}

/// Errors in a request are returned to its client.
LockstepRun::Step LockstepRun::try_advance(Job& job) {
  try {
    return advance(job);
  } catch (const std::bad_alloc&) {
    server_.reply_error(job.to, "request: needs more memory than available; request fewer moments");
  } catch (const std::exception& error) {
    server_.reply_error(job.to, error.what());
  }
  job.frames.clear();
  return Step::answered;
}

LockstepRun::Step LockstepRun::advance(Job& job) {
  if (!server_.is_wanted(job.to)) {
    server_.drop(job.to);
    job.frames.clear();
    return Step::answered;
  }
  check_deadline(job);
  if (!server_.reserve(job.to, job.bytes)) return Step::waits_for_memory;
  const std::span<const lockstep::Moment> all = job.measure.moments;
  const std::size_t first = job.replies.size();
  const std::size_t count = std::min(frames_at_once(job), all.size() - first);
  const auto begin = std::chrono::steady_clock::now();
  measure_some(job, all.subspan(first, count));
  frame_s_[job.measure.sensor] = seconds_since(begin) / static_cast<double>(count);
  if (first + count < all.size()) return Step::in_progress;
  server_.reply(job.to, job.replies);
  return Step::answered;
}

/// Records the frames of a reply. An error ends the server, because the recording would be
/// incomplete.
void LockstepRun::record(const Job& job) {
  if (!recorder_) return;
  for (const link::RecordedFrame& frame : job.frames) recorder_->write(frame);
}

void LockstepRun::check_deadline(const Job& job) const {
  const link::Limits& limits = flags_.limits;
  if (std::chrono::steady_clock::now() - job.to.since <= std::chrono::seconds(limits.request_s)) {
    return;
  }
  throw Error({"request, time",
               fmt::format("{} of {} moments are measured after {} s", job.replies.size(),
                           job.measure.moments.size(), limits.request_s),
               limit_text(limits, &link::Limits::request_s),
               "request fewer moments at once, or start GLIDAR with a higher limit"});
}

/// A batch of small frames takes less time than single frames, but delays other requests and
/// signals.
std::size_t LockstepRun::frames_at_once(const Job& job) const {
  constexpr double kMaxFrames = 32.0;
  constexpr double kMaxBeams = 1 << 20;  // limits the memory of large frames
  constexpr double kMax_s = 0.1;
  const double frame_s = frame_s_[job.measure.sensor];
  if (frame_s == 0.0) return 1;
  const auto beams = static_cast<double>(prepared_.sensors[job.measure.sensor].beams.size());
  const double frames = std::min({kMaxFrames, kMaxBeams / beams, kMax_s / frame_s});
  return static_cast<std::size_t>(std::max(1.0, frames));
}

nlohmann::ordered_json LockstepRun::description() const {
  nlohmann::ordered_json objects = nlohmann::ordered_json::array();
  for (const Instance& instance : prepared_.scene.instances) {
    objects.push_back({{"name", instance.name},
                       {"id", instance.id},
                       {"class", prepared_.scene.class_names.at(instance.class_id)},
                       {"world_from_object", json_of(instance.world_from_object)}});
  }
  nlohmann::ordered_json sensors = nlohmann::ordered_json::array();
  for (const ActiveSensor& active : prepared_.sensors) {
    sensors.push_back({{"name", active.name.empty() ? active.sensor.name : active.name},
                       {"rows", active.beams.rows},
                       {"cols", active.beams.cols},
                       {"returns", active.beams.returns},
                       {"rate_hz", active.sensor.rate_hz},
                       {"frame_id", active.beams.frame_id},
                       {"world_from_sensor",
                        json_of(pose_at(active.motion.world_from_sensor, prepared_.start_ns))},
                       {"rig_from_sensor", json_of(active.rig_from_sensor)}});
  }
  return {{"sensors", sensors},
          {"world_from_rig", json_of(pose_at(prepared_.motion.world_from_rig, prepared_.start_ns))},
          {"objects", objects},
          {"columns",
           std::vector<std::string>(cloud_column_names().begin(), cloud_column_names().end())}};
}

/// Returns the size of the reply.
std::int64_t LockstepRun::check(const lockstep::Measure& measure) const {
  const std::size_t sensors = prepared_.sensors.size();
  if (measure.sensor >= sensors) {
    refuse_request("sensor", std::to_string(measure.sensor),
                   sensors == 1 ? "0: there is one"
                                : fmt::format("0 to {}, a sensor on the rig", sensors - 1));
  }
  const std::size_t objects = measure.moments.front().objects.size();
  const std::size_t instances = prepared_.scene.instances.size();
  if (objects != 0 && objects != instances) {
    refuse_request("number of objects", std::to_string(objects),
                   fmt::format("{}, one for each object of the scene, or 0", instances));
  }
  const auto& columns = measure.columns;
  if (measure.drop_invalid && std::find(columns.begin(), columns.end(), "xyz") == columns.end()) {
    refuse_request("flags", "drop_invalid, without the column xyz", "xyz among the columns");
  }
  check_columns(prepared_.sensors[measure.sensor].sensor, columns);
  const std::size_t points = prepared_.sensors[measure.sensor].beams.size();
  const std::int64_t bytes = reply_bytes(columns, points, measure.moments.size());
  const link::Limits& limits = flags_.limits;
  if (bytes > link::bytes_of_mib(std::min(limits.reply_mib, limits.memory_mib))) {
    constexpr double kMib = 1 << 20;
    throw Error(
        {"request, size of the reply",
         fmt::format("up to {:.1f} MiB: {} clouds of {} points", static_cast<double>(bytes) / kMib,
                     measure.moments.size(), points),
         limit_text(limits, limits.reply_mib <= limits.memory_mib ? &link::Limits::reply_mib
                                                                  : &link::Limits::memory_mib),
         "request fewer moments or columns at once, or start GLIDAR with a higher limit"});
  }
  return bytes;
}

void LockstepRun::measure_some(Job& job, std::span<const lockstep::Moment> moments) {
  const lockstep::Measure& measure = job.measure;
  const ActiveSensor& active = prepared_.sensors[measure.sensor];
  Simulator& simulator = *active.simulator;
  std::vector<std::shared_ptr<const Beams>> beams;
  std::vector<Motion> motions;
  if (frames_.size() < moments.size()) frames_.resize(moments.size());
  const std::span<Frame> frames = std::span(frames_).first(moments.size());
  for (std::size_t i = 0; i < moments.size(); ++i) {
    const lockstep::Moment& moment = moments[i];
    beams.push_back(simulator.beams(moment.number));
    motions.push_back(motion_of(motion_at(moment, prepared_), active));
    frames[i].stamp_ns = moment.t_ns;
    frames[i].seed = moment.seed;
    frames[i].number = moment.number;
    frames[i].sensor_id = active.id;
  }
  simulator.simulate_batch(motions, glidar::hit_columns_for(measure.columns), frames);
  for (std::size_t i = 0; i < moments.size(); ++i) {
    if (recorder_) job.frames.push_back(line_of(measure.sensor, frames[i], &moments[i]));
    job.replies.push_back(cloud_of(measure, frames[i], *beams[i]));
  }
}

lockstep::CloudReply LockstepRun::cloud_of(const lockstep::Measure& measure, const Frame& frame,
                                           const Beams& beams) {
  const OutputFlags& output = flags_.render.output;
  const std::string axes_name = output.frame.empty() ? "sensor" : output.frame;
  OutputFrame axes = output_frame(axes_name, beams, frame.world_from_sensor);
  axes.deskew = output.deskew;
  axes.thread_pool = &prepared_.renderer->thread_pool();
  std::shared_ptr<PointCloud> cloud = clouds_.take();
  make_point_cloud(frame, beams, prepared_.scene, axes, measure.columns, *cloud);
  if (measure.drop_invalid) {
    const std::shared_ptr<PointCloud> hits = clouds_.take();
    remove_invalid_points(*cloud, *hits);
    cloud = hits;
  }
  return {.head = {.stamp_ns = frame.stamp_ns,
                   .seed = frame.seed,
                   .number = frame.number,
                   .rows = cloud->rows,
                   .cols = cloud->cols,
                   .frame_id = cloud->frame_id,
                   .world_from_cloud = cloud->world_from_cloud},
          .cloud = cloud};
}

void LockstepRun::finish(const std::string& ending) {
  errors_.flush();
  const lockstep::Server::Counts& counts = server_.counts();
  if (recorder_) recorder_->commit();  // before the statistics, for which the disk may be full
  if (stats_file_) {
    const nlohmann::ordered_json text = {{"ended_by", ending},
                                         {"requests", counts.received},
                                         {"refused", counts.refused},
                                         {"clouds", counts.clouds},
                                         {"held_bytes", server_.held_bytes()},
                                         {"kept_bytes", clouds_.kept_bytes()},
                                         {"errors", errors_.counts()}};
    stats_file_->write(text.dump(2) + "\n");
    stats_file_->commit();
  }
  if (flags_.render.quiet) return;
  print("{} requests, {} refused; {} clouds\n", counts.received, counts.refused, counts.clouds);
}

}  // namespace glidar::app
