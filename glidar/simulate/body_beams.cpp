// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/simulate/body_beams.hpp>

#include <glidar/math/constants.hpp>
#include <glidar/motion/kinematics.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace glidar {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Bounds are widened by this part of a size, and by this part of a distance: many roundings.
constexpr double kSizeMargin = 1e-6;
constexpr double kDistanceMargin = 0x1p-40;

template <class Visit>
void for_each_beam(BeamRange range, const Visit& visit) {
  for (std::size_t i = range.begin; i < range.end; ++i) visit(i);
}

/// A part of the beam grid that fires within a short time: few enough beams that poses in the
/// middle of it suffice to reject most bodies.
class Slices {
 public:
  explicit Slices(const Beams& beams)
      : beams_(beams),
        height_(std::clamp(beams.rows, 1U, kMaxRows)),
        width_(kBeams / height_),
        across_((beams.cols + width_ - 1) / width_),
        down_((beams.rows + height_ - 1) / height_) {}

  [[nodiscard]] std::size_t size() const { return std::size_t{across_} * down_; }

  /// Calls visit(range) for the beams of a slice in runs that follow each other in the grid.
  template <class Visit>
  void for_runs(std::size_t slice, const Visit& visit) const {
    const auto first_row = static_cast<std::uint32_t>(slice / across_) * height_;
    const auto first_col = static_cast<std::uint32_t>(slice % across_) * width_;
    const std::uint32_t end_row = std::min(first_row + height_, beams_.rows);
    const std::uint32_t end_col = std::min(first_col + width_, beams_.cols);
    for (std::uint32_t row = first_row; row < end_row; ++row) {
      for (std::uint32_t col = first_col; col < end_col; col += kRun) {
        const std::size_t begin = std::size_t{row} * beams_.cols + col;
        visit(BeamRange{begin, begin + std::min(kRun, end_col - col)});
      }
    }
  }

  /// Calls visit(beam) for all beams of a slice.
  template <class Visit>
  void for_beams(std::size_t slice, const Visit& visit) const {
    for_runs(slice, [&](BeamRange run) { for_each_beam(run, visit); });
  }

 private:
  static constexpr std::uint32_t kBeams = 2048;
  static constexpr std::uint32_t kMaxRows = 128;
  static constexpr std::uint32_t kRun = 32;

  const Beams& beams_;
  std::uint32_t height_;
  std::uint32_t width_;
  std::uint32_t across_;
  std::uint32_t down_;
};

/// Encloses beams: they start in a ball, and their directions are within an angle of an axis.
struct Cone {
  Vector3d apex_m = Vector3d::Zero();
  double apex_radius_m = 0.0;
  Vector3d axis = Vector3d::UnitX();
  double cosine = -1.0;  ///< of the angle; not above 0: any direction
  double sine = 0.0;
  double farthest_m = -1.0;  ///< where hits matter; negative: there is no beam

  /// True if a beam may meet a sphere where hits matter.
  [[nodiscard]] bool meets(const Vector3d& centre_m, double radius_m) const {
    const Vector3d to_centre_m = centre_m - apex_m;
    const double radius = radius_m + apex_radius_m;
    const double distance_m = to_centre_m.norm();
    if (distance_m - radius > farthest_m) return false;
    if (!(distance_m > radius) || !(cosine > 0.0)) return true;  // also for NaN
    // The sphere is seen within the angle b of its centre, sin b = radius / distance: the angle to
    // the axis must be at most that of the cone plus b.
    const double tangent_m = std::sqrt(distance_m * distance_m - radius * radius);
    return axis.dot(to_centre_m) >=
           cosine * tangent_m - sine * radius - kDistanceMargin * distance_m;
  }
};

/// The beams of a cast, as all that is static sees them.
struct RestBeams {
  const Beams& beams;
  std::span<const double> nearest_m;

  [[nodiscard]] bool is_cast(std::size_t i) const { return beams.directions[i].allFinite(); }
  [[nodiscard]] Vector3d origin_m(std::size_t i) const {
    return beams.origins_m.empty() ? Vector3d(Vector3d::Zero()) : beams.origins_m[i];
  }
  /// Where hits of the beam matter.
  [[nodiscard]] double farthest_m(std::size_t i) const {
    return nearest_m.empty() || std::isnan(nearest_m[i]) ? kInfinity : nearest_m[i];
  }
};

/// `for_beams(visit)` calls visit(beam) for all beams.
template <class ForBeams>
Cone cone_around(const RestBeams& rest, const ForBeams& for_beams) {
  Cone cone;
  Vector3d sum = Vector3d::Zero();
  Eigen::AlignedBox3d origins_m;
  for_beams([&](std::size_t i) {
    if (!rest.is_cast(i)) return;
    sum += rest.beams.directions[i];
    origins_m.extend(rest.origin_m(i));
    cone.farthest_m = std::max(cone.farthest_m, rest.farthest_m(i));
  });
  if (origins_m.isEmpty()) return cone;
  cone.apex_m = origins_m.center();
  cone.apex_radius_m = (0.5 + kSizeMargin) * origins_m.diagonal().norm();
  const double length = sum.norm();
  if (!(length > 0.0)) return cone;
  cone.axis = sum / length;
  cone.cosine = 1.0;
  for_beams([&](std::size_t i) {
    if (rest.is_cast(i))
      cone.cosine = std::min(cone.cosine, cone.axis.dot(rest.beams.directions[i]));
  });
  cone.cosine -= kDistanceMargin;
  cone.sine = std::sqrt(std::max(0.0, 1.0 - cone.cosine * cone.cosine));
  return cone;
}

/// The pose of the sensor at a time relative to the body at rest, in the sensor's frame at the
/// start: S0^-1 * B0 * B^-1 * S with the poses B and S at that time. Positions are subtracted
/// first, for full precision far from the world's origin.
Pose start_from_sensor(const Pose& b0, const Pose& s0, const Pose& b, const Pose& s) {
  Pose pose = Pose::Identity();
  const Matrix3d back = s0.linear().transpose();
  const Matrix3d held = b0.linear() * b.linear().transpose();
  pose.linear() = back * held * s.linear();
  pose.translation() =
      back * (held * (s.translation() - b.translation()) + (b0.translation() - s0.translation()));
  return pose;
}

/// The distance at which a ray enters a box, at least 0; infinite: it does not. By slabs: T. L. Kay
/// and J. T. Kajiya, "Ray tracing complex scenes" (1986).
double entry_m(const Eigen::AlignedBox3d& box_m, const Vector3d& origin_m,
               const Vector3d& direction) {
  double enter = 0.0;
  double leave = kInfinity;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = box_m.min()[axis] - origin_m[axis];
    const double high = box_m.max()[axis] - origin_m[axis];
    const double d = direction[axis];
    if (d == 0.0) {
      if (low > 0.0 || high < 0.0) return kInfinity;
      continue;
    }
    enter = std::max(enter, std::min(low / d, high / d));
    leave = std::min(leave, std::max(low / d, high / d));
  }
  return enter <= leave ? enter : kInfinity;
}

/// Searches one frame.
class FrameSearch {
 public:
  FrameSearch(const TimedScene& timed, const CastRequest& request, const RestBeams& rest)
      : timed_(timed), request_(request), rest_(rest) {}

  /// The moving instances that have a surface, in order.
  void list_bodies(BodyBeamSearch& search) const {
    const Scene& scene = timed_.scene;
    search.mesh_boxes.resize(scene.meshes.size());
    search.bodies.clear();
    const TimeInterval frame = firing_interval([&](const auto& visit) {
      for_each_beam({0, request_.beams.size()}, visit);
    });
    for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
      const Instance& instance = scene.instances[i];
      if (is_static(timed_.motion.world_from_instance[i]) || !is_enabled(request_, i)) continue;
      std::optional<Eigen::AlignedBox3d>& box = search.mesh_boxes[instance.mesh];
      if (!box) box = bounds(scene.meshes[instance.mesh]);
      if (box->isEmpty()) continue;
      MovingBody body;
      body.instance = i;
      body.world_from_body = request_.world_from_instance[i];
      body.box_m = {instance.scale * box->min(), instance.scale * box->max()};
      place_sphere(body, frame, body.centre_m, body.radius_m);
      search.bodies.push_back(body);
    }
  }

  /// Lists pairs of a slice's beams and bodies, from body `next` on, until they are many.
  void search(const Slices& slices, std::size_t slice, std::span<const MovingBody> bodies,
              std::size_t& next, std::vector<BodyBeam>& found) const {
    constexpr std::size_t kMany = 4096;
    found.clear();
    if (next == bodies.size()) return;
    const auto for_beams = [&](const auto& visit) { slices.for_beams(slice, visit); };
    const Cone cone = cone_around(rest_, for_beams);
    const TimeInterval interval = firing_interval(for_beams);
    std::vector<Run> runs;
    if (cone.farthest_m < 0.0) next = bodies.size();
    for (; next < bodies.size() && found.size() < kMany; ++next) {
      const MovingBody& body = bodies[next];
      if (!cone.meets(body.centre_m, body.radius_m)) continue;
      Sphere sphere;
      place_sphere(body, interval, sphere.centre_m, sphere.radius_m);
      if (!cone.meets(sphere.centre_m, sphere.radius_m)) continue;
      if (runs.empty()) runs = runs_of(slices, slice);
      search_runs(runs, body, sphere, found);
    }
  }

 private:
  struct Sphere {
    Vector3d centre_m;
    double radius_m = 0.0;
  };

  struct Run {
    BeamRange range;
    Cone cone;
  };

  [[nodiscard]] std::int64_t firing_time_ns(std::size_t beam) const {
    const std::vector<std::uint32_t>& times_ns = request_.beams.times_ns;
    return timed_.stamp_ns + (times_ns.empty() ? 0 : times_ns[beam]);
  }

  template <class ForBeams>
  [[nodiscard]] TimeInterval firing_interval(const ForBeams& for_beams) const {
    TimeInterval interval{std::numeric_limits<std::int64_t>::max(),
                          std::numeric_limits<std::int64_t>::min()};
    for_beams([&](std::size_t i) {
      interval.first_ns = std::min(interval.first_ns, firing_time_ns(i));
      interval.last_ns = std::max(interval.last_ns, firing_time_ns(i));
    });
    return interval;
  }

  /// A sphere around the body's places during an interval, in the sensor's frame at the start.
  void place_sphere(const MovingBody& body, const TimeInterval& interval, Vector3d& centre_m,
                    double& radius_m) const {
    const Trajectory& trajectory = timed_.motion.world_from_instance[body.instance];
    const Pose& sensor = request_.world_from_sensor;
    const std::int64_t middle_ns = interval.first_ns + (interval.last_ns - interval.first_ns) / 2;
    const Pose pose = pose_at(trajectory, middle_ns);
    const Vector3d in_body_m = body.box_m.center();
    const Vector3d shift_m = pose.translation() - sensor.translation();
    centre_m = sensor.linear().transpose() * (pose.linear() * in_body_m + shift_m);
    const double far_m = pose.translation().norm() + sensor.translation().norm() + in_body_m.norm();
    radius_m =
        (1.0 + kSizeMargin) * (0.5 * body.box_m.diagonal().norm() +
                               max_displacement_m(trajectory, in_body_m, middle_ns, interval)) +
        kDistanceMargin * far_m;
  }

  [[nodiscard]] std::vector<Run> runs_of(const Slices& slices, std::size_t slice) const {
    std::vector<Run> runs;
    slices.for_runs(slice, [&](BeamRange range) {
      const auto for_beams = [&](const auto& visit) { for_each_beam(range, visit); };
      const Cone cone = cone_around(rest_, for_beams);
      if (cone.farthest_m >= 0.0) runs.push_back({range, cone});
    });
    return runs;
  }

  /// The beams of a slice as one body sees them.
  class BodyTest {
   public:
    BodyTest(const FrameSearch& frame, const MovingBody& body) : frame_(frame), body_(body) {
      const Pose& sensor = frame.request_.world_from_sensor;
      const Matrix3d body_from_world = body.world_from_body.linear().transpose();
      body_from_start_ = body_from_world * sensor.linear();
      sensor_in_body_m_ =
          body_from_world * (sensor.translation() - body.world_from_body.translation());
      const double far_m = body.world_from_body.translation().norm() + sensor.translation().norm() +
                           sensor_in_body_m_.norm();
      const double margin_m = kSizeMargin * body.box_m.diagonal().norm() + kDistanceMargin * far_m;
      box_m_ = {body.box_m.min().array() - margin_m, body.box_m.max().array() + margin_m};
    }

    /// Adds the beam if it meets the body's box where hits matter.
    void add(std::size_t beam, std::vector<BodyBeam>& found) {
      const Beams& beams = frame_.request_.beams;
      const Pose& pose = start_from_sensor_at(frame_.firing_time_ns(beam));
      const Vector3d direction = (pose.linear() * beams.directions[beam]).normalized();
      const Vector3d origin_m =
          beams.origins_m.empty() ? Vector3d(pose.translation()) : pose * beams.origins_m[beam];
      const Vector3d in_body_m = body_from_start_ * origin_m + sensor_in_body_m_;
      const double enter_m = entry_m(box_m_, in_body_m, body_from_start_ * direction);
      if (enter_m > frame_.rest_.farthest_m(beam) || std::isinf(enter_m)) return;
      found.push_back({beam, body_.instance, direction, origin_m, pose.linear()});
    }

   private:
    static constexpr std::size_t kKept = 128;

    struct KeptPose {
      bool is_set = false;
      std::int64_t t_ns = 0;
      Pose start_from_sensor;
    };

    /// Beams of a column mostly fire at once: the pose is kept for them.
    const Pose& start_from_sensor_at(std::int64_t t_ns) {
      constexpr std::uint64_t kScatter = 0x9E3779B97F4A7C15;  // 2^64 over the golden ratio
      KeptPose& kept = kept_[(static_cast<std::uint64_t>(t_ns) * kScatter) >> 57U];
      if (kept.is_set && kept.t_ns == t_ns) return kept.start_from_sensor;
      const Motion& motion = frame_.timed_.motion;
      kept.is_set = true;
      kept.t_ns = t_ns;
      kept.start_from_sensor =
          start_from_sensor(body_.world_from_body, frame_.request_.world_from_sensor,
                            pose_at(motion.world_from_instance[body_.instance], t_ns),
                            pose_at(motion.world_from_sensor, t_ns));
      return kept.start_from_sensor;
    }

    const FrameSearch& frame_;
    const MovingBody& body_;
    Matrix3d body_from_start_;
    Vector3d sensor_in_body_m_;
    Eigen::AlignedBox3d box_m_;
    std::array<KeptPose, kKept> kept_;
  };

  void search_runs(std::span<const Run> runs, const MovingBody& body, const Sphere& sphere,
                   std::vector<BodyBeam>& found) const {
    BodyTest test(*this, body);
    for (const Run& run : runs) {
      if (run.cone.meets(sphere.centre_m, sphere.radius_m)) {
        search_run(run.range, sphere, test, found);
      }
    }
  }

  void search_run(BeamRange run, const Sphere& sphere, BodyTest& test,
                  std::vector<BodyBeam>& found) const {
    for (std::size_t i = run.begin; i < run.end; ++i) {
      if (!rest_.is_cast(i)) continue;
      const Vector3d to_centre_m = sphere.centre_m - rest_.origin_m(i);
      const double along_m = std::max(0.0, to_centre_m.dot(rest_.beams.directions[i]));
      const double squared = (to_centre_m - along_m * rest_.beams.directions[i]).squaredNorm();
      if (squared > sphere.radius_m * sphere.radius_m) continue;
      if (along_m - sphere.radius_m > rest_.farthest_m(i)) continue;
      test.add(i, found);
    }
  }

  const TimedScene& timed_;
  const CastRequest& request_;
  const RestBeams& rest_;
};

}  // namespace

bool is_static(const Trajectory& trajectory) {
  return std::holds_alternative<ConstantPose>(trajectory);
}

bool find_body_beams(const TimedScene& scene, const CastRequest& request, const Beams& at_rest,
                     std::span<const double> nearest_m, BodyBeamSearch& search) {
  if (request.beams.size() == 0) return false;
  const RestBeams rest{at_rest, nearest_m};
  const FrameSearch frame(scene, request, rest);
  const Slices slices(request.beams);
  if (search.next_body.empty()) {
    frame.list_bodies(search);
    search.next_body.assign(slices.size(), 0);
    search.slices.resize(slices.size());
  }
  scene.renderer.thread_pool().parallel_for(
      slices.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          frame.search(slices, i, search.bodies, search.next_body[i], search.slices[i]);
        }
      });
  return std::any_of(search.slices.begin(), search.slices.end(),
                     [](const std::vector<BodyBeam>& found) { return !found.empty(); });
}

}  // namespace glidar
