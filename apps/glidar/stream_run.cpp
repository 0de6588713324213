// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/stream_run.hpp>

#include <apps/glidar/advice.hpp>
#include <apps/glidar/exit_code.hpp>
#include <apps/glidar/placed_motion.hpp>
#include <apps/glidar/recorded_source.hpp>
#include <apps/glidar/stream_report.hpp>
#include <glidar/core/error.hpp>
#include <glidar/io/sidecar.hpp>
#include <glidar/simulate.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>
#include <variant>

namespace glidar::app {
namespace {

const std::vector<std::string> kPublishedColumns = {"xyz", "intensity"};

/// How often the status line changes.
constexpr std::chrono::milliseconds kShow{200};

/// How often partners are looked after that are waited for.
constexpr std::chrono::milliseconds kLook{20};

/// Names the option in an error of a socket.
template <class Work>
void naming(const char* options, const Work& work) {
  try {
    work();
  } catch (const Error& error) {
    ErrorParts parts = error.parts();
    parts.where = std::string(options) + ", " + parts.where;
    throw Error(parts);
  }
}

/// Whether every frame has the same beams; those of scanners move on.
bool has_fixed_beams(const Sensor& sensor) {
  return std::holds_alternative<Pinhole>(sensor.optics);
}

/// Throws Error when a frame is not the one that was recorded.
void compare(const Shot& shot, const std::string& recording, std::uint64_t number) {
  if (frame_hash(shot.frame) == shot.frame_hash) return;
  throw Error({fmt::format("{}, frame {}", recording, number),
               "it comes out otherwise than when it was recorded",
               "the same models, scene and sensor files, and program as then", ""});
}

}  // namespace

StreamRun::StreamRun(StreamFlags flags, Console& console)
    : flags_(std::move(flags)),
      console_(console),
      faults_(console.report()),
      duration_s_(std::exchange(flags_.render.duration_s, std::nullopt)
                      .value_or(std::numeric_limits<double>::infinity())) {
  if (!flags_.stats.empty()) {
    naming("--stats", [&] { stats_file_ = std::make_unique<AtomicFile>(flags_.stats); });
  }
  if (!flags_.record.empty()) {
    naming("--record", [&] { recorder_ = std::make_unique<Recorder>(flags_.record); });
  }
  if (!flags_.replay.empty()) recording_ = std::make_unique<link::RecordingReader>(flags_.replay);
  if (flags_.port) {
    naming("--bind, --port", [&] {
      publisher_ =
          std::make_unique<legacy::CloudPublisher>(context_, publisher_options(flags_), faults_);
    });
  }
  open_session();
  if (recorder_) recorder_->begin(session_, flags_.command);
  if (flags_.physics_port && !recording_) {
    prepare_poses();
    naming("--physics-host, --physics-port", [&] {
      receiver_ =
          std::make_unique<legacy::PoseReceiver>(context_, receiver_options(flags_), faults_);
    });
  }
}

void StreamRun::open_session() {
  const Sensor unknown;
  const Beams none;
  std::vector<Output> outputs;
  if (writes_files()) outputs = plan(numbered(flags_.render.output, 0), unknown, none);
  open(
      flags_.render, [&] { protect_files(session_.files, outputs); }, console_, session_);
  for (const Mount& mount : session_.mounts) {
    beams_.push_back(std::make_shared<const Beams>(mount.beams));
  }
  std::vector<std::string> columns;
  if (publisher_) {
    columns = kPublishedColumns;
    publisher_->set_topics(topics());
  }
  for (const Output& output : outputs) {
    columns.insert(columns.end(), output.columns.begin(), output.columns.end());
  }
  fields_ = glidar::fields_for(columns);
}

/// 2015's topic where there is one sensor, one for each on a rig.
std::map<std::uint32_t, std::string> StreamRun::topics() const {
  std::map<std::uint32_t, std::string> topics;
  if (session_.mounts.size() == 1) return topics;
  for (const Mount& mount : session_.mounts) topics[mount.id] = legacy::rig_topic(mount.name);
  return topics;
}

/// The scene as it stands becomes the object that the simulator moves.
void StreamRun::prepare_poses() {
  moved_scene_.object_from_instance.clear();
  for (const Trajectory& trajectory : session_.motion.world_from_instance) {
    if (!std::holds_alternative<ConstantPose>(trajectory)) {
      throw Error({.where = "--physics-port",
                   .found = "the scene file moves its objects",
                   .allowed = "",
                   .remedy = "let either the simulator or the scene file move things"});
    }
    moved_scene_.object_from_instance.push_back(std::get<ConstantPose>(trajectory).pose);
  }
  const Mount& first = session_.mounts.front();
  if (!first.name.empty() || !looks_along_z(first.beams)) {
    moved_scene_.optical_from_rig = optical_from_body();
  }
  if (!flags_.render.pose.model_q.empty() || !flags_.render.pose.model_r.empty()) {
    // as in 2015, where the first message replaced it
    for (Pose& pose : moved_scene_.object_from_instance) pose = Pose::Identity();
  }
  if (sensor_pose_given(flags_.render.pose)) {
    console_.info("the simulator says where the sensor is; the options for that do not count");
  }
}

std::unique_ptr<PoseSource> StreamRun::make_source(const StopRequest& stop) {
  Pace pace = {.frames = flags_.frames.value_or(std::numeric_limits<std::uint64_t>::max()),
               .duration_s = duration_s_};
  if (recording_) {
    pace.rate_hz = flags_.replay_rate_hz.value_or(0.0);
    return std::make_unique<RecordedSource>(*recording_, pace, session_, stop);
  }
  if (receiver_) {
    pace.rate_hz = flags_.render.sensor.rate_hz.value_or(0.0);
    return std::make_unique<SimulatorSource>(
        *receiver_, moved_scene_,
        SimulatorSource::Options{
            .pace = pace, .timeout_s = flags_.pose_timeout_s, .mounts = session_.mounts.size()},
        stop);
  }
  std::vector<double> periods_s;
  for (const Mount& mount : session_.mounts) periods_s.push_back(1.0 / mount.sensor.rate_hz);
  if (!flags_.is_unpaced) pace.rate_hz = session_.mounts.front().sensor.rate_hz;
  return std::make_unique<MotionSource>(pace, std::move(periods_s), stop);
}

int StreamRun::run() {
  StopRequest stop;
  try {
    const std::unique_ptr<PoseSource> source = make_source(stop);
    if (wait_for_partners(stop)) stream(*source, stop);
    if (const auto* motion = dynamic_cast<const MotionSource*>(source.get())) {
      late_ = motion->late();
    }
    const auto* simulator = dynamic_cast<const SimulatorSource*>(source.get());
    exit_code_ = simulator != nullptr && simulator->has_timed_out() ? kNoPoses : kDone;
    constexpr int kSignalled = 128;  // as shells have it
    if (stop.is_asked()) exit_code_ = kSignalled + stop.signal();
    finish(stop.is_asked() ? fmt::format("signal {}", stop.signal()) : source->ending());
  } catch (const std::exception& error) {
    finish(error.what());
    throw;
  }
  return exit_code_;
}

bool StreamRun::has_partners() {
  if (publisher_) publisher_->serve();
  const bool has_simulator = !receiver_ || receiver_->is_ready();
  return has_simulator && (!publisher_ || publisher_->has(flags_.subscribers));
}

bool StreamRun::wait_for_partners(const StopRequest& stop) {
  bool is_told = false;
  while (!has_partners() && !stop.is_asked()) {
    if (!std::exchange(is_told, true)) console_.info(waiting_text(flags_));
    link::wait_for({publisher_ ? &publisher_->handshake_socket() : nullptr,
                    receiver_ ? &receiver_->handshake_socket() : nullptr},
                   stop.descriptor(), kLook);
  }
  return !stop.is_asked();
}

void StreamRun::stream(PoseSource& source, StopRequest& stop) {
  stats_ = {};
  Delivery delivery([this](const Shot& shot) { deliver(shot); }, [this] { look_after_peers(); },
                    [&stop] { stop.ask(); });
  while (!stop.is_asked()) {
    const std::optional<Moment> moment = source.next();
    if (!moment) break;
    if (moment->motion) move(*moment->motion);
    if (!is_wanted(moment->number)) continue;
    measure(*moment, delivery.room());
    delivery.hand_over();
  }
  delivery.finish();
}

void StreamRun::move(const RigMotion& motion) {
  for (Mount& mount : session_.mounts) mount.motion = motion_of(motion, mount);
  if (recorder_) placed_ = std::make_shared<const lockstep::Moment>(placed_by(motion));
}

void StreamRun::measure(const Moment& moment, Shot& shot) {
  const Mount& mount = session_.mounts[moment.mount];
  std::shared_ptr<const Beams>& beams = beams_[moment.mount];
  const ScanWindow window = scan_window(mount.sensor, moment.number);
  if (moment.number > 0 && !has_fixed_beams(mount.sensor)) {
    beams = std::make_shared<const Beams>(make_beams(mount.sensor, window));
  }
  shot.beams = beams;
  shot.mount = moment.mount;
  shot.placed = placed_;
  shot.frame_hash = moment.frame_hash;
  shot.due = moment.due;
  shot.frame.number = moment.number;
  shot.frame.sensor_id = mount.id;
  shot.frame.stamp_ns = moment.stamp_ns.value_or(window.start_ns);
  shot.frame.seed = moment.seed.value_or(flags_.render.seed);
  Setup setup{.scene = session_.scene,
              .sensor = mount.sensor,
              .beams = *beams,
              .motion = mount.motion,
              .renderer = *session_.renderer};
  if (session_.paper) setup.paper.emplace(PaperTarget{.camera = *session_.paper});
  simulate(setup, fields_, shot.frame);
  if (measured_++ > 0) return;
  tell(view_advice({session_.scene, mount.sensor, *beams, shot.frame}), console_);
}

bool StreamRun::is_wanted(std::uint32_t number) const {
  return recording_ || writes_files() || (publisher_ && publisher_->wants(number));
}

bool StreamRun::writes_files() const {
  const OutputFlags& files = flags_.render.output;
  return !files.paths.empty() || !files.legacy_name.empty();
}

std::vector<Output> StreamRun::plan(const OutputFlags& files, const Sensor& sensor,
                                    const Beams& beams) {
  return plan_outputs(files, flags_.render.input,
                      {.scene = session_.scene,
                       .sensor = sensor,
                       .beams = beams,
                       .renderer = renderer_name(flags_.render)},
                      console_.report());
}

void StreamRun::deliver(const Shot& shot) {
  if (recorder_) recorder_->note(shot.mount, shot.frame, shot.placed.get());
  if (!shot.frame_hash.empty()) compare(shot, flags_.replay, stats_.latency.count());
  if (publisher_ && publisher_->wants(shot.frame.number)) publish(shot);
  if (writes_files()) write_files(shot);
  stats_.note(shot.due);
}

void StreamRun::publish(const Shot& shot) {
  make_point_cloud(shot.frame, *shot.beams, session_.scene,
                   cloud_frame("legacy", *shot.beams, shot.frame.world_from_sensor),
                   kPublishedColumns, cloud_);
  publisher_->write(cloud_, shot.frame);
}

void StreamRun::write_files(const Shot& shot) {
  const Mount& mount = session_.mounts[shot.mount];
  OutputFlags files = flags_.render.output;
  if (session_.mounts.size() > 1) files = labelled(files, mount.name);
  const std::vector<Output> outputs =
      plan(numbered(files, shot.frame.number), mount.sensor, *shot.beams);
  protect_files(session_.files, outputs);
  write_outputs(outputs, shot.frame, *shot.beams, session_.scene);
}

void StreamRun::look_after_peers() {
  if (publisher_) publisher_->serve();
  const auto now = StreamStats::Clock::now();
  if (now - shown_ < kShow) return;
  shown_ = now;
  console_.status(status_text(stats_) + (publisher_ ? publishing_text(publisher_->counts()) : ""));
}

void StreamRun::finish(const std::string& ending) {
  console_.status("");
  if (publisher_) publisher_->shut_down();
  faults_.flush();
  StreamSummary summary{.stats = stats_,
                        .ending = ending,
                        .measured = measured_,
                        .late = late_,
                        .faults = faults_.counts()};
  if (publisher_) summary.clouds = publisher_->counts();
  if (receiver_) summary.poses = receiver_->counts();
  if (recorder_) recorder_->commit();
  if (stats_file_) {
    stats_file_->write(json_text(summary));
    stats_file_->commit();
  }
  if (!flags_.render.quiet) fmt::print("{}", summary_text(summary));
}

}  // namespace glidar::app
