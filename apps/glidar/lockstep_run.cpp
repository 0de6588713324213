// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/lockstep_run.hpp>

#include <apps/glidar/curve_keys.hpp>
#include <apps/glidar/placed_motion.hpp>
#include <glidar/core/error.hpp>
#include <glidar/simulate.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <exception>
#include <new>
#include <utility>
#include <variant>

namespace glidar::app {
namespace {

lockstep::ServerOptions server_options(const StreamFlags& flags, Console& console) {
  lockstep::ServerOptions options{.endpoint = link::parse_endpoint(flags.lockstep)};
  if (!flags.curve_keys.empty()) options.curve = curve_keys(flags.curve_keys, console);
  return options;
}

std::vector<double> json_of(const Pose& pose) {
  const PoseNumbers numbers = numbers_of(pose);
  return {numbers.begin(), numbers.end()};
}

[[noreturn]] void refuse(std::string where, std::string found, std::string allowed) {
  throw Error({"request, " + std::move(where), std::move(found), std::move(allowed), ""});
}

}  // namespace

LockstepRun::LockstepRun(const StreamFlags& flags, Console& console)
    : flags_(flags),
      console_(console),
      faults_(console.report()),
      server_(context_, server_options(flags, console), faults_) {
  if (!flags_.stats.empty()) stats_file_ = std::make_unique<AtomicFile>(flags_.stats);
  if (!flags_.record.empty()) recorder_ = std::make_unique<Recorder>(flags_.record);
  open(flags_.render, {}, console_, session_);
  (void)taken_files(flags_, session_.files);
  if (recorder_) recorder_->begin(session_, flags_.command);
  for (const Mount& mount : session_.mounts) {
    beams_.push_back(std::make_shared<const Beams>(mount.beams));
  }
}

int LockstepRun::run() {
  const StopRequest stop;
  if (!flags_.render.quiet) fmt::print("listening at {}\n", server_.socket().bound_to());
  std::fflush(stdout);  // who started it waits for this line
  try {
    while (!stop.is_asked()) serve(stop);
  } catch (const std::exception& error) {
    recorder_.reset();  // it is not whole
    finish(error.what());
    throw;
  }
  finish(fmt::format("signal {}", stop.signal()));
  constexpr int kSignalled = 128;  // as shells have it
  return kSignalled + stop.signal();
}

/// Answers the next request, or waits a while for one.
void LockstepRun::serve(const StopRequest& stop) {
  constexpr std::chrono::milliseconds kPatience{1000};
  const std::optional<lockstep::Request> request = server_.receive();
  if (!request) return link::wait_for({&server_.socket()}, stop.descriptor(), kPatience);
  answer(*request);
  record();
}

/// The frames that were replied. A recording that cannot go on ends the server: it would not be
/// one.
void LockstepRun::record() {
  if (!recorder_) return;
  for (const link::RecordedFrame& frame : std::exchange(measured_, {})) recorder_->write(frame);
}

/// Whatever goes wrong with one request is its client's to know.
void LockstepRun::answer(const lockstep::Request& request) {
  const std::uint64_t id = std::visit([](const auto& kind) { return kind.id; }, request);
  try {
    if (const auto* wanted = std::get_if<lockstep::Measure>(&request)) return measure(*wanted);
    describe(std::get<lockstep::Describe>(request));
  } catch (const std::bad_alloc&) {
    measured_.clear();
    server_.reply_error(id, "request: needs more memory than there is; ask for fewer moments");
  } catch (const std::exception& error) {
    measured_.clear();
    server_.reply_error(id, error.what());
  }
}

void LockstepRun::describe(const lockstep::Describe& describe) {
  nlohmann::ordered_json objects = nlohmann::ordered_json::array();
  for (const Instance& instance : session_.scene.instances) {
    objects.push_back({{"name", instance.name},
                       {"id", instance.id},
                       {"class", session_.scene.class_names.at(instance.class_id)},
                       {"world_from_object", json_of(instance.world_from_object)}});
  }
  nlohmann::ordered_json sensors = nlohmann::ordered_json::array();
  for (const Mount& mount : session_.mounts) {
    sensors.push_back({{"name", mount.name.empty() ? mount.sensor.name : mount.name},
                       {"rows", mount.beams.rows},
                       {"cols", mount.beams.cols},
                       {"returns", mount.beams.returns},
                       {"rate_hz", mount.sensor.rate_hz},
                       {"frame_id", mount.beams.frame_id},
                       {"world_from_sensor", json_of(pose_at(mount.motion.world_from_sensor, 0))},
                       {"rig_from_sensor", json_of(mount.rig_from_sensor)}});
  }
  const nlohmann::ordered_json text = {
      {"sensors", sensors},
      {"world_from_rig", json_of(pose_at(session_.motion.world_from_rig, 0))},
      {"objects", objects},
      {"columns",
       std::vector<std::string>(cloud_column_names().begin(), cloud_column_names().end())}};
  server_.reply_description(describe.id, text.dump());
}

void LockstepRun::check(const lockstep::Measure& measure) const {
  const std::size_t sensors = session_.mounts.size();
  if (measure.sensor >= sensors) {
    refuse("sensor", std::to_string(measure.sensor),
           sensors == 1 ? "0: there is one"
                        : fmt::format("0 to {}, a sensor on the rig", sensors - 1));
  }
  const std::size_t objects = measure.moments.front().objects.size();
  const std::size_t instances = session_.scene.instances.size();
  if (objects != 0 && objects != instances) {
    refuse("number of objects", std::to_string(objects),
           fmt::format("{}, one for each object of the scene, or 0", instances));
  }
  const auto& columns = measure.columns;
  if (measure.hits_only && std::find(columns.begin(), columns.end(), "xyz") == columns.end()) {
    refuse("flags", "hits only, without the column xyz", "xyz among the columns");
  }
}

void LockstepRun::measure(const lockstep::Measure& measure) {
  constexpr std::size_t kTogether = 32;  // frames that are held at a time
  check(measure);
  measured_.clear();
  std::vector<lockstep::CloudReply> replies;
  const std::span<const lockstep::Moment> all = measure.moments;
  for (std::size_t first = 0; first < all.size(); first += kTogether) {
    measure_some(measure, all.subspan(first, std::min(kTogether, all.size() - first)), replies);
  }
  server_.reply(measure.id, replies);
}

std::shared_ptr<const Beams> LockstepRun::beams_of(std::uint32_t index,
                                                   std::uint32_t number) const {
  const Sensor& sensor = session_.mounts[index].sensor;
  if (number == 0 || std::holds_alternative<Pinhole>(sensor.optics)) return beams_[index];
  return std::make_shared<const Beams>(make_beams(sensor, scan_window(sensor, number)));
}

void LockstepRun::measure_some(const lockstep::Measure& measure,
                               std::span<const lockstep::Moment> moments,
                               std::vector<lockstep::CloudReply>& replies) {
  const Mount& mount = session_.mounts[measure.sensor];
  std::vector<std::shared_ptr<const Beams>> beams;
  std::vector<Motion> motions;
  std::vector<Setup> setups;
  if (frames_.size() < moments.size()) frames_.resize(moments.size());
  for (const lockstep::Moment& moment : moments) {
    beams.push_back(beams_of(measure.sensor, moment.number));
    motions.push_back(motion_of(motion_at(moment, session_), mount));
    Frame& frame = frames_[beams.size() - 1];
    frame.stamp_ns = moment.t_ns;
    frame.seed = moment.seed;
    frame.number = moment.number;
    frame.sensor_id = mount.id;
  }
  for (std::size_t i = 0; i < moments.size(); ++i) {
    setups.push_back({.scene = session_.scene,
                      .sensor = mount.sensor,
                      .beams = *beams[i],
                      .motion = motions[i],
                      .renderer = *session_.renderer});
    if (session_.paper) setups.back().paper.emplace(PaperTarget{.camera = *session_.paper});
  }
  simulate_batch(setups, glidar::fields_for(measure.columns),
                 std::span(frames_).first(moments.size()));
  for (std::size_t i = 0; i < moments.size(); ++i) {
    if (recorder_) measured_.push_back(line_of(measure.sensor, frames_[i], &moments[i]));
    replies.push_back(cloud_of(measure, frames_[i], *beams[i]));
  }
}

lockstep::CloudReply LockstepRun::cloud_of(const lockstep::Measure& measure, const Frame& frame,
                                           const Beams& beams) {
  const OutputFlags& output = flags_.render.output;
  CloudFrame axes = cloud_frame(output.cloud_frame, beams, frame.world_from_sensor);
  axes.deskew = output.deskew;
  axes.workers = &session_.renderer->workers();
  std::shared_ptr<PointCloud> cloud = clouds_.take();
  make_point_cloud(frame, beams, session_.scene, axes, measure.columns, *cloud);
  if (measure.hits_only) {
    const std::shared_ptr<PointCloud> hits = clouds_.take();
    compact(*cloud, *hits);
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
  faults_.flush();
  const lockstep::Server::Counts& counts = server_.counts();
  if (stats_file_) {
    const nlohmann::ordered_json text = {{"ended_by", ending},
                                         {"requests", counts.received},
                                         {"refused", counts.refused},
                                         {"clouds", counts.clouds},
                                         {"faults", faults_.counts()}};
    stats_file_->write(text.dump(2) + "\n");
    stats_file_->commit();
  }
  if (recorder_) recorder_->commit();
  if (flags_.render.quiet) return;
  fmt::print("{} requests, {} refused; {} clouds\n", counts.received, counts.refused,
             counts.clouds);
}

}  // namespace glidar::app
