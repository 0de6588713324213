// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/simulate/object_boxes.hpp>

#include <glidar/math/portable.hpp>
#include <glidar/motion/kinematics.hpp>
#include <glidar/simulate/simulation.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
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
  // positions are subtracted first, for full precision far from the world's origin
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

/// The beams as objects see them that are at rest, or move alike.
struct ObservedBeams {
  const Simulation& s;
  const Beams& beams;
  double reach_m;                           ///< greatest distance of an origin of a beam
  const std::vector<std::uint32_t>& first;  ///< instance of each beam
};

/// The firings whose beams pass near the sphere around an object's box.
const std::vector<std::uint32_t>& firings_near(const ObservedBeams& observed, const ObjectBox& box,
                                               double radius_m) {
  BoxWorkspace& memory = observed.s.workspace.boxes;
  const Eigen::Vector3d& centre_m = box.sensor_from_box.translation();
  const double distance_m = centre_m.norm();
  const double sine = (radius_m + observed.reach_m) / distance_m;
  const double angle_rad = sine < 1.0 ? portable_asin(sine) : std::numbers::pi;
  memory.grid.find(centre_m / distance_m, angle_rad, memory.near);
  return memory.near;
}

/// Appends the firings to `crossing` whose beams may hit the object behind another one, or beside
/// what others hit. Returns how many these are.
std::size_t find_crossing(const ObservedBeams& observed, const ObjectBox& box) {
  constexpr double kMargin = 1e-6;
  const Pose box_from_sensor = box.sensor_from_box.inverse();
  const double distance_m = box_from_sensor.translation().norm();
  const double margin_m = kMargin * (box.size_m.norm() + 1e-3 * distance_m);
  const Eigen::Vector3d half_m = (0.5 * box.size_m).array() + margin_m;
  const Eigen::Matrix3d turn = box_from_sensor.linear();
  const Beams& beams = observed.beams;
  BoxWorkspace& memory = observed.s.workspace.boxes;
  const std::vector<std::uint32_t>& near = firings_near(observed, box, half_m.norm() + margin_m);
  const auto mark = [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const std::uint32_t i = near[k];
      const Eigen::Vector3d direction = turn * beams.directions[i];
      Eigen::Vector3d origin = box_from_sensor.translation();
      if (!beams.origins_m.empty()) origin += turn * beams.origins_m[i];
      memory.crosses[i] = static_cast<std::uint8_t>(observed.first[i] != box.instance &&
                                                    crosses_box(half_m, origin, direction));
    }
  };
  observed.s.renderer.thread_pool().parallel_for(near.size(), kFiringsPerTask, mark);
  const std::size_t before = memory.crossing.size();
  std::copy_if(near.begin(), near.end(), std::back_inserter(memory.crossing),
               [&](std::uint32_t i) { return memory.crosses[i] != 0; });
  return memory.crossing.size() - before;
}

/// An object and its part of `crossing`, of which it is the only owner while they are cast.
struct CrossedObject {
  std::uint32_t instance;
  std::span<const std::uint32_t> firings;
};

/// Whether no other object that is cast into has one of the firings, or would be hit by one.
bool is_apart(const ObservedBeams& observed, const CrossedObject& object) {
  const BoxWorkspace& memory = observed.s.workspace.boxes;
  const auto is_free = [&](std::uint32_t i) {
    const std::uint32_t first = observed.first[i];
    return memory.owners[i] == kInvalidId && (first == kInvalidId || memory.is_object[first] == 0);
  };
  return memory.hides[object.instance] == 0 &&
         std::all_of(object.firings.begin(), object.firings.end(), is_free);
}

/// Gives their firings to objects, in their order, that do not affect each other. The other objects
/// stay in the list.
void claim_firings(const ObservedBeams& observed, std::vector<CrossedObject>& objects) {
  BoxWorkspace& memory = observed.s.workspace.boxes;
  std::fill(memory.is_object.begin(), memory.is_object.end(), std::uint8_t{0});
  std::fill(memory.hides.begin(), memory.hides.end(), std::uint8_t{0});
  memory.owned.clear();
  const auto claim = [&](const CrossedObject& object) {
    if (!is_apart(observed, object)) return false;
    for (const std::uint32_t i : object.firings) {
      memory.owners[i] = object.instance;
      if (observed.first[i] != kInvalidId) memory.hides[observed.first[i]] = 1;
    }
    memory.owned.insert(memory.owned.end(), object.firings.begin(), object.firings.end());
    memory.is_object[object.instance] = 1;
    return true;
  };
  objects.erase(std::remove_if(objects.begin(), objects.end(), claim), objects.end());
  std::sort(memory.owned.begin(), memory.owned.end());
}

/// A smaller camera around the firings with an owner, since some renderers know only cameras.
/// `owned` then has all its pixels.
void crop_camera(const Beams& beams, BoxWorkspace& memory) {
  Eigen::AlignedBox<std::int64_t, 2> window;
  for (const std::uint32_t i : memory.owned) {
    window.extend(Eigen::Vector2<std::int64_t>(i % beams.cols, i / beams.cols));
  }
  PinholeIntrinsics camera = *beams.pinhole;
  const auto left = static_cast<std::uint32_t>(window.min().x());
  const auto top = static_cast<std::uint32_t>(window.min().y());
  camera.width = static_cast<std::uint32_t>(window.max().x()) - left + 1;
  camera.height = static_cast<std::uint32_t>(window.max().y()) - top + 1;
  camera.cx -= left;
  camera.cy -= top;
  Beams& cropped = memory.candidates;
  cropped.rows = camera.height;
  cropped.cols = camera.width;
  memory.owned.clear();
  for (std::uint32_t v = 0; v < camera.height; ++v) {
    for (std::uint32_t u = 0; u < camera.width; ++u) {
      cropped.directions.push_back(direction_through(plane_x(camera, u), plane_y(camera, v)));
      memory.owned.push_back((top + v) * beams.cols + left + u);
    }
  }
  cropped.pinhole = camera;
}

/// The firings with an owner in one row.
void select_owned(const Beams& beams, BoxWorkspace& memory) {
  Beams& selected = memory.candidates;
  for (const std::uint32_t i : memory.owned) {
    selected.directions.push_back(beams.directions[i]);
    if (!beams.origins_m.empty()) selected.origins_m.push_back(beams.origins_m[i]);
  }
  selected.rows = 1;
  selected.cols = static_cast<std::uint32_t>(selected.directions.size());
}

/// Casts the firings with an owner into all owners, and counts those that hit their own.
void count_owned(const ObservedBeams& observed) {
  const Simulation& s = observed.s;
  BoxWorkspace& memory = s.workspace.boxes;
  Beams& candidates = memory.candidates;
  candidates.boresight = observed.beams.boresight;
  candidates.directions.clear();
  candidates.origins_m.clear();
  candidates.pinhole.reset();
  if (observed.beams.pinhole && observed.beams.origins_m.empty()) {
    crop_camera(observed.beams, memory);
  } else {
    select_owned(observed.beams, memory);
  }
  CastRequest request = cast_request(s, candidates, {});
  request.instance_enabled = memory.is_object;
  s.renderer.cast(request, memory.hits);
  for (std::size_t k = 0; k < memory.owned.size(); ++k) {
    std::uint32_t& owner = memory.owners[memory.owned[k]];
    if (owner == kInvalidId) continue;
    if (memory.hits.instance[k] == owner) ++memory.hidden[owner];
    owner = kInvalidId;
  }
}

/// Counts the beams that hit each object behind others. Objects are cast into at once where no beam
/// that crosses the box of one of them can hit another one.
void count_hidden(const ObservedBeams& observed, std::vector<CrossedObject>& objects) {
  BoxWorkspace& memory = observed.s.workspace.boxes;
  while (!objects.empty()) {
    claim_firings(observed, objects);
    count_owned(observed);
  }
  memory.crossing.clear();
}

/// Counts the hidden beams of objects that see the beams alike.
void count_hidden(const ObservedBeams& observed, std::span<const ObjectBox> boxes) {
  constexpr std::size_t kMaxCrossing = 1U << 22U;  // bounds the memory of many large objects
  BoxWorkspace& memory = observed.s.workspace.boxes;
  memory.crossing.clear();
  memory.crossing.reserve(kMaxCrossing + observed.beams.size());
  std::vector<CrossedObject> objects;
  for (const ObjectBox& box : boxes) {
    const std::size_t count = find_crossing(observed, box);
    if (count > 0) objects.push_back({box.instance, std::span(memory.crossing).last(count)});
    if (memory.crossing.size() > kMaxCrossing) count_hidden(observed, objects);
  }
  count_hidden(observed, objects);
}

bool is_at_rest(const Simulation& s, std::uint32_t instance) {
  return is_static(s.motion.world_from_instance[instance]);
}

double greatest_norm(const std::vector<Eigen::Vector3d>& vectors) {
  double greatest = 0.0;
  for (const Eigen::Vector3d& vector : vectors) greatest = std::max(greatest, vector.norm());
  return greatest;
}

/// Counts the hidden beams of objects that see these beams alike.
void count_hidden_of(const Simulation& s, const Beams& beams,
                     const std::vector<std::uint32_t>& first, std::span<const ObjectBox> boxes) {
  s.workspace.boxes.grid.build(beams.directions);
  count_hidden({s, beams, greatest_norm(beams.origins_m), first}, boxes);
}

/// Counts the hidden beams while something moves. Those of a moving object are the beams that would
/// hit it alone, without those that hit it first.
void count_hidden_in_motion(const Simulation& s, const Beams& nominal,
                            const std::vector<std::uint32_t>& first,
                            std::span<const ObjectBox> boxes) {
  BoxWorkspace& memory = s.workspace.boxes;
  const CastRequest request = cast_request(s, nominal, {});
  count_body_hits(timed_scene(s), request, memory.moving, memory.hidden);
  for (const std::uint32_t instance : first) {
    if (instance == kInvalidId || is_at_rest(s, instance)) continue;
    std::uint32_t& hidden = memory.hidden[instance];
    hidden -= hidden > 0 ? 1 : 0;  // another renderer may have found the first hits
  }
  std::vector<ObjectBox> at_rest;
  std::copy_if(boxes.begin(), boxes.end(), std::back_inserter(at_rest),
               [&](const ObjectBox& box) { return is_at_rest(s, box.instance); });
  if (at_rest.empty()) return;
  count_hidden_of(s, beams_at_rest(timed_scene(s), request, memory.moving), first, at_rest);
}

/// Counts the beams that would hit each object, and that do.
void count_beams(const Simulation& s, std::span<ObjectBox> boxes) {
  BoxWorkspace& memory = s.workspace.boxes;
  const Beams& nominal = nominal_beams(s);
  const std::vector<std::uint32_t>& first = first_instances(s, nominal);
  memory.crosses.resize(nominal.size());
  memory.owners.assign(nominal.size(), kInvalidId);
  memory.is_object.resize(s.scene.instances.size());
  memory.hides.resize(s.scene.instances.size());
  memory.hidden.assign(s.scene.instances.size(), 0);
  if (s.is_moving) {
    count_hidden_in_motion(s, nominal, first, boxes);
  } else {
    count_hidden_of(s, nominal, first, boxes);
  }
  const std::vector<std::uint32_t> visible =
      hits_per_instance(s, nominal.size(), first, [](std::size_t) { return true; });
  for (ObjectBox& box : boxes) {
    box.visible_beams = visible[box.instance];
    box.beams = box.visible_beams + memory.hidden[box.instance];
  }
}

}  // namespace

void find_boxes(const Simulation& s, BoxSelection selection, std::vector<ObjectBox>& boxes) {
  boxes.clear();
  BoxedClasses classes = s.workspace.boxes.classes;
  if (selection == BoxSelection::all) classes.assign(s.scene.class_names.size(), true);
  if (classes.empty()) classes = boxed_classes(s.scene.class_names);
  for (std::uint32_t i = 0; i < s.scene.instances.size(); ++i) {
    const Instance& instance = s.scene.instances[i];
    if (!classes[instance.class_id]) continue;
    if (!is_visible(instance, s.frame.sensor_id)) continue;
    if (!surface_box(s, instance.mesh).isEmpty()) boxes.push_back(place_box(s, i));
  }
  if (boxes.empty()) return;
  count_points(s, boxes);
  count_beams(s, boxes);
}

}  // namespace glidar
