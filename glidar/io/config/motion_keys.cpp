// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/motion_keys.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/field_visitor.hpp>
#include <glidar/core/time_text.hpp>
#include <glidar/io/config/field_json.hpp>
#include <glidar/io/config/yaml_field_reader.hpp>
#include <glidar/io/formats/trajectory_file.hpp>

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

namespace glidar {
namespace {

constexpr const char* kNoMotion = "none";

/// Reads a path; the file must exist.
void visit_file(FieldVisitor& visitor, const FieldInfo& field, std::string& path) {
  visitor.path(field, path);
  if (!visitor.is_reading() || path.empty() || std::filesystem::exists(path)) return;
  visitor.reject(field.key, "no such file: " + path, "the path of a trajectory file",
                 "paths are relative to the folder of this file");
}

void visit_interpolation(FieldVisitor& visitor, Interpolation& interpolation) {
  constexpr std::array<Named<Interpolation>, 2> kNames = {
      {{"linear", Interpolation::linear}, {"spline", Interpolation::spline}}};
  visit_choice(
      visitor,
      {"interpolation", "`linear`: velocities jump at every pose; `spline`: smooth, as IMUs need"},
      kNames, interpolation);
}

/// Seconds, read as a text because doubles do not hold the nanoseconds of dates.
void visit_start(FieldVisitor& visitor, std::optional<std::int64_t>& start_ns) {
  const FieldInfo field = {"start_s", "shifts all times so that the first one is this", kUnitSecond,
                           false, "times of the file"};
  const NumberRule rule = {-9.2e9, 9.2e9, false, "seconds from -9.2e9 to 9.2e9"};
  double seconds = 0.0;
  if (!visitor.is_reading()) visitor.number(field, rule, seconds);
  if (!visitor.is_reading() || !visitor.has(field.key)) return;
  std::string text;
  visitor.text(field, text);
  start_ns = parse_seconds_ns(text);
  if (!start_ns) visitor.reject(field.key, "{}", rule.allowed);
}

struct TrajectoryFileKeys {
  std::string file;
  std::string times_file;
  TrajectoryFileOptions options;
};

void describe(TrajectoryFileKeys& keys, FieldVisitor& visitor) {
  visit_file(visitor, {"file", "poses over time", kNoUnit, kRequired}, keys.file);
  double rate_hz = 0.0;
  visitor.number({"rate_hz", "of a KITTI file", kUnitHertz, false, "none"},
                 {0.01, 1e9, false, "a number from 0.01 to 1e9"}, rate_hz);
  visit_file(visitor, {"times", "times of a KITTI file", kNoUnit, false, "none"}, keys.times_file);
  visit_start(visitor, keys.options.start_ns);
  visit_interpolation(visitor, keys.options.interpolation);
  if (!visitor.is_reading()) return;
  if (visitor.has("rate_hz")) keys.options.rate_hz = rate_hz;
  keys.options.times_file = keys.times_file;
}

/// The numbers of a motion, and where it starts.
template <class Kind>
struct MotionNumbers {
  using Type = Kind;
  static constexpr Pose Kind::*kStart = &Kind::pose;
  static const Kind& of(const Kind& kind) { return kind; }
};
template <>
struct MotionNumbers<TorqueFreeRotation> {
  using Type = InitialRotation;
  static constexpr Pose InitialRotation::*kStart = &InitialRotation::world_from_body;
  static const InitialRotation& of(const TorqueFreeRotation& kind) { return kind.start(); }
};

/// A kind of motion whose numbers are in the file.
template <class Kind>
void visit_kind(FieldVisitor& visitor, const FieldInfo& field, MotionKeys& keys) {
  using Numbers = MotionNumbers<Kind>;
  const Kind* held = keys.trajectory ? std::get_if<Kind>(&*keys.trajectory) : nullptr;
  typename Numbers::Type numbers;
  if (held != nullptr) numbers = Numbers::of(*held);
  const auto body = [&](FieldVisitor& nested) { describe(numbers, nested); };
  const bool is_given =
      visitor.object(field, held != nullptr, FieldVisitor::Describe(body)) && visitor.is_reading();
  if (!is_given) return;
  numbers.*Numbers::kStart = keys.start.value_or(Pose::Identity());
  numbers.t0_ns = keys.t0_ns;
  keys.trajectory = Kind(numbers);
}

void visit_trajectory(FieldVisitor& visitor, MotionKeys& keys) {
  const FieldInfo field = {
      "trajectory",
      "a path, or `{file: , rate_hz: , times: , start_s: , interpolation: }`: poses over time "
      "from a [file](motion.md#trajectory-files)",
      kNoUnit, false, kNoMotion};
  if (visitor.is_writing()) return;
  if (visitor.is_reading() && keys.start && visitor.has(field.key)) {
    visitor.reject(field.key, "given beside a pose",
                   "a pose, or a trajectory, which gives the poses itself", "remove one of them");
  }
  TrajectoryFileKeys file;
  std::string name;
  const auto body = [&](FieldVisitor& nested) { describe(file, nested); };
  visitor.text_or_object(field, "a map, or the path of a trajectory file", name,
                         FieldVisitor::Describe(body));
  if (!visitor.is_reading() || !visitor.has(field.key)) return;
  if (!name.empty()) visit_file(visitor, field, file.file);
  if (!file.times_file.empty()) keys.files.push_back(file.times_file);
  keys.files.push_back(file.file);
  keys.trajectory = load_trajectory_file(file.file, file.options);
}

}  // namespace

void describe(MotionKeys& keys, FieldVisitor& visitor) {
  visitor.at_most_one({{"spin", "twist", "tumbling", "trajectory"},
                       "one of spin, twist, tumbling, trajectory",
                       "the kind of motion is missing",
                       "add 'spin: ...', for example"});
  visit_kind<Spin>(
      visitor, {"spin", "rotation in place about its own axes", kNoUnit, false, kNoMotion}, keys);
  visit_kind<ConstantTwist>(
      visitor, {"twist", "constant rotation and velocity", kNoUnit, false, kNoMotion}, keys);
  visit_kind<TorqueFreeRotation>(
      visitor, {"tumbling", "torque-free rotation of a rigid body", kNoUnit, false, kNoMotion},
      keys);
  visit_trajectory(visitor, keys);
}

Pose start_pose(const Trajectory& trajectory) {
  if (const auto* spin = std::get_if<Spin>(&trajectory)) return spin->pose;
  if (const auto* twist = std::get_if<ConstantTwist>(&trajectory)) return twist->pose;
  const auto* tumbling = std::get_if<TorqueFreeRotation>(&trajectory);
  return tumbling != nullptr ? tumbling->start().world_from_body : pose_at(trajectory, 0);
}

bool visit_motion(FieldVisitor& visitor, const FieldInfo& field, MotionKeys& keys) {
  const auto body = [&](FieldVisitor& nested) { describe(keys, nested); };
  return visitor.object(field, keys.trajectory.has_value(), FieldVisitor::Describe(body));
}

std::string motion_document(const Trajectory& trajectory) {
  MotionKeys keys;
  keys.trajectory = trajectory;
  const nlohmann::ordered_json document = write_struct(FieldVisitor::Mode::document, keys);
  if (!document.empty()) return document.dump();
  throw Error({.where = "motion",
               .found = "a trajectory that has no such keys",
               .allowed = "a spin, a twist or a torque-free rotation",
               .remedy = ""});
}

Trajectory parse_motion(const std::string& text, const Pose& start, std::int64_t t0_ns) {
  MotionKeys keys;
  keys.start = start;
  keys.t0_ns = t0_ns;
  read_struct(read_yaml_text("motion", text), keys);
  return *std::move(keys.trajectory);
}

}  // namespace glidar
