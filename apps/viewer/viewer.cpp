// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/viewer/viewer.hpp>

#include <apps/glidar/run/outputs.hpp>
#include <apps/viewer/cloud_points.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace glidar::app {
namespace {

/// The flags of a file that is opened beside the first: only how to measure stays.
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

Pose shifted(const Eigen::Vector3d& by_m) {
  return Pose(Eigen::Translation3d(by_m));
}

/// A rotation of the world about a point.
Pose turned_about(const Eigen::Vector3d& point_m, const Eigen::AngleAxisd& by) {
  return shifted(point_m) * Pose(by) * shifted(-point_m);
}

bool stands_still(const Trajectory& trajectory) {
  return std::holds_alternative<ConstantPose>(trajectory);
}

/// The pose without what rounding did to its rotation after many small turns.
Pose tidy(const Pose& pose) {
  return make_pose(pose.translation(), Eigen::Quaterniond(pose.linear()).normalized());
}

}  // namespace

Viewer::Viewer(const RenderFlags& flags, Measuring& measuring) : measuring_(measuring) {
  ask_.seed = flags.seed;
  ask_for(flags);
}

void Viewer::ask_for(const RenderFlags& flags) {
  ask_.flags = std::make_shared<RenderFlags>(flags);
  update();
}

void Viewer::update() {
  measuring_.measure(ask_);
}

bool Viewer::is_moving() const {
  if (!shot()) return false;
  const Motion& motion = shot()->motion;
  return !stands_still(motion.world_from_sensor) ||
         !std::all_of(motion.world_from_instance.begin(), motion.world_from_instance.end(),
                      stands_still);
}

bool Viewer::take_news() {
  const Snapshot* before = shot();
  const std::string busy_before = news_.busy;
  measuring_.take(news_);
  errors.insert(errors.end(), news_.errors.begin(), news_.errors.end());
  if (!news_.messages.empty()) message = news_.messages.back();
  if (news_.story) story = *news_.story;
  if (news_.is_refused && shot()) {
    ask_.flags = shot()->ask.flags;
    ask_.mount = shot()->ask.mount;
    ask_.objects_moved = shot()->ask.objects_moved;
    ask_.sensor_moved = shot()->ask.sensor_moved;
  }
  const bool is_new = shot() != before;
  if (is_new) show_shot(shot()->ask.flags != shown_flags_);
  return is_new || news_.story || !news_.errors.empty() || !news_.messages.empty() ||
         news_.busy != busy_before;
}

/// Looks at what was opened from where all of it is seen.
void Viewer::begin_session() {
  const Snapshot& now = *shot();
  selection_.begin(now.session->scene, shown_flags_ && shown_flags_->input == now.ask.flags->input);
  shown_flags_ = now.ask.flags;
  const Eigen::AlignedBox3d box = bounds(now.session->scene);
  anchor_m_ = box.isEmpty() ? Eigen::Vector3d(now.frame.world_from_sensor.translation())
                            : Eigen::Vector3d(box.center());
  const Eigen::Vector3d sensor_m = now.frame.world_from_sensor.translation() - anchor_m_;
  Eigen::AlignedBox3d anchored = box;
  if (!box.isEmpty()) anchored.translate(-anchor_m_);
  look.orbit = view_of_all(anchored, sensor_m, look.aspect);
  const std::vector<std::string> advice =
      view_advice({now.session->scene, *now.sensor, *now.beams, now.frame});
  if (!advice.empty()) message = advice.front();
}

void Viewer::begin_sensor() {
  const Beams& beams = *shot()->beams;
  shown_mount_ = shot()->ask.mount;
  field_ = field_of_view(beams);
  const bool is_camera = looks_along_z(beams);
  if (look.quantity == Quantity::depth && !is_camera) look.quantity = Quantity::range;
  if (look.quantity == Quantity::range && is_camera) look.quantity = Quantity::depth;
}

void Viewer::show_shot(bool is_new_session) {
  if (is_new_session) begin_session();
  if (is_new_session || shot()->ask.mount != shown_mount_) begin_sensor();
  look_for_selection();
  keep_in_view();
  summary_ = summarise(shot()->frame);
  if (picked_ && *picked_ >= shot()->beams->size()) pick({});
  tell_story();
  look_changed();
}

void Viewer::tell_story() {
  if (!picked_ || !shot() || (told_ && *told_ == shot()->ask)) return;
  told_ = shot()->ask;
  measuring_.explain(*told_, *picked_);
}

void Viewer::look_changed() {
  if (!shot()) return;
  const Snapshot& now = *shot();
  make_sensor_picture(now.frame, *now.beams, now.session->scene, look.quantity, look.map, picture_);
  make_cloud_points(now, anchor_m_, points_);
  guides_.clear();
  const Pose anchor_from_sensor = shifted(-anchor_m_) * now.frame.world_from_sensor;
  const double distance_m = anchor_from_sensor.translation().norm();
  const double extent_m = std::max(look.orbit.distance_m, 1e-6);
  look.grid_m = grid_spacing_m(2.0 * extent_m);
  const Eigen::AlignedBox3d box = bounds(now.session->scene);
  const double floor_m = box.isEmpty() ? 0.0 : box.min().z() - anchor_m_.z();
  add_grid({0.0, 0.0, floor_m}, extent_m, look.grid_m, guides_);
  add_axes(shifted({0.0, 0.0, floor_m}), look.grid_m, guides_);
  add_axes(anchor_from_sensor, look.grid_m, guides_);
  add_frustum(*now.beams, anchor_from_sensor, std::max(distance_m, look.grid_m), guides_);
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
  ask_.objects_moved.clear();
  ask_.sensor_moved = Pose::Identity();
  ask_.mount = 0;
  ask_.number = 0;
  time_s_ = 0.0;
  pick({});
  ask_for(for_file(*ask_.flags, path));
}

void Viewer::use_sensor(const std::string& preset) {
  RenderFlags flags = *ask_.flags;
  flags.sensor = {};
  flags.sensor.file = preset;
  flags.pose.world_from_sensor.reset();
  ask_.sensor_moved = Pose::Identity();
  pick({});
  ask_for(flags);
}

void Viewer::use_renderer(const std::string& kind) {
  RenderFlags flags = *ask_.flags;
  flags.renderer.kind = kind;
  if (kind != "opengl") flags.quantized_framebuffer = false;
  ask_for(flags);
}

void Viewer::use_mount(std::size_t index) {
  if (!is_open() || index == ask_.mount || index >= shot()->session->mounts.size()) return;
  ask_.mount = index;
  ask_.number = static_cast<std::uint32_t>(time_s_ * rate_hz());
  pick({});
  update();
}

void Viewer::set_noise(bool is_on) {
  ask_.has_noise = is_on;
  update();
}

void Viewer::set_seed(std::uint64_t seed) {
  ask_.seed = seed;
  update();
}

void Viewer::save() {
  if (!shot()) return;
  OutputFlags outputs = ask_.flags->output;
  if (outputs.paths.empty() && outputs.legacy_name.empty()) outputs.legacy_name = "buffer";
  measuring_.save(ask_, saved_ == 0 ? outputs : numbered(outputs, saved_));
  ++saved_;
}

void Viewer::reset() {
  ask_.objects_moved.clear();
  ask_.sensor_moved = Pose::Identity();
  ask_.number = 0;
  time_s_ = 0.0;
  message = "back to the start";
  update();
}

void Viewer::toggle_play() {
  if (!is_moving()) {
    message = "nothing moves; --object-rate X,Y,Z turns the model";
    return;
  }
  is_playing_ = !is_playing_;
}

/// Whether what is shown is of the file and the options requested last.
bool Viewer::is_open() const {
  return shot() != nullptr && shot()->ask.flags == ask_.flags;
}

double Viewer::rate_hz() const {
  const std::vector<Mount>& mounts = shot()->session->mounts;
  return mounts[std::min(ask_.mount, mounts.size() - 1)].sensor.rate_hz;
}

Eigen::Vector3d Viewer::middle_m() const {
  const std::vector<Eigen::Vector3d> corners_m = selection_.corners_m(shot()->frame);
  return corners_m.empty() ? anchor_m_ : sphere_around(corners_m).middle_m;
}

std::string Viewer::selected_name() const {
  const std::optional<std::size_t> object = selection_.object();
  if (!object || shot() == nullptr) return "all objects";
  return shot()->session->scene.instances[*object].name;
}

void Viewer::look_for_selection() {
  visibility_ = Visibility::inside;
  const std::vector<Eigen::Vector3d> corners_m = selection_.corners_m(shot()->frame);
  if (!field_ || corners_m.empty()) return;
  visibility_ = visibility(*field_, shot()->frame.world_from_sensor, corners_m);
}

/// Shows which of several objects is selected.
void Viewer::add_selection_box() {
  if (!selection_.object() || shot()->session->scene.instances.size() < 2) return;
  std::vector<Eigen::Vector3d> corners_m = selection_.corners_m(shot()->frame);
  for (Eigen::Vector3d& corner : corners_m) corner -= anchor_m_;
  add_boxes(corners_m, guides_);
}

void Viewer::keep_in_view() {
  // one correction at a time: the next one only once this one is measured
  if (!keeps_in_view_ || !field_ || !(shot()->ask == ask_)) return;
  const Eigen::Vector3d middle = middle_m();
  const Pose& world_from_sensor = shot()->frame.world_from_sensor;
  if (visibility(*field_, world_from_sensor, {&middle, 1}) == Visibility::inside) return;
  const std::optional<Pose> turned = turned_towards(*field_, world_from_sensor, middle);
  if (turned) set_sensor_pose(*turned);
}

void Viewer::set_keeps_in_view(bool is_on) {
  keeps_in_view_ = is_on;
  if (shot() != nullptr) keep_in_view();
}

void Viewer::select(std::optional<std::size_t> object) {
  if (!is_open()) return;
  selection_.select(object);
  look_for_selection();
  keep_in_view();
  look_changed();
}

void Viewer::frame_selected() {
  if (!is_open()) return;
  const std::vector<Eigen::Vector3d> corners_m = selection_.corners_m(shot()->frame);
  if (corners_m.empty()) {
    message = "nothing to frame: " + selected_name() + " without vertices";
    return;
  }
  Sphere sphere = sphere_around(corners_m);
  sphere.middle_m -= anchor_m_;
  frame_sphere(look.orbit, sphere, look.aspect);
  message = "framed " + selected_name();
  look_changed();
  if (!field_) return;
  const std::optional<Pose> pose =
      pose_that_shows(*field_, shot()->frame.world_from_sensor, corners_m);
  if (!pose) return;
  message += "; aimed the sensor at it (r resets)";
  set_sensor_pose(*pose);
}

Pose& Viewer::moved_object(std::size_t object) {
  ask_.objects_moved.resize(shot()->session->scene.instances.size(), Pose::Identity());
  return ask_.objects_moved.at(object);
}

void Viewer::turn_objects(const Eigen::Vector2d& drag) {
  if (!is_open()) return;
  const SensorAxes axes = axes_of(*shot()->beams);
  const Eigen::Matrix3d rotation = shot()->frame.world_from_sensor.linear();
  const Eigen::Vector3d right = rotation * -axes.left;
  const Eigen::Vector3d up = rotation * axes.up;
  // a point on the near side follows the pointer
  const Eigen::Vector3d turn_rad = std::numbers::pi * (drag.x() * up + drag.y() * right);
  const double angle_rad = turn_rad.norm();
  if (angle_rad == 0.0) return;
  const Pose turn = turned_about(middle_m(), Eigen::AngleAxisd(angle_rad, turn_rad / angle_rad));
  for (std::size_t i = 0; i < shot()->session->scene.instances.size(); ++i) {
    if (selection_.includes(i)) moved_object(i) = tidy(turn * moved_object(i));
  }
  update();
}

void Viewer::step_sensor(double steps) {
  if (!is_open()) return;
  constexpr double kStep = 0.05;
  const Eigen::Vector3d way_m = middle_m() - shot()->frame.world_from_sensor.translation();
  const double share = 1.0 - std::pow(1.0 - kStep, steps);
  ask_.sensor_moved = shifted(share * way_m) * ask_.sensor_moved;
  update();
}

void Viewer::set_sensor_pose(const Pose& world_from_sensor) {
  if (!is_open()) return;
  const Snapshot& now = *shot();
  ask_.sensor_moved =
      tidy(world_from_sensor * now.frame.world_from_sensor.inverse() * now.ask.sensor_moved);
  update();
}

void Viewer::set_object_pose(std::size_t object, const Pose& world_from_object) {
  if (!is_open()) return;
  const Snapshot& now = *shot();
  Pose moved_before = Pose::Identity();
  if (object < now.ask.objects_moved.size()) moved_before = now.ask.objects_moved[object];
  moved_object(object) =
      tidy(world_from_object * now.frame.world_from_instance.at(object).inverse() * moved_before);
  update();
}

void Viewer::pick(std::optional<std::size_t> entry) {
  picked_ = entry;
  told_.reset();
  story.clear();
  if (entry) {
    is_playing_ = false;
    const std::uint32_t object = shot()->frame.ground_truth.instance[*entry];
    if (shot()->frame.status[*entry] == Status::hit && object != kInvalidId) select(object);
  }
  tell_story();
}

void Viewer::turn_to(std::uint32_t number) {
  if (number == ask_.number) return;
  ask_.number = number;
  update();
}

void Viewer::advance(double seconds) {
  if (!is_playing_ || !is_moving()) return;
  time_s_ += seconds;
  turn_to(static_cast<std::uint32_t>(time_s_ * rate_hz()));
}

std::optional<double> Viewer::next_frame_s() const {
  if (!is_playing_ || !is_moving()) return std::nullopt;
  return std::max(0.0, (ask_.number + 1) / rate_hz() - time_s_);
}

}  // namespace glidar::app
