// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <python/src/motion.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/config/motion_keys.hpp>
#include <glidar/io/formats/trajectory_file.hpp>
#include <glidar/motion/motion.hpp>

#include <nanobind/eigen/dense.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

namespace glidar::python {
namespace {

constexpr double kExact = 1e-9;
constexpr double kAsFloat = 1e-4;  // tolerance for rotations that were rounded to float32

Pose single(const PoseArray& pose) {
  return pose_of(pose, 0, "pose");
}

Trajectories constant(const PoseArray& poses, const std::string& name) {
  Trajectories result;
  result.all.reserve(poses.shape(0));
  for (std::size_t k = 0; k < poses.shape(0); ++k) {
    result.all.emplace_back(ConstantPose{pose_of(poses, k, name)});
  }
  return result;
}

Trajectories one(Trajectory trajectory) {
  validate(trajectory);
  return {{std::move(trajectory)}};
}

Trajectories spin(const PoseArray& pose, const Eigen::Vector3d& rate_rad_s, std::int64_t t0_ns) {
  return one(Spin{.pose = single(pose), .rate_rad_s = rate_rad_s, .t0_ns = t0_ns});
}

Trajectories twist(const PoseArray& pose, const Eigen::Vector3d& angular_rad_s,
                   const Eigen::Vector3d& linear_m_s, bool in_world, std::int64_t t0_ns) {
  return one(ConstantTwist{.pose = single(pose),
                           .angular_rad_s = angular_rad_s,
                           .linear_m_s = linear_m_s,
                           .frame = in_world ? TwistFrame::world : TwistFrame::body,
                           .t0_ns = t0_ns});
}

Interpolation interpolation_of(bool is_spline) {
  return is_spline ? Interpolation::spline : Interpolation::linear;
}

Trajectories timed(const Numbers<std::int64_t>& t_ns, const PoseArray& poses, bool spline) {
  std::vector<TimedPose> all;
  for (std::size_t k = 0; k < poses.shape(0); ++k) {
    const Pose pose = pose_of(poses, k, "poses");
    all.push_back({t_ns.data()[k], pose.translation(), Eigen::Quaterniond(pose.linear())});
  }
  return one(TimedPoses(std::move(all), interpolation_of(spline)));
}

Trajectories tumbling(const PoseArray& poses, const Eigen::Vector3d& moments_kg_m2,
                      const Eigen::Vector3d& rate_rad_s, const Eigen::Vector3d& velocity_m_s,
                      std::int64_t t0_ns) {
  return one(TorqueFreeRotation({.moments_kg_m2 = moments_kg_m2,
                                 .rate_rad_s = rate_rad_s,
                                 .world_from_body = pose_of(poses, 0, "pose"),
                                 .body_from_principal = pose_of(poses, 1, "body_from_principal"),
                                 .velocity_m_s = velocity_m_s,
                                 .t0_ns = t0_ns}));
}

Trajectories load(const std::filesystem::path& path, std::optional<double> rate_hz,
                  const std::filesystem::path& times_file, std::optional<std::int64_t> start_ns,
                  bool spline) {
  return one(load_trajectory_file(path, {.rate_hz = rate_hz,
                                         .times_file = times_file,
                                         .start_ns = start_ns,
                                         .interpolation = interpolation_of(spline)}));
}

Trajectories joined(const std::vector<Trajectories>& parts) {
  Trajectories result;
  for (const Trajectories& part : parts) {
    result.all.insert(result.all.end(), part.all.begin(), part.all.end());
  }
  return result;
}

/// Where a part of the first body is.
Trajectories part_of(const Trajectories& body, const PoseArray& body_from_part) {
  return {{compose_extrinsic(body.all.at(0), pose_of(body_from_part, 0, "rig_from_sensor"))}};
}

/// Poses of the first trajectory at many times, (N, 4, 4).
nb::ndarray<nb::numpy, double> poses_of(const Trajectories& trajectories,
                                        const Numbers<std::int64_t>& t_ns) {
  const std::size_t count = t_ns.shape(0);
  auto values = std::make_unique<std::vector<Matrix4>>(count);
  std::vector<Pose> poses(count);
  poses_at(trajectories.all.at(0), std::span(t_ns.data(), count), poses);
  for (std::size_t k = 0; k < count; ++k) (*values)[k] = poses[k].matrix();
  double* data = count == 0 ? nullptr : (*values)[0].data();
  const nb::capsule owner(values.release(), [](void* kept) noexcept {
    delete static_cast<std::vector<Matrix4>*>(kept);
  });
  const std::array<std::size_t, 3> shape = {count, 4, 4};
  return array_at(data, shape, owner);
}

std::pair<std::int64_t, std::int64_t> span_of(const Trajectories& trajectories) {
  const TimeInterval span = valid_interval(trajectories.all.at(0));
  return {span.first_ns, span.last_ns};
}

Matrix4 looking_at(const Eigen::Vector3d& eye, const Eigen::Vector3d& target,
                   const std::optional<Eigen::Vector3d>& up) {
  return matrix_of(up ? look_at(eye, target, *up) : look_at(eye, target));
}

Matrix4 making_pose(const Eigen::Vector3d& xyz, const Eigen::Vector4d& wxyz) {
  return matrix_of(make_pose(xyz, Eigen::Quaterniond(wxyz[0], wxyz[1], wxyz[2], wxyz[3])));
}

Eigen::Vector4d quaternion_of(const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>& rotation) {
  Eigen::Quaterniond q{Eigen::Matrix3d(rotation)};
  if (q.w() < 0.0) q.coeffs() = -q.coeffs();
  return {q.w(), q.x(), q.y(), q.z()};
}

}  // namespace

Pose pose_of(const PoseArray& poses, std::size_t k, const std::string& name) {
  const Eigen::Map<const Matrix4> given(poses.data() + 16 * k);
  Pose pose = Pose::Identity();
  pose.matrix() = given;
  const bool has_last_row = given.row(3) == Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0);
  const Eigen::Vector3d position = pose.translation();
  const bool is_near = position.allFinite() && position.cwiseAbs().maxCoeff() <= kMaxCoordinate_m;
  if (has_last_row && is_near && is_rigid(pose, kExact)) return pose;
  if (has_last_row && is_near && is_rigid(pose, kAsFloat)) {
    return make_pose(position, Eigen::Quaterniond(pose.linear()));
  }
  const std::string place = poses.shape(0) == 1 ? "" : "[" + std::to_string(k) + "]";
  std::string found = "a matrix that is no rigid transform";
  if (!given.allFinite())
    found = "a number that is not finite";
  else if (!is_near)
    found = "a position beyond 1e15 m";
  else if (!has_last_row)
    found = "a matrix whose last row is not 0 0 0 1";
  throw Error({.where = name + place,
               .found = found,
               .allowed = "a rotation and a translation, 4x4",
               .remedy = "glidar.pose() makes one of a position and a quaternion"});
}

void bind_motion(nb::module_& module) {
  nb::class_<Trajectories>(module, "Trajectories", "Poses as functions of time.")
      .def("__len__", [](const Trajectories& self) { return self.all.size(); })
      .def("poses_at", poses_of, nb::arg("t_ns"))
      .def("valid_interval", span_of);
  module.def("constant", constant, nb::arg("poses"), nb::arg("name"));
  module.def("spin", spin, nb::arg("pose"), nb::arg("rate_rad_s"), nb::arg("t0_ns"));
  module.def("twist", twist, nb::arg("pose"), nb::arg("angular_rad_s"), nb::arg("linear_m_s"),
             nb::arg("in_world"), nb::arg("t0_ns"));
  module.def("timed", timed, nb::arg("t_ns"), nb::arg("poses"), nb::arg("spline") = false);
  module.def("tumbling", tumbling, nb::arg("poses"), nb::arg("moments_kg_m2"),
             nb::arg("rate_rad_s"), nb::arg("velocity_m_s"), nb::arg("t0_ns"));
  module.def("load_trajectory", load, nb::arg("path"), nb::arg("rate_hz").none(),
             nb::arg("times_file"), nb::arg("start_ns").none(), nb::arg("spline") = false,
             nb::sig("def load_trajectory(path: str, rate_hz: float | None, times_file: str, "
                     "start_ns: int | None, spline: bool = False) -> Trajectories"));
  module.def("mounted", part_of, nb::arg("body"), nb::arg("body_from_part"));
  module.def("joined", joined, nb::arg("parts"));
  module.def("look_at", looking_at, nb::arg("eye"), nb::arg("target"), nb::arg("up").none());
  module.def("quaternion", quaternion_of, nb::arg("rotation"));
  module.def("make_pose", making_pose, nb::arg("xyz"), nb::arg("wxyz"));
}

namespace {

using Rows3 = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
using Rows4 = Eigen::Matrix<double, Eigen::Dynamic, 4, Eigen::RowMajor>;
using Times = Eigen::Matrix<std::int64_t, Eigen::Dynamic, 1>;

nb::dict of_kind(const char* kind) {
  nb::dict state;
  state["kind"] = kind;
  return state;
}

nb::dict state_of(const ConstantPose& constant) {
  nb::dict state = of_kind("constant");
  state["pose"] = matrix_of(constant.pose);
  return state;
}

/// A spin, a twist or a torque-free rotation: its start, and its numbers with the keys of files.
nb::dict motion_state(const Trajectory& motion, const Pose& start, std::int64_t t0_ns) {
  nb::dict state = of_kind("motion");
  state["pose"] = matrix_of(start);
  state["t0_ns"] = t0_ns;
  state["document"] = motion_document(motion);
  return state;
}

nb::dict state_of(const ConstantTwist& twist) {
  return motion_state(twist, twist.pose, twist.t0_ns);
}

nb::dict state_of(const Spin& spin) {
  return motion_state(spin, spin.pose, spin.t0_ns);
}

nb::dict state_of(const TorqueFreeRotation& tumbling) {
  return motion_state(tumbling, tumbling.start().world_from_body, tumbling.start().t0_ns);
}

nb::dict state_of(const TimedPoses& timed) {
  const auto count = static_cast<Eigen::Index>(timed.poses().size());
  Times t_ns(count);
  Rows3 positions_m(count, 3);
  Rows4 wxyz(count, 4);
  for (Eigen::Index k = 0; k < count; ++k) {
    const TimedPose& pose = timed.poses()[static_cast<std::size_t>(k)];
    const Eigen::Quaterniond& q = pose.orientation;
    t_ns[k] = pose.t_ns;
    positions_m.row(k) = pose.position_m.transpose();
    wxyz.row(k) << q.w(), q.x(), q.y(), q.z();
  }
  nb::dict state = of_kind("timed");
  state["t_ns"] = t_ns;
  state["positions_m"] = positions_m;
  state["orientations_wxyz"] = wxyz;
  state["spline"] = timed.interpolation() == Interpolation::spline;
  return state;
}

nb::dict state_of(const Mounted& mounted) {
  nb::dict state = of_kind("mounted");
  state["carrier"] = std::visit([](const auto& c) { return state_of(c); }, mounted.carrier);
  state["carrier_from_body"] = matrix_of(mounted.carrier_from_body);
  return state;
}

Pose pose_in(const nb::dict& state, const char* key) {
  return restored_pose(nb::cast<Matrix4>(state[key]), key);
}

TimedPoses timed_from(const nb::dict& state) {
  const auto t_ns = nb::cast<Times>(state["t_ns"]);
  const auto positions_m = nb::cast<Rows3>(state["positions_m"]);
  const auto wxyz = nb::cast<Rows4>(state["orientations_wxyz"]);
  if (positions_m.rows() != t_ns.rows() || wxyz.rows() != t_ns.rows()) {
    throw Error({.where = "trajectory",
                 .found = "arrays of different length",
                 .allowed = "one position and one orientation for each time"});
  }
  std::vector<TimedPose> poses;
  for (Eigen::Index k = 0; k < t_ns.rows(); ++k) {
    const Eigen::RowVector4d q = wxyz.row(k);
    poses.push_back(
        {t_ns[k], positions_m.row(k).transpose(), Eigen::Quaterniond(q[0], q[1], q[2], q[3])});
  }
  const bool is_spline = state.contains("spline") && nb::cast<bool>(state["spline"]);
  return TimedPoses::restored(std::move(poses),
                              is_spline ? Interpolation::spline : Interpolation::linear);
}

Trajectory motion_from(const nb::dict& state) {
  return parse_motion(nb::cast<std::string>(state["document"]), pose_in(state, "pose"),
                      nb::cast<std::int64_t>(state["t0_ns"]));
}

[[noreturn]] void refuse_kind(const std::string& kind) {
  throw Error({.where = "trajectory",
               .found = "the kind '" + kind + "'",
               .allowed = "constant, motion, timed, mounted"});
}

Mounted mounted_from(const nb::dict& state) {
  const auto carrier = nb::cast<nb::dict>(state["carrier"]);
  const auto kind = nb::cast<std::string>(carrier["kind"]);
  const Pose part = pose_in(state, "carrier_from_body");
  if (kind == "timed") return {timed_from(carrier), part};
  if (kind == "motion") return {std::get<TorqueFreeRotation>(motion_from(carrier)), part};
  refuse_kind(kind);
}

Trajectory trajectory_from(const nb::dict& state) {
  const auto kind = nb::cast<std::string>(state["kind"]);
  if (kind == "constant") return ConstantPose{pose_in(state, "pose")};
  if (kind == "motion") return motion_from(state);
  if (kind == "timed") return timed_from(state);
  if (kind == "mounted") return mounted_from(state);
  refuse_kind(kind);
}

}  // namespace

Pose restored_pose(const Matrix4& matrix, const std::string& name) {
  constexpr double kRigid = 1e-6;
  Pose pose = Pose::Identity();
  pose.matrix() = matrix;
  const bool has_last_row = matrix.row(3) == Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0);
  if (has_last_row && matrix.allFinite() && is_rigid(pose, kRigid)) return pose;
  throw Error({.where = name,
               .found = "a matrix that is no rigid transform",
               .allowed = "a rotation and a translation, 4x4"});
}

nb::list states_of(const std::vector<Trajectory>& trajectories) {
  nb::list states;
  for (const Trajectory& trajectory : trajectories) {
    states.append(std::visit([](const auto& kind) { return state_of(kind); }, trajectory));
  }
  return states;
}

std::vector<Trajectory> trajectories_from(const nb::list& states) {
  std::vector<Trajectory> trajectories;
  for (const nb::handle state : states) {
    trajectories.push_back(trajectory_from(nb::cast<nb::dict>(state)));
    validate(trajectories.back());
  }
  return trajectories;
}

void bind_trajectory_state(nb::module_& module) {
  module.def(
      "trajectory_states",
      [](const Trajectories& trajectories) { return states_of(trajectories.all); },
      nb::arg("trajectories"),
      nb::sig("def trajectory_states(trajectories: Trajectories) -> list[dict[str, typing.Any]]"));
  module.def(
      "restore_trajectories",
      [](const nb::list& states) { return Trajectories{trajectories_from(states)}; },
      nb::arg("states"),
      nb::sig("def restore_trajectories(states: list[dict[str, typing.Any]]) -> Trajectories"));
}

}  // namespace glidar::python
