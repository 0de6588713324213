// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "trajectory_state.hpp"

#include <glidar/core/error.hpp>
#include <glidar/io/config/motion_document.hpp>

#include <nanobind/eigen/dense.h>
#include <nanobind/stl/string.h>

namespace glidar::python {
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
