// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/live_view.hpp>

#include <glidar/core/error.hpp>
#include <glidar/explain/trace_text.hpp>
#include <glidar/output/rig_messages.hpp>
#include <glidar/simulate/explain.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <exception>
#include <limits>
#include <utility>

namespace glidar::app {

namespace {

/// Frames of each sensor that viewers may still show.
constexpr std::size_t kKnownFrames = 100;

/// Ends an explanation.
struct Cancelled {};

}  // namespace

PointExplainer::PointExplainer(const RenderFlags& flags, const PreparedScene& prepared,
                               const ros::RigPublisher& publisher)
    : flags_(flags),
      prepared_(prepared),
      publisher_(publisher),
      simulators_(prepared.sensors.size()),
      thread_([this] { run(); }) {}

PointExplainer::~PointExplainer() {
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

void PointExplainer::add_frame(const RigFrame& measured) {
  const Frame& frame = measured.frame;
  const ros::CloudSource source{frame, prepared_.sensors[measured.sensor].sensor, measured.beams};
  KnownFrame known{
      .sensor_index = measured.sensor,
      .message_ns = ros::cloud_stamp_ns(source, publisher_.cloud_options(measured.sensor)),
      .stamp_ns = frame.stamp_ns,
      .number = frame.number,
      .seed = frame.seed,
      .motion = measured.motion};
  const std::lock_guard lock(mutex_);
  frames_.push_back(std::move(known));
  if (frames_.size() > kKnownFrames * simulators_.size()) frames_.pop_front();
}

void PointExplainer::explain(PublishedPoint point, Reply reply) {
  {
    const std::lock_guard lock(mutex_);
    questions_.push_back({std::move(point), std::move(reply)});
  }
  changed_.notify_one();
}

void PointExplainer::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return is_ending_ || !questions_.empty(); });
    if (is_ending_) return;
    const Question question = std::move(questions_.front());
    questions_.pop_front();
    lock.unlock();
    std::string text;
    try {
      text = explanation(question.point);
    } catch (const Cancelled&) {
      return;
    } catch (const std::exception& error) {
      text = error.what();
    }
    question.reply(text);
    lock.lock();
  }
}

/// The newest frame with this stamp: a replay may repeat stamps.
PointExplainer::KnownFrame PointExplainer::find_frame(const PublishedPoint& point) const {
  const std::lock_guard lock(mutex_);
  const auto is_same = [&](const KnownFrame& known) {
    return known.message_ns == point.stamp_ns &&
           publisher_.cloud_topic(known.sensor_index) == point.topic;
  };
  const auto found = std::find_if(frames_.rbegin(), frames_.rend(), is_same);
  if (found != frames_.rend()) return *found;
  throw Error({"explanation of a point",
               fmt::format("the frame of {} at {} ns is not known", point.topic, point.stamp_ns),
               fmt::format("the last {} frames of each sensor", kKnownFrames),
               "select a point of a newer cloud"});
}

std::string PointExplainer::explanation(const PublishedPoint& point) {
  const KnownFrame known = find_frame(point);
  Simulator& simulator = simulator_of(known.sensor_index);
  Frame frame;
  frame.stamp_ns = known.stamp_ns;
  frame.seed = known.seed;
  frame.number = known.number;
  frame.sensor_id = prepared_.sensors[known.sensor_index].id;
  const auto pick = [&](const Frame& repeated) {
    return entry_of(point, known.sensor_index, repeated, *simulator.beams(known.number));
  };
  const auto check_end = [this](double /*fraction_done*/) {
    if (is_ending_) throw Cancelled{};
  };
  const PointTrace trace = glidar::explain(simulator, *known.motion, pick, frame, check_end);
  return format_trace(trace, simulator, frame);
}

std::size_t PointExplainer::entry_of(const PublishedPoint& point, std::size_t sensor_index,
                                     const Frame& frame, const Beams& beams) const {
  PointCloud cloud;
  const std::vector<std::string> columns = {"xyz"};
  make_point_cloud(frame, beams, prepared_.scene,
                   output_frame("sensor", beams, frame.world_from_sensor), columns, cloud);
  const std::vector<std::uint32_t> points =
      ros::message_points(cloud, {frame, prepared_.sensors[sensor_index].sensor, beams},
                          publisher_.cloud_options(sensor_index));
  if (point.index < points.size()) return points[point.index];
  throw Error({"explanation of a point", fmt::format("point {}", point.index),
               fmt::format("0 to {}, a point of the cloud", points.size())});
}

Simulator& PointExplainer::simulator_of(std::size_t sensor_index) {
  if (!renderer_) {
    RendererOptions options = hit_renderer(flags_);
    options.threads = 1;  // leaves the others to the measurement
    renderer_ = make_renderer(prepared_.scene, options);
    if (flags_.quantized_framebuffer) {
      woods2016_camera_ = make_woods2016_camera(prepared_.scene, options);
    }
  }
  std::shared_ptr<Simulator>& simulator = simulators_[sensor_index];
  if (!simulator) {
    const ActiveSensor& active = prepared_.sensors[sensor_index];
    simulator = make_simulator(prepared_.scene,
                               std::make_shared<const BeamCache>(active.sensor, active.beams),
                               *renderer_, woods2016_camera_.get());
  }
  return *simulator;
}

namespace {

/// How often a paused replay checks for a command.
constexpr std::chrono::milliseconds kCommandPollInterval{20};

}  // namespace

void Playback::command(foxglove::PlaybackCommand command) {
  const std::lock_guard lock(mutex_);
  is_playing_ = command == foxglove::PlaybackCommand::play;
  if (command == foxglove::PlaybackCommand::step) {
    ++steps_;
  } else {
    steps_ = 0;
  }
}

bool Playback::wait(const StopRequest& stop) {
  while (!stop.is_requested()) {
    if (take_step()) return true;
    stop.wait_until(std::chrono::steady_clock::now() + kCommandPollInterval);
  }
  return false;
}

bool Playback::take_step() {
  const std::lock_guard lock(mutex_);
  if (is_playing_) return true;
  if (steps_ == 0) return false;
  --steps_;
  return true;
}

bool Playback::is_playing() const {
  const std::lock_guard lock(mutex_);
  return is_playing_;
}

LiveView::LiveView(const link::Endpoint& at, Playback* playback, link::ErrorLog& errors)
    : host_(at.host), playback_(playback) {
  foxglove::ServerOptions options{.at = at};
  if (playback_ != nullptr) {
    options.on_playback = [this](foxglove::PlaybackCommand command) {
      playback_->command(command);
    };
  }
  options.on_pick = [this](const foxglove::Pick& selected, foxglove::PickReply reply) {
    explain(selected, std::move(reply));
  };
  server_ = std::make_unique<foxglove::FoxgloveServer>(options, errors);
}

LiveView::~LiveView() {
  server_.reset();  // its thread passes points to the explainer
}

void LiveView::begin(const RenderFlags& flags, const PreparedScene& prepared,
                     const OutputRig& rig) {
  // viewers of a paused replay may come at any time
  channels_ = std::make_unique<foxglove::RosChannels>(*server_, playback_ != nullptr);
  publisher_ = make_rig_publisher(*channels_, rig, flags.output, true);
  const std::lock_guard lock(mutex_);
  explainer_ = std::make_unique<PointExplainer>(flags, prepared, *publisher_);
}

std::string LiveView::url() const {
  const bool is_here = host_ == "*" || host_ == "127.0.0.1";
  return fmt::format("http://{}:{}/", is_here ? "localhost" : host_, server_->port());
}

HitColumnMask LiveView::hit_columns(std::size_t sensor) const {
  return publisher_->hit_columns(sensor);
}

void LiveView::write(const RigFrame& written) {
  explainer_->add_frame(written);
  publisher_->publish(written.sensor, written.frame, written.beams);
  time_ns_ = static_cast<std::uint64_t>(std::max<std::int64_t>(0, written.frame.stamp_ns));
  if (playback_ != nullptr) show_playback();
}

void LiveView::serve() {
  if (playback_ != nullptr && shows_playing_ != playback_->is_playing()) show_playback();
}

void LiveView::show_playback() {
  shows_playing_ = playback_->is_playing();
  server_->set_playback({.is_playing = *shows_playing_, .time_ns = time_ns_});
}

void LiveView::finish() {
  publisher_->finish();
}

void LiveView::explain(const foxglove::Pick& selected, foxglove::PickReply reply) {
  const std::lock_guard lock(mutex_);
  constexpr auto kMax = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
  if (!explainer_ || selected.time_ns > kMax) return;
  explainer_->explain({.topic = selected.topic,
                       .stamp_ns = static_cast<std::int64_t>(selected.time_ns),
                       .index = selected.index},
                      std::move(reply));
}

}  // namespace glidar::app
