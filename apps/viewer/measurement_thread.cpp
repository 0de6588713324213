// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/viewer/measurement_thread.hpp>

#include <apps/glidar/run/advice.hpp>
#include <apps/glidar/run/outputs.hpp>
#include <glidar/core/progress_counter.hpp>
#include <glidar/explain/trace_text.hpp>
#include <glidar/simulate/explain.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <new>
#include <utility>

namespace glidar::app {

/// The scene and sensor of the flags, and what is computed from them.
struct MeasurementThread::OpenScene {
  std::shared_ptr<const RenderFlags> flags;
  std::shared_ptr<PreparedScene> prepared;
  std::size_t sensor_index = 0;  ///< the sensor of the following members
  std::shared_ptr<Simulator> simulator;
  std::shared_ptr<Simulator> noise_free_simulator;
};

namespace {

/// The sensor without random errors.
Sensor without_noise(Sensor sensor) {
  sensor.noise.clear();
  if (sensor.lidar_equation) sensor.lidar_equation->noise_sigma = 0.0;
  return sensor;
}

Motion with_moves(const Motion& motion, const MeasureRequest& request) {
  Motion result = motion;
  if (request.sensor_moved.matrix() != Pose::Identity().matrix()) {
    result.world_from_sensor = transformed(request.sensor_moved, motion.world_from_sensor);
  }
  std::vector<Trajectory>& instances = result.world_from_instance;
  const std::size_t count = std::min(request.objects_moved.size(), instances.size());
  for (std::size_t i = 0; i < count; ++i) {
    const Pose& by = request.objects_moved[i];
    if (by.matrix() != Pose::Identity().matrix()) instances[i] = transformed(by, instances[i]);
  }
  return result;
}

std::string written_text(const std::vector<Output>& outputs) {
  std::string text = "wrote";
  for (const Output& output : outputs) text += " " + output.path.string();
  return text;
}

}  // namespace

bool operator==(const MeasureRequest& a, const MeasureRequest& b) {
  const auto is_same = [](const Pose& p, const Pose& q) { return p.matrix() == q.matrix(); };
  return a.flags == b.flags && a.sensor_index == b.sensor_index &&
         std::equal(a.objects_moved.begin(), a.objects_moved.end(), b.objects_moved.begin(),
                    b.objects_moved.end(), is_same) &&
         a.sensor_moved.matrix() == b.sensor_moved.matrix() && a.number == b.number &&
         a.seed == b.seed && a.has_noise == b.has_noise;
}

MeasurementThread::MeasurementThread(Console& console, std::function<void()> wake)
    : console_(console), wake_(std::move(wake)), thread_([this] { run(); }) {
  console_.listen(
      {.log = [this](Severity, std::string_view message) { add_message(std::string(message)); },
       .progress = [this](std::string_view task,
                          double fraction_done) { show_busy(task, fraction_done); }});
}

MeasurementThread::~MeasurementThread() {
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
  }
  changed_.notify_one();
  thread_.join();
  console_.listen({});
}

void MeasurementThread::measure(const MeasureRequest& request) {
  {
    const std::lock_guard lock(mutex_);
    pending_ = request;
  }
  changed_.notify_one();
}

void MeasurementThread::explain(const MeasureRequest& request, std::size_t entry) {
  {
    const std::lock_guard lock(mutex_);
    trace_task_ = [this, request, entry] { explain_now(request, entry); };
  }
  changed_.notify_one();
}

void MeasurementThread::save(const MeasureRequest& request, const OutputFlags& outputs) {
  {
    const std::lock_guard lock(mutex_);
    saves_.emplace_back([this, request, outputs] { save_now(request, outputs); });
  }
  changed_.notify_one();
}

void MeasurementThread::take(Results& results) {
  const std::lock_guard lock(mutex_);
  results = results_;
  results_.trace.reset();
  results_.errors.clear();
  results_.messages.clear();
  results_.is_refused = false;
}

void MeasurementThread::show_busy(std::string_view task, double fraction_done) {
  std::string text(task);
  if (fraction_done >= 0.0) text += fmt::format(", {:.0f} %", 100.0 * fraction_done);
  {
    const std::lock_guard lock(mutex_);
    if (text == results_.busy) return;
    results_.busy = std::move(text);
  }
  wake_();
}

void MeasurementThread::add_message(std::string message) {
  {
    const std::lock_guard lock(mutex_);
    results_.messages.push_back(std::move(message));
  }
  wake_();
}

void MeasurementThread::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock,
                  [this] { return is_ending_ || pending_ || !saves_.empty() || trace_task_; });
    if (is_ending_) return;
    do_one(lock);
  }
}

/// The most urgent task.
std::function<void()> MeasurementThread::next_task() {
  if (pending_)
    return [this, request = *std::exchange(pending_, std::nullopt)] { measure_now(request); };
  if (saves_.empty()) return std::exchange(trace_task_, {});
  std::function<void()> task = std::move(saves_.front());
  saves_.pop_front();
  return task;
}

/// Runs a task; errors become results, and the thread continues.
void MeasurementThread::do_one(std::unique_lock<std::mutex>& lock) {
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
  task = {};  // releases its snapshot before the results are taken
  lock.lock();
  if (!error.empty()) {
    results_.errors.push_back(std::move(error));
    results_.is_refused = refused_ != nullptr;
  }
  results_.busy.clear();
  lock.unlock();
  wake_();
  lock.lock();
}

void MeasurementThread::open_for(const MeasureRequest& request) {
  show_busy("opening " + request.flags->input, -1.0);
  auto loaded = std::make_unique<OpenScene>();
  loaded->prepared = std::make_shared<PreparedScene>();
  refused_ = request.flags;
  prepare_scene(*request.flags, {}, console_, *loaded->prepared);
  refused_.reset();
  loaded->flags = request.flags;
  open_scene_ = std::move(loaded);
  select_sensor(request.sensor_index);
  snapshots_.clear();
}

/// Selects a sensor of the scene.
void MeasurementThread::select_sensor(std::size_t index) {
  const ActiveSensor& active = open_scene_->prepared->sensors.at(index);
  open_scene_->sensor_index = index;
  open_scene_->simulator = active.simulator;
  open_scene_->noise_free_simulator =
      make_simulator(*open_scene_->prepared,
                     std::make_shared<const BeamCache>(without_noise(active.sensor), active.beams));
}

std::shared_ptr<Snapshot> MeasurementThread::unused_snapshot() {
  const std::lock_guard lock(mutex_);  // snapshots are released under this lock
  for (const std::shared_ptr<Snapshot>& snapshot : snapshots_) {
    if (snapshot.use_count() == 1) return snapshot;
  }
  snapshots_.push_back(std::make_shared<Snapshot>());
  return snapshots_.back();
}

/// Fills all of the snapshot except the frame's measurement.
void MeasurementThread::prepare(const MeasureRequest& request, Snapshot& snapshot) {
  if (!open_scene_ || open_scene_->flags != request.flags) open_for(request);
  if (open_scene_->sensor_index != request.sensor_index) select_sensor(request.sensor_index);
  const ActiveSensor& active = open_scene_->prepared->sensors[request.sensor_index];
  snapshot.request = request;
  snapshot.prepared = open_scene_->prepared;
  snapshot.simulator =
      request.has_noise ? open_scene_->simulator : open_scene_->noise_free_simulator;
  snapshot.sensor = {snapshot.simulator, &snapshot.simulator->sensor()};
  snapshot.beams = snapshot.simulator->beams(request.number);
  snapshot.motion = with_moves(active.motion, request);
  snapshot.frame.number = request.number;
  snapshot.frame.sensor_id = active.id;
  snapshot.frame.stamp_ns =
      open_scene_->prepared->start_ns + frame_interval(*snapshot.sensor, request.number).start_ns;
  snapshot.frame.seed = request.seed;
}

void MeasurementThread::measure_now(const MeasureRequest& request) {
  if (request.flags == refused_) return;
  const std::shared_ptr<Snapshot> snapshot = unused_snapshot();
  prepare(request, *snapshot);
  const auto start = std::chrono::steady_clock::now();
  snapshot->simulator->simulate(snapshot->motion, {.normal = true}, snapshot->frame);
  snapshot->seconds = seconds_since(start);
  const std::lock_guard lock(mutex_);
  results_.snapshot = snapshot;
}

void MeasurementThread::explain_now(const MeasureRequest& request, std::size_t entry) {
  if (!open_scene_ || open_scene_->flags != request.flags)
    return;  // the user has opened another file
  Snapshot snapshot;
  prepare(request, snapshot);
  const PointTrace trace =
      glidar::explain(*snapshot.simulator, snapshot.motion, entry, snapshot.frame);
  std::string text = format_trace(trace, *snapshot.simulator, snapshot.frame);
  const std::lock_guard lock(mutex_);
  results_.trace = std::move(text);
}

void MeasurementThread::save_now(const MeasureRequest& request, const OutputFlags& flags) {
  Snapshot snapshot;
  prepare(request, snapshot);
  const SidecarContext context{.scene = snapshot.prepared->scene,
                               .sensor = *snapshot.sensor,
                               .beams = *snapshot.beams,
                               .renderer = renderer_name(*request.flags),
                               .inputs = snapshot.prepared->files};
  const std::vector<Output> outputs =
      plan_outputs(flags, request.flags->input, context, console_.report());
  refuse_overwrite_of_inputs(snapshot.prepared->files, outputs);
  snapshot.simulator->simulate(snapshot.motion, hit_columns_for_outputs(outputs), snapshot.frame);
  write_outputs(outputs, snapshot.frame, *snapshot.beams, snapshot.prepared->scene,
                console_.report());
  add_message(written_text(outputs));
}

}  // namespace glidar::app
