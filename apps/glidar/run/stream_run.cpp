// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/stream_run.hpp>

#include <apps/glidar/options/option_values.hpp>
#include <apps/glidar/options/stream_options.hpp>
#include <apps/glidar/run/advice.hpp>
#include <apps/glidar/run/console.hpp>
#include <apps/glidar/run/interrupt.hpp>
#include <apps/glidar/run/live_view.hpp>
#include <apps/glidar/run/outputs.hpp>
#include <apps/glidar/run/placement.hpp>
#include <apps/glidar/run/pose_source.hpp>
#include <apps/glidar/run/recorded_command.hpp>
#include <apps/glidar/run/stream_report.hpp>
#include <glidar/core/error.hpp>
#include <glidar/core/report.hpp>
#include <glidar/io/files/atomic_file.hpp>
#include <glidar/io/formats/sidecar.hpp>
#include <glidar/link/recording.hpp>
#include <glidar/woods2016/protocol.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <exception>
#include <limits>
#include <utility>
#include <variant>

namespace glidar::app {
namespace {

using Clock = std::chrono::steady_clock;

/// How fast the frames of a recording follow.
enum class ReplayPace : std::uint8_t {
  schedule,  ///< at the rate of the schedule
  stamps,    ///< as the frames were measured, by their stamps
};

/// The frames of a recording, in its order.
class RecordedSource final : public PoseSource {
 public:
  struct Options {
    FrameSchedule schedule;
    ReplayPace pace = ReplayPace::schedule;
    /// Commands of a viewer, who may also look at the last frame until a stop is requested;
    /// nullptr: none.
    Playback* playback = nullptr;
  };
  /// All must outlive it.
  RecordedSource(link::RecordingReader& recording, const Options& options,
                 const PreparedScene& prepared, const StopRequest& stop);
  std::optional<FrameRequest> next() override;
  [[nodiscard]] std::string ending() const override { return ending_; }

 private:
  std::optional<link::RecordedFrame> read();
  [[nodiscard]] std::chrono::duration<double> period(std::int64_t t_ns) const;
  void wait_until_due(std::int64_t t_ns);

  link::RecordingReader& recording_;
  Options options_;
  const PreparedScene& prepared_;
  const StopRequest& stop_;
  std::optional<Clock::time_point> due_;
  std::int64_t last_ns_ = 0;                 ///< stamp of the last frame
  std::uint64_t number_ = 0;                 ///< of the next frame
  std::vector<std::uint64_t> next_indices_;  ///< of each sensor's next frame
  std::string ending_;
};

/// Throws Error unless the frame fits the scene.
void require_fitting(const link::RecordedFrame& frame, std::uint64_t number,
                     const PreparedScene& prepared) {
  const std::size_t objects = frame.moment.objects.size();
  const std::size_t instances = prepared.scene.instances.size();
  const bool fits = frame.sensor < prepared.sensors.size() &&
                    (!frame.is_placed || objects == 0 || objects == instances);
  if (fits) return;
  throw Error(
      {"recording, frame " + std::to_string(number),
       "sensor " + std::to_string(frame.sensor) + " and " + std::to_string(objects) + " objects",
       std::to_string(prepared.sensors.size()) + " sensors and " + std::to_string(instances) +
           " objects, which the scene has",
       "replay it with the scene that it was recorded with"});
}

RecordedSource::RecordedSource(link::RecordingReader& recording, const Options& options,
                               const PreparedScene& prepared, const StopRequest& stop)
    : recording_(recording),
      options_(options),
      prepared_(prepared),
      stop_(stop),
      next_indices_(prepared.sensors.size()) {}

/// The next frame; empty at the end, of which `ending_` states why.
std::optional<link::RecordedFrame> RecordedSource::read() {
  if (number_ >= options_.schedule.frames) {
    ending_ = "all frames are done";
    return std::nullopt;
  }
  std::optional<link::RecordedFrame> frame = recording_.next();
  if (!frame) ending_ = "the recording is complete";
  return frame;
}

std::optional<FrameRequest> RecordedSource::next() {
  std::optional<link::RecordedFrame> frame = read();
  if (!frame && options_.playback != nullptr) {
    while (!stop_.is_requested()) stop_.wait_until(Clock::now() + std::chrono::hours(1));
  }
  if (!frame) return std::nullopt;
  require_fitting(*frame, number_, prepared_);
  if (options_.playback != nullptr && !options_.playback->wait(stop_)) return std::nullopt;
  wait_until_due(frame->moment.t_ns);
  if (stop_.is_requested()) return std::nullopt;
  ++number_;
  FrameRequest moment{.sensor_index = frame->sensor,
                      .number = frame->moment.number,
                      .index = next_indices_[frame->sensor]++,
                      .due = *due_,
                      .motion = {},
                      .stamp_ns = frame->moment.t_ns,
                      .seed = frame->moment.seed,
                      .frame_hash = std::move(frame->frame_hash)};
  if (frame->is_placed) moment.motion = motion_at(frame->moment, prepared_);
  return moment;
}

/// From the last frame to this one.
std::chrono::duration<double> RecordedSource::period(std::int64_t t_ns) const {
  constexpr double kNanosecond_s = 1e-9;
  constexpr double kMax_s = 10.0;  // clients may give any time
  if (options_.pace == ReplayPace::stamps) {
    const double s = kNanosecond_s * (static_cast<double>(t_ns) - static_cast<double>(last_ns_));
    return std::chrono::duration<double>(std::clamp(s, 0.0, kMax_s));
  }
  const double rate_hz = options_.schedule.rate_hz;
  return std::chrono::duration<double>(rate_hz > 0.0 ? 1.0 / rate_hz : 0.0);
}

void RecordedSource::wait_until_due(std::int64_t t_ns) {
  const Clock::time_point now = Clock::now();
  const auto since_last = std::chrono::duration_cast<Clock::duration>(period(t_ns));
  last_ns_ = t_ns;
  due_ = due_ ? std::max(now, *due_ + since_last) : now;
  while (Clock::now() < *due_ && !stop_.is_requested()) stop_.wait_until(*due_);
}

/// The peers of a stream by the protocol of 2016; nullptr: none of this kind.
struct Peers {
  woods2016::CloudPublisher* publisher = nullptr;
  woods2016::PoseReceiver* receiver = nullptr;
};

enum class PeerWaitResult {
  complete,  ///< all have shaken hands
  stopped,   ///< by a signal
  timed_out  ///< the simulator has not shaken hands within --pose-timeout
};

/// How often the handshakes of peers are polled.
constexpr std::chrono::milliseconds kPeerPollInterval{20};

bool are_complete(const Peers& peers, std::uint64_t subscribers) {
  if (peers.publisher != nullptr) peers.publisher->serve();
  const bool has_simulator = peers.receiver == nullptr || peers.receiver->is_ready();
  return has_simulator && (peers.publisher == nullptr || peers.publisher->has(subscribers));
}

bool lacks_simulator(const Peers& peers, const StreamFlags& flags, double waited_s) {
  return peers.receiver != nullptr && !peers.receiver->is_ready() && flags.pose_timeout_s &&
         waited_s > *flags.pose_timeout_s;
}

/// Prints the number of subscribers when it changes.
void show_subscribers(const Peers& peers, std::uint64_t expected, std::uint64_t& shown,
                      Console& console) {
  const std::uint64_t ready = peers.publisher != nullptr ? peers.publisher->ready() : 0;
  if (expected == 0 || std::exchange(shown, ready) == ready) return;
  console.info(ready_text(ready, expected));
}

/// Waits for the handshakes of the simulator and of --subscribers; the console shows progress.
PeerWaitResult wait_for_peers(const Peers& peers, const StreamFlags& flags, const StopRequest& stop,
                              Console& console) {
  const auto begin = Clock::now();
  bool is_announced = false;
  std::uint64_t shown = 0;
  while (!are_complete(peers, flags.subscribers)) {
    if (stop.is_requested()) return PeerWaitResult::stopped;
    if (lacks_simulator(peers, flags, seconds_since(begin))) return PeerWaitResult::timed_out;
    if (!std::exchange(is_announced, true)) console.info(waiting_text(flags));
    show_subscribers(peers, flags.subscribers, shown, console);
    link::wait_for({peers.publisher != nullptr ? &peers.publisher->handshake_socket() : nullptr,
                    peers.receiver != nullptr ? &peers.receiver->handshake_socket() : nullptr},
                   stop.descriptor(), kPeerPollInterval);
  }
  return stop.is_requested() ? PeerWaitResult::stopped : PeerWaitResult::complete;
}

const std::vector<std::string> kPublishedColumns = {"xyz", "intensity"};

/// How often the status line changes.
constexpr std::chrono::milliseconds kStatusInterval{200};

woods2016::CloudPublisherOptions publisher_options(const StreamFlags& flags) {
  return {.endpoint = {flags.bind, *flags.port},
          .keeps_newest = flags.publishes_latest,
          .queue = flags.publish_queue,
          .every = flags.publish_every,
          .limits = flags.limits,
          .timestamps =
              flags.pose_source ? woods2016::Timestamps::of_poses : woods2016::Timestamps::counted,
          .subscription_timeout = std::chrono::round<std::chrono::milliseconds>(
              std::chrono::duration<double>(flags.subscription_timeout_s))};
}

woods2016::PoseReceiverOptions receiver_options(const StreamFlags& flags) {
  return {.endpoint = *flags.pose_source, .queue = flags.pose_queue};
}

/// Throws Error when a frame is not the one that was recorded.
void require_recorded(const MeasuredFrame& measured, const std::string& recording,
                      std::uint64_t number) {
  if (frame_hash(measured.frame) == measured.frame_hash) return;
  throw Error({fmt::format("{}, frame {}", recording, number),
               "the repeated frame differs from the recorded one",
               "the same models, scene and sensor files, and the same program"});
}

}  // namespace

StreamRun::StreamRun(StreamFlags flags, Console& console)
    : flags_(std::move(flags)),
      console_(console),
      errors_(console.report()),
      duration_s_(std::exchange(flags_.render.duration_s, std::nullopt)
                      .value_or(std::numeric_limits<double>::infinity())) {
  if (!flags_.stats.empty()) {
    with_option_name("--stats", [&] { stats_file_ = std::make_unique<AtomicFile>(flags_.stats); });
  }
  if (!flags_.record.empty()) {
    with_option_name("--record", [&] {
      recorder_ = std::make_unique<Recorder>(flags_.record, flags_.is_durable);
    });
  }
  if (!flags_.replay.empty()) recording_ = std::make_unique<link::RecordingReader>(flags_.replay);
  if (flags_.port) {
    with_option_name("--bind, --port", [&] {
      publisher_ =
          std::make_unique<woods2016::CloudPublisher>(context_, publisher_options(flags_), errors_);
    });
  }
  if (flags_.foxglove) {
    with_option_name("--foxglove", [&] {
      if (recording_) playback_ = std::make_unique<Playback>();
      live_view_ = std::make_unique<LiveView>(*flags_.foxglove, playback_.get(), errors_);
      console_.info("live view: " + live_view_->url());
    });
  }
  if (uses_ros2(flags_.ros2)) {
    with_option_name(flags_.ros2.publishes ? "--ros2" : "--pose-source",
                     [&] { ros2_ = std::make_unique<Ros2Link>(flags_.ros2, errors_); });
  }
  open_scene();
  if (recorder_) recorder_->begin(prepared_, flags_.command);
  if (flags_.pose_source && !recording_) {
    prepare_poses();
    with_option_name("--pose-source", [&] {
      receiver_ =
          std::make_unique<woods2016::PoseReceiver>(context_, receiver_options(flags_), errors_);
    });
  }
}

void StreamRun::open_scene() {
  const bool is_live = flags_.ros2.publishes || !flags_.udp.empty() || flags_.foxglove;
  if (is_live && flags_.render.motion.stamp_origin == StampOrigin::outputs)
    flags_.render.motion.stamp_origin = StampOrigin::date;
  OutputFlags& files = flags_.render.output;
  files.input = flags_.render.input;
  std::vector<std::filesystem::path> first;  // files of the first frame, to report errors early
  if (!flags_.foxglove && !flags_.ros2.publishes) check_layout(files);
  if (has_outputs(files)) first = check_frame_files(numbered(files, 0));
  prepare_scene(
      flags_.render,
      [&] {
        for (const std::filesystem::path& file : first)
          refuse_overwrite_of_inputs(prepared_.files, file);
      },
      console_, prepared_);
  set_start_time(prepared_.recorded_start, flags_.command);
  duration_s_ = prepared_.duration_s.value_or(duration_s_);
  const LiveOutputs live{.topics = flags_.ros2.publishes,
                         .packets = !flags_.udp.empty(),
                         .viewers = flags_.foxglove.has_value(),
                         .record = !flags_.record.empty()};
  refuse_unused_output_options(flags_.render.output, prepared_, live);
  // a replay may have other outputs than the run that was recorded
  if (!recording_) refuse_unused_imu(flags_.render, prepared_, live, pose_origin(flags_));
  for (const ActiveSensor& active : prepared_.sensors) {
    motions_.push_back(std::make_shared<const Motion>(active.motion));
    if (has_pose_source(flags_)) print_advice(velocity_advice(active.sensor), console_);
  }
  if (publisher_) publisher_->set_topics(topics());
  OutputRig rig = output_rig(flags_.render, prepared_, pose_origin(flags_));
  rig.inputs = reserved_files(flags_, prepared_.files);
  // otherwise the command does not contain the poses
  if (!has_pose_source(flags_) && flags_.replay.empty()) rig.command = flags_.command;
  open_outputs(rig);
}

void StreamRun::open_outputs(const OutputRig& rig) {
  const FrameFileRequest& files = flags_.render.output;
  if (live_view_) {
    live_view_->begin(flags_.render, prepared_, rig);
    outputs_.push_back(std::move(live_view_));
  }
  if (has_outputs(files))
    outputs_.push_back(
        std::make_unique<FrameFiles>(files, true, rig, Report{console_.report().log, {}}));
  for (auto& output : open_stream_outputs(flags_, rig, errors_, console_))
    outputs_.push_back(std::move(output));
  if (flags_.ros2.publishes)
    outputs_.push_back(
        ros2_->open(rig, files, time_speed(flags_, prepared_.sensors.front().sensor)));
  hit_columns_ = needed_hit_columns(outputs_, prepared_.sensors.size());
  if (publisher_) hit_columns_ = hit_columns_ | glidar::hit_columns_for(kPublishedColumns);
}

/// The original topic for one sensor, one topic per sensor for a rig.
std::map<std::uint32_t, std::string> StreamRun::topics() const {
  std::map<std::uint32_t, std::string> topics;
  for (const ActiveSensor& active : prepared_.sensors) {
    const std::string label = label_of(flags_.render, active);
    if (!label.empty()) topics[active.id] = woods2016::rig_topic(label);
  }
  if (topics.size() > 1 && flags_.publishes_latest) {
    throw Error({"--publish-latest",
                 "given for a rig, but only the newest cloud of one sensor would be kept", "",
                 "leave it out, or choose a sensor with --sensor-name"});
  }
  return topics;
}

/// The whole scene becomes the object that the simulator moves.
void StreamRun::prepare_poses() {
  moved_scene_.object_from_instance.clear();
  for (const Trajectory& trajectory : prepared_.motion.world_from_instance) {
    if (!std::holds_alternative<ConstantPose>(trajectory)) {
      throw Error({.where = "--pose-source",
                   .found = "the scene file moves its objects",
                   .remedy = "let either the simulator or the scene file move the objects"});
    }
    moved_scene_.object_from_instance.push_back(std::get<ConstantPose>(trajectory).pose);
  }
  if (!std::holds_alternative<ConstantPose>(prepared_.motion.world_from_rig)) {
    console_.info(
        "the simulator gives the sensor's pose; the scene file's motion of it is ignored");
  }
  const ActiveSensor& first = prepared_.sensors.front();
  if (!first.name.empty() || !looks_along_z(first.beams)) {
    moved_scene_.optical_from_rig = optical_from_body();
  }
  if (flags_.render.pose.model_q) {
    // as in the original GLIDAR, where the first message replaces it
    for (Pose& pose : moved_scene_.object_from_instance) pose = Pose::Identity();
  }
  if (sensor_pose_given(flags_.render.pose)) {
    console_.info("the simulator gives the sensor's pose; the options for it are ignored");
  }
}

std::unique_ptr<PoseSource> StreamRun::make_source(const StopRequest& stop) {
  FrameSchedule schedule = {
      .frames = flags_.frames.value_or(std::numeric_limits<std::uint64_t>::max()),
      .duration_s = duration_s_};
  if (recording_) {
    schedule.rate_hz = flags_.replay_rate_hz.value_or(0.0);
    const bool follows_stamps = playback_ && !flags_.replay_rate_hz;
    return std::make_unique<RecordedSource>(
        *recording_,
        RecordedSource::Options{.schedule = schedule,
                                .pace = follows_stamps ? ReplayPace::stamps : ReplayPace::schedule,
                                .playback = playback_.get()},
        prepared_, stop);
  }
  if (receiver_) {
    schedule.rate_hz = flags_.render.sensor.rate_hz.value_or(0.0);
    return std::make_unique<SimulatorSource>(
        *receiver_, moved_scene_,
        SimulatorSource::Options{.schedule = schedule,
                                 .timeout_s = flags_.pose_timeout_s,
                                 .sensor_count = prepared_.sensors.size()},
        stop);
  }
  if (!flags_.is_unpaced) schedule.rate_hz = prepared_.sensors.front().sensor.rate_hz;
  if (!flags_.ros2.pose_topic.empty()) {
    return ros2_->make_source({.frames = schedule, .timeout_s = flags_.pose_timeout_s},
                              static_cast<std::size_t>(flags_.pose_queue), prepared_, stop);
  }
  std::vector<double> periods_s;
  for (const ActiveSensor& active : prepared_.sensors)
    periods_s.push_back(1.0 / active.sensor.rate_hz);
  return std::make_unique<MotionSource>(schedule, std::move(periods_s), stop);
}

int StreamRun::run() {
  StopRequest stop;
  try {
    const std::unique_ptr<PoseSource> source = make_source(stop);
    if (has_all_peers(stop)) stream(*source, stop);
    if (const auto* motion = dynamic_cast<const MotionSource*>(source.get())) {
      late_ = motion->late();
    }
    if (source->has_timed_out()) exit_code_ = kNoPoses;
    constexpr int kSignalExitBase = 128;  // as in shells
    if (stop.is_requested()) {
      exit_code_ = kSignalExitBase + stop.signal();
      ending_ = signal_text(stop.signal());
    }
    stop.disarm();
    if (ending_.empty()) ending_ = source->ending();
    finish(ending_, stop.signal() == SIGTERM);
  } catch (const std::exception& error) {
    try {
      if (recording_) outputs_.clear();  // a replay that is refused leaves no unfinished files
      if (!is_finished_) finish(error.what());
    } catch (const std::exception& another) {
      console_.warn(another.what());
    }
    throw;
  }
  return exit_code_;
}

bool StreamRun::has_all_peers(const StopRequest& stop) {
  const PeerWaitResult result =
      wait_for_peers({publisher_.get(), receiver_.get()}, flags_, stop, console_);
  if (result == PeerWaitResult::timed_out) {
    ending_ = fmt::format("no simulator answered for {} s", *flags_.pose_timeout_s);
    exit_code_ = kNoPoses;
  }
  return result == PeerWaitResult::complete;
}

void StreamRun::stream(PoseSource& source, StopRequest& stop) {
  stats_ = {};
  Delivery delivery([this](const MeasuredFrame& measured) { deliver(measured); },
                    [this] { serve_peers(); }, [&stop] { stop.request(); },
                    serve_interval(outputs_));
  while (!stop.is_requested()) {
    const std::optional<FrameRequest> request = source.next();
    if (!request) break;
    if (request->motion) is_within_reach_ = move(*request->motion);
    if (!is_within_reach_ || !is_wanted(request->index)) continue;
    measure(*request, delivery.next_slot());
    delivery.submit();
  }
  delivery.finish();
}

/// Whether all sensors and instances are within reach; if not, the received pose is reported.
bool StreamRun::move(const RigMotion& motion) {
  for (std::size_t i = 0; i < motions_.size(); ++i) {
    motions_[i] = std::make_shared<const Motion>(motion_of(motion, prepared_.sensors[i]));
    if (is_within_reach(*motions_[i])) continue;
    errors_.report("pose out of reach", "a sensor or an instance is over 1e15 m from the origin");
    return false;
  }
  if (recorder_) placed_ = std::make_shared<const lockstep::Moment>(static_moment(motion));
  return true;
}

void StreamRun::measure(const FrameRequest& request, MeasuredFrame& measured) {
  const ActiveSensor& active = prepared_.sensors[request.sensor_index];
  measured.beams = active.simulator->beams(request.number);
  measured.index = request.index;
  measured.sensor_index = request.sensor_index;
  measured.motion = motions_[request.sensor_index];
  measured.placed = placed_;
  measured.frame_hash = request.frame_hash;
  measured.due = request.due;
  measured.frame.number = request.number;
  measured.frame.sensor_id = active.id;
  measured.frame.stamp_ns = request.stamp_ns.value_or(stamp_of(prepared_, active, request.number));
  measured.frame.seed = request.seed.value_or(flags_.render.seed);
  active.simulator->simulate(*measured.motion, hit_columns_, measured.frame);
  if (measured_++ > 0) return;
  print_advice(view_advice({prepared_.scene, active.sensor, *measured.beams, measured.frame}),
               console_);
}

bool StreamRun::is_wanted(std::uint64_t index) const {
  return recording_ || recorder_ || !outputs_.empty() || (publisher_ && publisher_->wants(index));
}

void StreamRun::deliver(const MeasuredFrame& measured) {
  if (recorder_)
    recorder_->write(line_of(measured.sensor_index, measured.frame, measured.placed.get()));
  if (!measured.frame_hash.empty())
    require_recorded(measured, flags_.replay, stats_.latency.count());
  if (publisher_ && publisher_->wants(measured.index)) publish(measured);
  for (const auto& output : outputs_) output->write(measured.view());
  stats_.add_frame(measured.due);
}

void StreamRun::publish(const MeasuredFrame& measured) {
  make_point_cloud(measured.frame, *measured.beams, prepared_.scene,
                   output_frame("legacy", *measured.beams, measured.frame.world_from_sensor),
                   kPublishedColumns, cloud_);
  publisher_->write(cloud_, measured.frame);
}

void StreamRun::serve_peers() {
  if (publisher_) publisher_->serve();
  for (const auto& output : outputs_) output->serve();
  const auto now = StreamStats::Clock::now();
  if (now - status_time_ < kStatusInterval) return;
  status_time_ = now;
  console_.status(status_text(stats_) + (publisher_ ? publishing_text(publisher_->counts()) : ""));
}

void StreamRun::finish(const std::string& ending, bool is_urgent) {
  constexpr std::chrono::milliseconds kUnhurried{1000};
  constexpr std::chrono::milliseconds kUrgent{400};  // for each of three waits
  is_finished_ = true;
  console_.status("");
  std::exception_ptr failure;  // the first one; the other steps run in any case
  const auto attempt = [&failure](const auto& step) {
    try {
      step();
    } catch (const std::exception&) {
      if (!failure) failure = std::current_exception();
    }
  };
  if (publisher_) attempt([&] { publisher_->shut_down(is_urgent ? kUrgent : kUnhurried); });
  std::string written;
  for (const auto& output : outputs_) {
    attempt([&] {
      output->finish();
      written += output->written_text();
    });
  }
  errors_.flush();
  StreamSummary summary{.stats = stats_,
                        .ending = ending,
                        .measured = measured_,
                        .late = late_,
                        .errors = errors_.counts()};
  if (publisher_) summary.clouds = publisher_->counts();
  if (receiver_) summary.poses = receiver_->counts();
  if (stats_file_) {
    attempt([&] {
      stats_file_->write(json_text(summary));
      stats_file_->commit();
    });
  }
  if (recorder_) attempt([&] { recorder_->commit(); });
  if (!flags_.render.quiet) print_lines(stdout, summary_text(summary) + written);
  if (failure) std::rethrow_exception(failure);
}

}  // namespace glidar::app
