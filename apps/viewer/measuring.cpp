// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/viewer/measuring.hpp>

#include <apps/glidar/run/advice.hpp>
#include <apps/glidar/run/outputs.hpp>
#include <glidar/explain/trace_text.hpp>
#include <glidar/simulate/explain.hpp>
#include <glidar/simulate/simulate.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <new>
#include <utility>

namespace glidar::app {

/// What the flags name, and what follows from it.
struct Measuring::Opened {
  std::shared_ptr<const RenderFlags> flags;
  std::shared_ptr<Session> session;
  std::size_t mount = 0;  ///< the one that the following are of
  std::shared_ptr<const Sensor> noisy;
  std::shared_ptr<const Sensor> still;
  std::shared_ptr<const Beams> beams;
  std::uint32_t number = 0;  ///< of the frame that the beams are of
};

namespace {

/// The sensor without random errors.
Sensor without_noise(Sensor sensor) {
  sensor.noise.clear();
  if (sensor.pulse) sensor.pulse->noise_sigma = 0.0;
  return sensor;
}

Motion moved_all(const Motion& motion, const Ask& ask) {
  Motion result = motion;
  if (ask.sensor_moved.matrix() != Pose::Identity().matrix()) {
    result.world_from_sensor = transformed(ask.sensor_moved, motion.world_from_sensor);
  }
  std::vector<Trajectory>& instances = result.world_from_instance;
  const std::size_t count = std::min(ask.objects_moved.size(), instances.size());
  for (std::size_t i = 0; i < count; ++i) {
    const Pose& by = ask.objects_moved[i];
    if (by.matrix() != Pose::Identity().matrix()) instances[i] = transformed(by, instances[i]);
  }
  return result;
}

Setup setup_of(const Snapshot& shot) {
  const Session& session = *shot.session;
  Setup setup{.scene = session.scene,
              .sensor = *shot.sensor,
              .beams = *shot.beams,
              .motion = shot.motion,
              .renderer = *session.renderer};
  if (session.paper) setup.paper.emplace(Woods2016Target{.camera = *session.paper});
  return setup;
}

std::string written_text(const std::vector<Output>& outputs) {
  std::string text = "wrote";
  for (const Output& output : outputs) text += " " + output.path.string();
  return text;
}

}  // namespace

bool operator==(const Ask& a, const Ask& b) {
  const auto is_same = [](const Pose& p, const Pose& q) { return p.matrix() == q.matrix(); };
  return a.flags == b.flags && a.mount == b.mount &&
         std::equal(a.objects_moved.begin(), a.objects_moved.end(), b.objects_moved.begin(),
                    b.objects_moved.end(), is_same) &&
         a.sensor_moved.matrix() == b.sensor_moved.matrix() && a.number == b.number &&
         a.seed == b.seed && a.has_noise == b.has_noise;
}

Measuring::Measuring(Console& console, std::function<void()> wake)
    : console_(console), wake_(std::move(wake)), thread_([this] { run(); }) {
  console_.listen({.log = [this](Severity, std::string_view message) { say(std::string(message)); },
                   .progress = [this](std::string_view task,
                                      double fraction_done) { show_busy(task, fraction_done); }});
}

Measuring::~Measuring() {
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
  }
  changed_.notify_one();
  thread_.join();
  console_.listen({});
}

void Measuring::measure(const Ask& ask) {
  {
    const std::lock_guard lock(mutex_);
    wanted_ = ask;
  }
  changed_.notify_one();
}

void Measuring::explain(const Ask& ask, std::size_t entry) {
  {
    const std::lock_guard lock(mutex_);
    story_ = [this, ask, entry] { explain_now(ask, entry); };
  }
  changed_.notify_one();
}

void Measuring::save(const Ask& ask, const OutputFlags& outputs) {
  {
    const std::lock_guard lock(mutex_);
    saves_.emplace_back([this, ask, outputs] { save_now(ask, outputs); });
  }
  changed_.notify_one();
}

void Measuring::take(News& news) {
  const std::lock_guard lock(mutex_);
  news = news_;
  news_.story.reset();
  news_.errors.clear();
  news_.messages.clear();
  news_.is_refused = false;
}

void Measuring::show_busy(std::string_view task, double fraction_done) {
  std::string text(task);
  if (fraction_done >= 0.0) text += fmt::format(", {:.0f} %", 100.0 * fraction_done);
  {
    const std::lock_guard lock(mutex_);
    if (text == news_.busy) return;
    news_.busy = std::move(text);
  }
  wake_();
}

void Measuring::say(std::string message) {
  {
    const std::lock_guard lock(mutex_);
    news_.messages.push_back(std::move(message));
  }
  wake_();
}

void Measuring::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return is_ending_ || wanted_ || !saves_.empty() || story_; });
    if (is_ending_) return;
    do_one(lock);
  }
}

/// What is asked for and most urgent.
std::function<void()> Measuring::next_task() {
  if (wanted_) return [this, ask = *std::exchange(wanted_, std::nullopt)] { measure_now(ask); };
  if (saves_.empty()) return std::exchange(story_, {});
  std::function<void()> task = std::move(saves_.front());
  saves_.pop_front();
  return task;
}

/// Whatever goes wrong is told; the thread goes on.
void Measuring::do_one(std::unique_lock<std::mutex>& lock) {
  std::function<void()> task = next_task();
  lock.unlock();
  std::string error;
  try {
    task();
  } catch (const std::bad_alloc&) {
    error = "out of memory; use a smaller image or a smaller model";
  } catch (const std::exception& exception) {
    error = exception.what();
  }
  task = {};  // with what it holds, before another may ask for it
  lock.lock();
  if (!error.empty()) {
    news_.errors.push_back(std::move(error));
    news_.is_refused = refused_ != nullptr;
  }
  news_.busy.clear();
  lock.unlock();
  wake_();
  lock.lock();
}

void Measuring::open_for(const Ask& ask) {
  show_busy("opening " + ask.flags->input, -1.0);
  auto opened = std::make_unique<Opened>();
  opened->session = std::make_shared<Session>();
  refused_ = ask.flags;
  open(*ask.flags, {}, console_, *opened->session);
  refused_.reset();
  opened->flags = ask.flags;
  opened_ = std::move(opened);
  use_mount(ask.mount);
  shots_.clear();
}

/// Turns to a sensor of what is open, at its first frame.
void Measuring::use_mount(std::size_t index) {
  const Mount& mount = opened_->session->mounts.at(index);
  opened_->mount = index;
  opened_->noisy = std::make_shared<Sensor>(mount.sensor);
  opened_->still = std::make_shared<Sensor>(without_noise(mount.sensor));
  opened_->beams = std::make_shared<Beams>(mount.beams);
  opened_->number = 0;
}

std::shared_ptr<Snapshot> Measuring::spare() {
  const std::lock_guard lock(mutex_);  // whoever let go of one did it under this lock
  for (const std::shared_ptr<Snapshot>& shot : shots_) {
    if (shot.use_count() == 1) return shot;
  }
  shots_.push_back(std::make_shared<Snapshot>());
  return shots_.back();
}

/// All of the shot but the measurement.
void Measuring::prepare(const Ask& ask, Snapshot& shot) {
  if (!opened_ || opened_->flags != ask.flags) open_for(ask);
  if (opened_->mount != ask.mount) use_mount(ask.mount);
  const Mount& mount = opened_->session->mounts[ask.mount];
  if (opened_->number != ask.number) {
    const Sensor& sensor = *opened_->noisy;
    opened_->beams =
        std::make_shared<Beams>(make_beams(sensor, frame_interval(sensor, ask.number)));
    opened_->number = ask.number;
  }
  shot.ask = ask;
  shot.session = opened_->session;
  shot.sensor = ask.has_noise ? opened_->noisy : opened_->still;
  shot.beams = opened_->beams;
  shot.motion = moved_all(mount.motion, ask);
  shot.frame.number = ask.number;
  shot.frame.sensor_id = mount.id;
  shot.frame.stamp_ns = frame_interval(*shot.sensor, ask.number).start_ns;
  shot.frame.seed = ask.seed;
}

void Measuring::measure_now(const Ask& ask) {
  if (ask.flags == refused_) return;
  const std::shared_ptr<Snapshot> shot = spare();
  prepare(ask, *shot);
  const auto start = std::chrono::steady_clock::now();
  simulate(setup_of(*shot), {.normal = true}, shot->frame);
  shot->seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const std::lock_guard lock(mutex_);
  news_.shot = shot;
}

void Measuring::explain_now(const Ask& ask, std::size_t entry) {
  if (!opened_ || opened_->flags != ask.flags) return;  // the user has gone on
  Snapshot shot;
  prepare(ask, shot);
  const Setup setup = setup_of(shot);
  const PointTrace story = glidar::explain(setup, entry, shot.frame);
  std::string text = format_trace(story, setup, shot.frame);
  const std::lock_guard lock(mutex_);
  news_.story = std::move(text);
}

void Measuring::save_now(const Ask& ask, const OutputFlags& flags) {
  Snapshot shot;
  prepare(ask, shot);
  const SidecarContext context{.scene = shot.session->scene,
                               .sensor = *shot.sensor,
                               .beams = *shot.beams,
                               .renderer = renderer_name(*ask.flags),
                               .inputs = shot.session->files};
  const std::vector<Output> outputs =
      plan_outputs(flags, ask.flags->input, context, console_.report());
  refuse_overwrite_of_inputs(shot.session->files, outputs);
  simulate(setup_of(shot), fields_for_outputs(outputs), shot.frame);
  write_outputs(outputs, shot.frame, *shot.beams, shot.session->scene, console_.report());
  say(written_text(outputs));
}

}  // namespace glidar::app
