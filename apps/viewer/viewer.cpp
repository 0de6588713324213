// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/viewer/viewer.hpp>

#include <glidar/core/pose.hpp>
#include <glidar/core/report.hpp>
#include <glidar/explain/trace_text.hpp>
#include <glidar/io/files/atomic_file.hpp>
#include <glidar/math/portable.hpp>
#include <glidar/output/frame_files.hpp>
#include <glidar/simulate/explain.hpp>

#include <fmt/format.h>
#include <Eigen/Core>
#include <apps/glidar/run/advice.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <new>
#include <numbers>
#include <string>
#include <utility>
#include <variant>
#include <vector>

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

std::string written_text(const std::vector<std::filesystem::path>& files) {
  std::string text = "wrote";
  for (const std::filesystem::path& file : files) text += " " + file.string();
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

void MeasurementThread::save(const MeasureRequest& request, const FrameFileRequest& files) {
  {
    const std::lock_guard lock(mutex_);
    saves_.emplace_back([this, request, files] { save_now(request, files); });
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

void MeasurementThread::save_now(const MeasureRequest& request, FrameFileRequest wanted) {
  Snapshot snapshot;
  prepare(request, snapshot);
  const PreparedScene& prepared = *snapshot.prepared;
  wanted.input = request.flags->input;
  OutputRig rig{.scene = prepared.scene, .sensors = {}};
  rig.sensors.push_back({.sensor = *snapshot.sensor, .beams = *snapshot.beams});
  rig.renderer = renderer_name(*request.flags);
  rig.inputs = prepared.files;
  for (const std::filesystem::path& file : check_frame_files(wanted))
    refuse_overwrite_of_inputs(prepared.files, file);
  FrameFiles files(std::move(wanted), false, rig, console_.report());
  snapshot.simulator->simulate(snapshot.motion, files.hit_columns(0), snapshot.frame);
  files.write({.frame = snapshot.frame, .beams = *snapshot.beams});
  add_message(written_text(files.files()));
}

void Selection::begin(const Scene& scene, bool is_kept) {
  std::vector<Eigen::AlignedBox3d> meshes;
  for (const Mesh& mesh : scene.meshes) meshes.push_back(bounds(mesh));
  boxes_m_.clear();
  for (const Instance& instance : scene.instances) {
    const Eigen::AlignedBox3d& box = meshes[instance.mesh];
    boxes_m_.push_back(box.isEmpty() ? box
                                     : Eigen::AlignedBox3d(instance.scale * box.min(),
                                                           instance.scale * box.max()));
  }
  if (is_kept && (!object_ || *object_ < boxes_m_.size())) return;
  object_.reset();
  select(0);
}

void Selection::select(std::optional<std::size_t> object) {
  if (!object || *object < boxes_m_.size()) object_ = object;
}

std::vector<Eigen::Vector3d> Selection::corners_m(const Frame& frame) const {
  std::vector<Eigen::Vector3d> corners;
  for (std::size_t i = 0; i < boxes_m_.size(); ++i) {
    if (!includes(i) || boxes_m_[i].isEmpty()) continue;
    for (int corner = 0; corner < 8; ++corner) {
      const auto type = static_cast<Eigen::AlignedBox3d::CornerType>(corner);
      corners.emplace_back(frame.world_from_instance[i] * boxes_m_[i].corner(type));
    }
  }
  return corners;
}

namespace {

/// The measured point of each beam in the world, relative to the anchor; NaN without a return.
void make_cloud_points(const Snapshot& snapshot, const Eigen::Vector3d& anchor_m,
                       std::vector<Eigen::Vector3f>& points) {
  const Pose anchor_from_world(Eigen::Translation3d(-anchor_m));
  const OutputFrame target_frame{
      .frame_id = "anchor",
      .cloud_from_sensor = anchor_from_world * snapshot.frame.world_from_sensor};
  const std::vector<std::string> columns = {"xyz"};
  PointCloud cloud;
  make_point_cloud(snapshot.frame, *snapshot.beams, snapshot.prepared->scene, target_frame, columns,
                   cloud);
  const auto& xyz = std::get<std::vector<double>>(cloud.columns[0].values);
  points.resize(cloud.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i] = Eigen::Vector3d(xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]).cast<float>();
  }
}

/// The flags for another file: only those of the measurement are kept.
RenderFlags for_file(const RenderFlags& before, const std::string& path) {
  RenderFlags flags;
  flags.input = path;
  flags.sensor = before.sensor;
  flags.renderer = before.renderer;
  flags.quantized_framebuffer = before.quantized_framebuffer;
  flags.seed = before.seed;
  flags.output = before.output;
  return flags;
}

Pose translation_by(const Eigen::Vector3d& by_m) {
  return Pose(Eigen::Translation3d(by_m));
}

Pose rotation_about(const Eigen::Vector3d& point_m, const Pose& by) {
  return translation_by(point_m) * by * translation_by(-point_m);
}

bool is_static(const Trajectory& trajectory) {
  return std::holds_alternative<ConstantPose>(trajectory);
}

/// The pose with an exact rotation, without the rounding errors of many small rotations.
Pose orthonormalized(const Pose& pose) {
  return make_pose(pose.translation(), Eigen::Quaterniond(pose.linear()).normalized());
}

}  // namespace

Viewer::Viewer(const RenderFlags& flags, MeasurementThread& thread) : measurements_(thread) {
  request_.seed = flags.seed;
  request_measurement(flags);
}

void Viewer::request_measurement(const RenderFlags& flags) {
  request_.flags = std::make_shared<RenderFlags>(flags);
  update();
}

void Viewer::update() {
  measurements_.measure(request_);
}

bool Viewer::is_moving() const {
  if (!snapshot()) return false;
  const Motion& motion = snapshot()->motion;
  return !is_static(motion.world_from_sensor) ||
         !std::all_of(motion.world_from_instance.begin(), motion.world_from_instance.end(),
                      is_static);
}

bool Viewer::take_results() {
  const Snapshot* before = snapshot();
  const std::string busy_before = results_.busy;
  measurements_.take(results_);
  errors.insert(errors.end(), results_.errors.begin(), results_.errors.end());
  if (!results_.messages.empty()) message = results_.messages.back();
  if (results_.trace) trace = *results_.trace;
  if (results_.is_refused && snapshot()) {
    request_.flags = snapshot()->request.flags;
    request_.sensor_index = snapshot()->request.sensor_index;
    request_.objects_moved = snapshot()->request.objects_moved;
    request_.sensor_moved = snapshot()->request.sensor_moved;
  }
  const bool is_new = snapshot() != before;
  if (is_new) show_snapshot(snapshot()->request.flags != shown_flags_);
  return is_new || results_.trace || !results_.errors.empty() || !results_.messages.empty() ||
         results_.busy != busy_before;
}

/// Resets the view so that the whole scene is visible.
void Viewer::begin_scene() {
  const Snapshot& now = *snapshot();
  selection_.begin(now.prepared->scene,
                   shown_flags_ && shown_flags_->input == now.request.flags->input);
  shown_flags_ = now.request.flags;
  const Eigen::AlignedBox3d box = bounds(now.prepared->scene);
  anchor_m_ = box.isEmpty() ? Eigen::Vector3d(now.frame.world_from_sensor.translation())
                            : Eigen::Vector3d(box.center());
  const Eigen::Vector3d sensor_m = now.frame.world_from_sensor.translation() - anchor_m_;
  Eigen::AlignedBox3d anchored = box;
  if (!box.isEmpty()) anchored.translate(-anchor_m_);
  style.orbit = view_of_all(anchored, sensor_m, style.aspect);
  const std::vector<std::string> advice =
      view_advice({now.prepared->scene, *now.sensor, *now.beams, now.frame});
  if (!advice.empty()) message = advice.front();
}

void Viewer::begin_sensor() {
  const Beams& beams = *snapshot()->beams;
  shown_sensor_ = snapshot()->request.sensor_index;
  field_ = field_of_view(beams);
  const bool is_camera = looks_along_z(beams);
  if (style.quantity == Quantity::depth && !is_camera) style.quantity = Quantity::range;
  if (style.quantity == Quantity::range && is_camera) style.quantity = Quantity::depth;
}

void Viewer::show_snapshot(bool is_new_scene) {
  if (is_new_scene) begin_scene();
  if (is_new_scene || snapshot()->request.sensor_index != shown_sensor_) begin_sensor();
  update_visibility();
  aim_if_hidden();
  summary_ = summarise(snapshot()->frame);
  if (picked_ && *picked_ >= snapshot()->beams->size()) pick({});
  request_trace();
  update_view();
}

void Viewer::request_trace() {
  if (!picked_ || !snapshot() || (traced_ && *traced_ == snapshot()->request)) return;
  traced_ = snapshot()->request;
  measurements_.explain(*traced_, *picked_);
}

void Viewer::update_view() {
  if (!snapshot()) return;
  const Snapshot& now = *snapshot();
  make_sensor_picture(now.frame, *now.beams, now.prepared->scene, style.quantity, style.map,
                      picture_);
  make_cloud_points(now, anchor_m_, points_);
  guides_.clear();
  const Pose anchor_from_sensor = translation_by(-anchor_m_) * now.frame.world_from_sensor;
  const double distance_m = anchor_from_sensor.translation().norm();
  const double extent_m = std::max(style.orbit.distance_m, 1e-6);
  style.grid_m = grid_spacing_m(2.0 * extent_m);
  const Eigen::AlignedBox3d box = bounds(now.prepared->scene);
  const double floor_m = box.isEmpty() ? 0.0 : box.min().z() - anchor_m_.z();
  add_grid({0.0, 0.0, floor_m}, extent_m, style.grid_m, guides_);
  add_axes(translation_by({0.0, 0.0, floor_m}), style.grid_m, guides_);
  add_axes(anchor_from_sensor, style.grid_m, guides_);
  add_frustum(*now.beams, anchor_from_sensor, std::max(distance_m, style.grid_m), guides_);
  add_selection_box();
  ++version_;
}

void Viewer::type(unsigned letter) {
  switch (letter) {
    case 's':
      return save();
    case '+':
    case '=':  // the same key without shift
      return step_sensor(1.0);
    case '-':
      return step_sensor(-1.0);
    case ' ':
      return toggle_play();
    case 'r':
      return reset();
    case 'f':
    case 'F':
      return frame_selected();
    default:
      return;
  }
}

void Viewer::open(const std::string& path) {
  request_.objects_moved.clear();
  request_.sensor_moved = Pose::Identity();
  request_.sensor_index = 0;
  request_.number = 0;
  time_s_ = 0.0;
  pick({});
  request_measurement(for_file(*request_.flags, path));
}

void Viewer::use_sensor(const std::string& preset) {
  RenderFlags flags = *request_.flags;
  flags.sensor = {};
  flags.sensor.file = preset;
  flags.sensor.mode.clear();  // it is one of the sensor before
  flags.pose.world_from_sensor.reset();
  request_.sensor_moved = Pose::Identity();
  pick({});
  request_measurement(flags);
}

void Viewer::use_renderer(const std::string& kind) {
  RenderFlags flags = *request_.flags;
  flags.renderer.kind = kind;
  if (renderer_kind(kind) != "gpu") flags.quantized_framebuffer = false;
  request_measurement(flags);
}

void Viewer::select_sensor(std::size_t index) {
  if (!is_open() || index >= snapshot()->prepared->sensors.size()) return;
  if (index == request_.sensor_index) return;
  request_.sensor_index = index;
  request_.number = static_cast<std::uint32_t>(time_s_ * rate_hz());
  pick({});
  update();
}

void Viewer::set_noise(bool is_on) {
  request_.has_noise = is_on;
  update();
}

void Viewer::set_seed(std::uint64_t seed) {
  request_.seed = seed;
  update();
}

void Viewer::save() {
  if (!snapshot()) return;
  FrameFileRequest outputs = static_cast<const FrameFileRequest&>(request_.flags->output);
  if (outputs.paths.empty() && outputs.legacy_name.empty()) outputs.legacy_name = "buffer";
  measurements_.save(request_, saved_ == 0 ? outputs : numbered(outputs, saved_));
  ++saved_;
}

void Viewer::reset() {
  request_.objects_moved.clear();
  request_.sensor_moved = Pose::Identity();
  request_.number = 0;
  time_s_ = 0.0;
  message = "reset";
  update();
}

void Viewer::toggle_play() {
  if (!is_moving()) {
    message = "nothing moves; --object-rate X,Y,Z rotates the model";
    return;
  }
  is_playing_ = !is_playing_;
}

/// Whether the displayed scene is the requested one.
bool Viewer::is_open() const {
  return snapshot() != nullptr && snapshot()->request.flags == request_.flags;
}

double Viewer::rate_hz() const {
  const std::vector<ActiveSensor>& sensors = snapshot()->prepared->sensors;
  return sensors[std::min(request_.sensor_index, sensors.size() - 1)].sensor.rate_hz;
}

Eigen::Vector3d Viewer::middle_m() const {
  const std::vector<Eigen::Vector3d> corners_m = selection_.corners_m(snapshot()->frame);
  return corners_m.empty() ? anchor_m_ : sphere_around(corners_m).middle_m;
}

std::string Viewer::selected_name() const {
  const std::optional<std::size_t> object = selection_.object();
  if (!object || snapshot() == nullptr) return "all objects";
  return snapshot()->prepared->scene.instances[*object].name;
}

void Viewer::update_visibility() {
  visibility_ = Visibility::inside;
  const std::vector<Eigen::Vector3d> corners_m = selection_.corners_m(snapshot()->frame);
  if (!field_ || corners_m.empty()) return;
  visibility_ = visibility(*field_, snapshot()->frame.world_from_sensor, corners_m);
}

void Viewer::add_selection_box() {
  if (!selection_.object() || snapshot()->prepared->scene.instances.size() < 2) return;
  std::vector<Eigen::Vector3d> corners_m = selection_.corners_m(snapshot()->frame);
  for (Eigen::Vector3d& corner : corners_m) corner -= anchor_m_;
  add_boxes(corners_m, guides_);
}

void Viewer::aim_if_hidden() {
  // one correction at a time, after the previous one is measured
  if (!keeps_in_view_ || !field_ || !(snapshot()->request == request_)) return;
  const Eigen::Vector3d middle = middle_m();
  const Pose& world_from_sensor = snapshot()->frame.world_from_sensor;
  if (visibility(*field_, world_from_sensor, {&middle, 1}) == Visibility::inside) return;
  const std::optional<Pose> turned = aimed_at(*field_, world_from_sensor, middle);
  if (turned) set_sensor_pose(*turned);
}

void Viewer::set_keeps_in_view(bool is_on) {
  keeps_in_view_ = is_on;
  if (snapshot() != nullptr) aim_if_hidden();
}

void Viewer::select(std::optional<std::size_t> object) {
  if (!is_open()) return;
  selection_.select(object);
  update_visibility();
  aim_if_hidden();
  update_view();
}

void Viewer::frame_selected() {
  if (!is_open()) return;
  const std::vector<Eigen::Vector3d> corners_m = selection_.corners_m(snapshot()->frame);
  if (corners_m.empty()) {
    message = "nothing to frame: " + selected_name() + " without vertices";
    return;
  }
  Sphere sphere = sphere_around(corners_m);
  sphere.middle_m -= anchor_m_;
  frame_sphere(style.orbit, sphere, style.aspect);
  message = "framed " + selected_name();
  update_view();
  if (!field_) return;
  const auto pose = pose_to_show(*field_, snapshot()->frame.world_from_sensor, corners_m);
  if (!pose) return;
  message += "; aimed the sensor at it (r resets)";
  set_sensor_pose(*pose);
}

Pose& Viewer::moved_object(std::size_t object) {
  request_.objects_moved.resize(snapshot()->prepared->scene.instances.size(), Pose::Identity());
  return request_.objects_moved.at(object);
}

void Viewer::rotate_objects(const Eigen::Vector2d& drag) {
  if (!is_open()) return;
  const SensorAxes axes = axes_of(*snapshot()->beams);
  const Eigen::Matrix3d rotation = snapshot()->frame.world_from_sensor.linear();
  const Eigen::Vector3d right = rotation * -axes.left;
  const Eigen::Vector3d up = rotation * axes.up;
  // a point on the near side follows the pointer
  const Eigen::Vector3d turn_rad = std::numbers::pi * (drag.x() * up + drag.y() * right);
  const Pose turn = rotation_about(middle_m(), se3_exp(turn_rad, Eigen::Vector3d::Zero()));
  for (std::size_t i = 0; i < snapshot()->prepared->scene.instances.size(); ++i) {
    if (selection_.includes(i)) moved_object(i) = orthonormalized(turn * moved_object(i));
  }
  update();
}

void Viewer::step_sensor(double steps) {
  if (!is_open()) return;
  constexpr double kStep = 0.05;
  const Eigen::Vector3d way_m = middle_m() - snapshot()->frame.world_from_sensor.translation();
  const double share = 1.0 - portable_pow(1.0 - kStep, steps);
  request_.sensor_moved = translation_by(share * way_m) * request_.sensor_moved;
  update();
}

void Viewer::set_sensor_pose(const Pose& world_from_sensor) {
  if (!is_open()) return;
  const Snapshot& now = *snapshot();
  request_.sensor_moved = orthonormalized(
      world_from_sensor * now.frame.world_from_sensor.inverse() * now.request.sensor_moved);
  update();
}

void Viewer::set_object_pose(std::size_t object, const Pose& world_from_object) {
  if (!is_open()) return;
  const Snapshot& now = *snapshot();
  Pose moved_before = Pose::Identity();
  if (object < now.request.objects_moved.size()) moved_before = now.request.objects_moved[object];
  moved_object(object) = orthonormalized(
      world_from_object * now.frame.world_from_instance.at(object).inverse() * moved_before);
  update();
}

void Viewer::pick(std::optional<std::size_t> entry) {
  picked_ = entry;
  traced_.reset();
  trace.clear();
  if (entry) {
    is_playing_ = false;
    const std::uint32_t object = snapshot()->frame.ground_truth.instance[*entry];
    if (snapshot()->frame.status[*entry] == Status::hit && object != kInvalidId) select(object);
  }
  request_trace();
}

void Viewer::show_frame(std::uint32_t number) {
  if (number == request_.number) return;
  request_.number = number;
  update();
}

void Viewer::advance(double seconds) {
  if (!is_playing_ || !is_moving()) return;
  time_s_ += seconds;
  show_frame(static_cast<std::uint32_t>(time_s_ * rate_hz()));
}

std::optional<double> Viewer::next_frame_s() const {
  if (!is_playing_ || !is_moving()) return std::nullopt;
  return std::max(0.0, (request_.number + 1) / rate_hz() - time_s_);
}

}  // namespace glidar::app
