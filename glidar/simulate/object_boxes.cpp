// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/simulate/object_boxes.hpp>

#include <glidar/motion/kinematics.hpp>
#include <glidar/simulate/simulation.hpp>

#include <algorithm>
#include <cmath>
#include <span>

namespace glidar {
namespace {

constexpr std::size_t kFiringsPerTask = 4096;

const Eigen::AlignedBox3d& surface_box(const Simulation& s, std::uint32_t mesh) {
  std::vector<std::optional<Eigen::AlignedBox3d>>& known = s.workspace.boxes.mesh_boxes;
  known.resize(s.scene.meshes.size());
  if (!known[mesh]) known[mesh] = surface_bounds(s.scene.meshes[mesh]);
  return *known[mesh];
}

/// The box of an instance, without what the sensor sees of it.
ObjectBox place_box(const Simulation& s, std::uint32_t i) {
  const Instance& instance = s.scene.instances[i];
  const Eigen::AlignedBox3d& own = surface_box(s, instance.mesh);
  const Pose object_from_box(Eigen::Translation3d(instance.scale * own.center()));
  const KinematicState centre = compose_extrinsic(
      state_at(s.motion.world_from_instance[i], s.frame.stamp_ns), object_from_box);
  const Pose& world_from_sensor = s.frame.world_from_sensor;
  const Eigen::Matrix3d sensor_from_world = world_from_sensor.linear().transpose();
  ObjectBox box{.instance = i};
  // positions are subtracted first, so that a scene far from its origin loses no precision
  const Pose& world_from_object = s.frame.world_from_instance[i];
  box.sensor_from_box.linear() = sensor_from_world * world_from_object.linear();
  box.sensor_from_box.translation() =
      sensor_from_world * (world_from_object.translation() - world_from_sensor.translation()) +
      box.sensor_from_box.linear() * object_from_box.translation();
  box.size_m = instance.scale * own.sizes();
  box.velocity_m_s = sensor_from_world * centre.velocity_m_s;
  return box;
}

/// How many of `count` hits are on each instance; `is_counted` selects them.
template <class Function>
std::vector<std::uint32_t> hits_per_instance(const Simulation& s, std::size_t count,
                                             const std::vector<std::uint32_t>& instances,
                                             Function is_counted) {
  std::vector<std::uint32_t> hits(s.scene.instances.size());
  for (std::size_t i = 0; i < count; ++i) {
    if (instances[i] != kInvalidId && is_counted(i)) ++hits[instances[i]];
  }
  return hits;
}

/// Counts the returns whose ground truth is one of the objects.
void count_points(const Simulation& s, std::span<ObjectBox> boxes) {
  const std::vector<Status>& status = s.frame.status;
  const std::vector<std::uint32_t> points =
      hits_per_instance(s, status.size(), s.frame.ground_truth.instance,
                        [&](std::size_t i) { return status[i] == Status::hit; });
  for (ObjectBox& box : boxes) box.points = points[box.instance];
}

/// One beam per firing, as the optics have them.
const Beams& nominal_beams(const Simulation& s) {
  if (s.beams.returns == 1) return s.beams;
  Beams& nominal = s.workspace.boxes.nominal;
  nominal = s.beams;
  nominal.returns = 1;
  nominal.rows /= s.beams.returns;
  const std::size_t firings = s.beams.firings();
  nominal.directions.resize(firings);
  if (!nominal.origins_m.empty()) nominal.origins_m.resize(firings);
  if (!nominal.times_ns.empty()) nominal.times_ns.resize(firings);
  if (!nominal.rings.empty()) nominal.rings.resize(firings);
  return nominal;
}

/// The instance that each nominal beam hits first. The frame has them where its beams are nominal.
const std::vector<std::uint32_t>& first_instances(const Simulation& s, const Beams& nominal) {
  if (!s.prepared.pulse_model && s.frame.true_directions.empty()) {
    return s.frame.ground_truth.instance;
  }
  Hits& hits = s.workspace.boxes.nominal_hits;
  cast(s, cast_request(s, nominal, {}), hits);
  return hits.instance;
}

/// Whether a beam crosses a box around the origin, by the slab test (Kay and Kajiya, "Ray tracing
/// complex scenes", SIGGRAPH 1986). The box is larger than the object by more than rounding.
bool crosses_box(const Eigen::Vector3d& half_m, const Eigen::Vector3d& origin,
                 const Eigen::Vector3d& direction) {
  double near = 0.0;
  double far = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    if (direction[axis] == 0.0) {
      if (std::abs(origin[axis]) > half_m[axis]) return false;
      continue;
    }
    const double inverse = 1.0 / direction[axis];
    const double middle = -origin[axis] * inverse;
    const double reach = std::abs(half_m[axis] * inverse);
    near = std::max(near, middle - reach);
    far = std::min(far, middle + reach);
  }
  return near <= far;  // false for a beam without a direction
}

/// An object whose beams are counted, and the beams as it sees them.
struct CountedObject {
  const Simulation& s;
  ObjectBox& box;
  const Beams& beams;
  const std::vector<std::uint32_t>& first;  ///< instance of each beam
};

/// Marks the beams that may hit the object behind another one, or beside what others hit.
void mark_candidates(const CountedObject& object) {
  constexpr double kMargin = 1e-6;
  const Pose box_from_sensor = object.box.sensor_from_box.inverse();
  const double distance_m = box_from_sensor.translation().norm();
  const double margin_m = kMargin * (object.box.size_m.norm() + 1e-3 * distance_m);
  const Eigen::Vector3d half_m = (0.5 * object.box.size_m).array() + margin_m;
  const Eigen::Matrix3d turn = box_from_sensor.linear();
  const Beams& beams = object.beams;
  std::vector<std::uint8_t>& crosses = object.s.workspace.boxes.crosses;
  crosses.assign(beams.size(), 0);
  const auto mark = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3d direction = turn * beams.directions[i];
      if (object.first[i] == object.box.instance || std::isnan(direction.x())) continue;
      Eigen::Vector3d origin = box_from_sensor.translation();
      if (!beams.origins_m.empty()) origin += turn * beams.origins_m[i];
      crosses[i] = static_cast<std::uint8_t>(crosses_box(half_m, origin, direction));
    }
  };
  object.s.renderer.thread_pool().parallel_for(beams.size(), kFiringsPerTask, mark);
}

/// The marked beams of a camera in a smaller camera, since some renderers know only cameras.
bool crop_camera(const CountedObject& object, Beams& cropped) {
  const Beams& beams = object.beams;
  const std::vector<std::uint8_t>& crosses = object.s.workspace.boxes.crosses;
  Eigen::AlignedBox<std::int64_t, 2> window;
  for (std::size_t i = 0; i < crosses.size(); ++i) {
    if (crosses[i] == 0) continue;
    window.extend(Eigen::Vector2<std::int64_t>(i % beams.cols, i / beams.cols));
  }
  if (window.isEmpty()) return false;
  PinholeIntrinsics camera = *beams.pinhole;
  const auto left = static_cast<std::uint32_t>(window.min().x());
  const auto top = static_cast<std::uint32_t>(window.min().y());
  camera.width = static_cast<std::uint32_t>(window.max().x()) - left + 1;
  camera.height = static_cast<std::uint32_t>(window.max().y()) - top + 1;
  camera.cx -= left;
  camera.cy -= top;
  cropped.rows = camera.height;
  cropped.cols = camera.width;
  cropped.directions.clear();
  for (std::uint32_t v = 0; v < camera.height; ++v) {
    for (std::uint32_t u = 0; u < camera.width; ++u) {
      cropped.directions.push_back(direction_through(plane_x(camera, u), plane_y(camera, v)));
    }
  }
  cropped.pinhole = camera;
  return true;
}

/// The marked beams in one row.
bool select_candidates(const CountedObject& object, Beams& selected) {
  const Beams& beams = object.beams;
  const std::vector<std::uint8_t>& crosses = object.s.workspace.boxes.crosses;
  selected.directions.clear();
  for (std::size_t i = 0; i < crosses.size(); ++i) {
    if (crosses[i] == 0) continue;
    selected.directions.push_back(beams.directions[i]);
    if (!beams.origins_m.empty()) selected.origins_m.push_back(beams.origins_m[i]);
  }
  selected.rows = 1;
  selected.cols = static_cast<std::uint32_t>(selected.directions.size());
  return selected.cols > 0;
}

/// Casts the candidates into the object alone.
bool cast_alone(const CountedObject& object) {
  const Simulation& s = object.s;
  BoxWorkspace& memory = s.workspace.boxes;
  Beams& candidates = memory.candidates;
  candidates.boresight = object.beams.boresight;
  candidates.origins_m.clear();
  candidates.pinhole.reset();
  const bool is_camera = object.beams.pinhole && object.beams.origins_m.empty();
  if (is_camera ? !crop_camera(object, candidates) : !select_candidates(object, candidates)) {
    return false;
  }
  memory.is_object.assign(s.scene.instances.size(), 0);
  memory.is_object[object.box.instance] = 1;
  CastRequest request = cast_request(s, candidates, {});
  request.instance_enabled = memory.is_object;
  request.beams_recur = false;
  s.renderer.cast(request, memory.hits);
  return true;
}

/// Counts the beams that hit the object behind others, which were cast. Of a cropped camera only
/// those that are no other's: its other pixels hit the object first and are already counted.
std::uint32_t count_hidden(const CountedObject& object) {
  if (!cast_alone(object)) return 0;
  const BoxWorkspace& memory = object.s.workspace.boxes;
  const std::vector<std::uint32_t>& alone = memory.hits.instance;
  if (!memory.candidates.pinhole) {
    return static_cast<std::uint32_t>(std::count(alone.begin(), alone.end(), object.box.instance));
  }
  const PinholeIntrinsics& whole = *object.beams.pinhole;
  const PinholeIntrinsics& part = *memory.candidates.pinhole;
  const auto left = static_cast<std::size_t>(std::lround(whole.cx - part.cx));
  const auto top = static_cast<std::size_t>(std::lround(whole.cy - part.cy));
  std::uint32_t count = 0;
  for (std::size_t k = 0; k < alone.size(); ++k) {
    const std::size_t pixel = (top + k / part.width) * object.beams.cols + left + k % part.width;
    const bool is_hidden = memory.crosses[pixel] != 0 && alone[k] == object.box.instance;
    count += static_cast<std::uint32_t>(is_hidden);
  }
  return count;
}

bool is_at_rest(const Simulation& s, std::uint32_t instance) {
  return std::holds_alternative<ConstantPose>(s.motion.world_from_instance[instance]);
}

/// Counts the beams that would hit each object, and that do.
void count_beams(const Simulation& s, std::span<ObjectBox> boxes) {
  const Beams& nominal = nominal_beams(s);
  const std::vector<std::uint32_t>& first = first_instances(s, nominal);
  const std::vector<std::uint32_t> visible =
      hits_per_instance(s, nominal.size(), first, [](std::size_t) { return true; });
  const CastRequest request = cast_request(s, nominal, {});
  const Beams* beams = &nominal;
  std::optional<std::uint32_t> seen_by;  ///< the body as which `beams` are expressed
  for (ObjectBox& box : boxes) {
    const std::uint32_t body = is_at_rest(s, box.instance) ? kInvalidId : box.instance;
    if (s.is_moving && seen_by != body) {
      beams = &beams_at_rest(timed_scene(s), request, body, s.workspace.boxes.moving);
      seen_by = body;
    }
    box.visible_beams = visible[box.instance];
    const CountedObject object{s, box, *beams, first};
    mark_candidates(object);
    box.beams = box.visible_beams + count_hidden(object);
  }
}

}  // namespace

void find_boxes(const Simulation& s, BoxSelection selection, std::vector<ObjectBox>& boxes) {
  boxes.clear();
  for (std::uint32_t i = 0; i < s.scene.instances.size(); ++i) {
    const Instance& instance = s.scene.instances[i];
    if (selection == BoxSelection::with_class && instance.class_id == 0) continue;
    if (!surface_box(s, instance.mesh).isEmpty()) boxes.push_back(place_box(s, i));
  }
  if (boxes.empty()) return;
  count_points(s, boxes);
  count_beams(s, boxes);
}

}  // namespace glidar
