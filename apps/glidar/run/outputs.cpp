// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/outputs.hpp>

#include <apps/glidar/options/option_values.hpp>
#include <glidar/core/error.hpp>
#include <glidar/io/files/atomic_file.hpp>
#include <glidar/io/packets/sensor_packets.hpp>
#include <glidar/io/ros/published_rig.hpp>
#include <glidar/output/network.hpp>
#include <glidar/output/rig_messages.hpp>

#include <algorithm>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <variant>

namespace glidar::app {
namespace {

bool has_recording(const OutputFlags& flags, OutputKind kind) {
  return std::ranges::any_of(flags.recording_paths,
                             [kind](const std::string& path) { return output_kind(path) == kind; });
}

bool has_bag(const OutputFlags& flags) {
  return has_recording(flags, OutputKind::bag);
}

bool has_capture(const OutputFlags& flags) {
  return has_recording(flags, OutputKind::capture);
}

/// Throws Error when two recordings have the same name.
void check_names(const std::vector<std::string>& paths) {
  std::set<std::filesystem::path> names;
  for (const std::string& path : paths) {
    if (names.insert(real_path(path)).second) continue;
    throw Error({path, "is given twice as output", "", "choose another name"});
  }
}

/// Sends the packets of sensors by UDP, as --udp selects them, and serves the drivers of each
/// sensor once.
class PacketOutputs {
 public:
  PacketOutputs(const StreamFlags& flags, const OutputRig& rig, link::ErrorLog& errors,
                Console& console)
      : flags_(flags),
        rig_(rig),
        speed_(time_speed(flags, rig.sensors.front().sensor)),
        errors_(errors),
        console_(console) {}

  std::unique_ptr<Output> open(const PacketTarget& target) {
    ControlPlan plan;
    with_option_name("--udp", [&] {
      const std::size_t index = packet_sensor(rig_, target.sensor_name, "--udp");
      if (served_.insert(index).second)
        plan = control_plan(flags_.control, rig_.sensors[index], target);
    });
    if (plan.at) {
      try {
        return open("--control", target, plan.at);
      } catch (const Error& error) {
        if (plan.is_chosen) throw;
        console_.warn(std::string("drivers cannot reach the sensor: ") + error.what() +
                      "; choose an address with --control, or none");
      }
    }
    return open("--udp", target, std::nullopt);
  }

 private:
  std::unique_ptr<Output> open(const char* option, const PacketTarget& target,
                               const std::optional<link::Endpoint>& control) {
    std::unique_ptr<Output> output;
    with_option_name(option, [&] {
      output = open_packet_output(target, rig_, flags_.render.output, speed_, errors_, control);
    });
    return output;
  }

  const StreamFlags& flags_;
  const OutputRig& rig_;
  double speed_;
  link::ErrorLog& errors_;
  Console& console_;
  std::set<std::size_t> served_;  ///< sensors
};

template <class Predicate>
bool any_sensor(const PreparedScene& prepared, const Predicate& predicate) {
  return std::ranges::any_of(prepared.sensors, [&predicate](const ActiveSensor& active) {
    return predicate(active.sensor);
  });
}

std::string sensor_names(const PreparedScene& prepared) {
  std::string names;
  for (const ActiveSensor& active : prepared.sensors)
    names += (names.empty() ? "" : ", ") + active.sensor.name;
  return names;
}

[[noreturn]] void refuse_without_output(const char* option, const char* of, std::string allowed,
                                        const char* example) {
  throw Error(
      {.where = option,
       .found = std::string("no output has ") + of,
       .allowed = std::move(allowed),
       .remedy = std::string("add one, such as ") + example + ", or leave " + option + " out"});
}

[[noreturn]] void refuse_sensors(const char* option, const PreparedScene& prepared,
                                 const char* allowed) {
  throw Error({.where = option,
               .found = "it has no effect with " + sensor_names(prepared),
               .allowed = allowed,
               .remedy = std::string("leave ") + option + " out"});
}

/// Refuses an option of one manufacturer's packets.
void check_packets(const char* option, bool has_packet_output, bool has_sensor, const char* sensor,
                   const PreparedScene& prepared) {
  if (!has_sensor) refuse_sensors(option, prepared, sensor);
  if (!has_packet_output)
    refuse_without_output(option, "packets", "a capture (.pcap), --udp or --packet-topics",
                          "-o scan.pcap");
}

/// Options that only cameras have.
void check_camera_options(const MessageOptions& messages, const PreparedScene& prepared) {
  const auto is_camera = [](const Sensor& sensor) {
    return std::holds_alternative<Pinhole>(sensor.optics);
  };
  if (any_sensor(prepared, is_camera)) return;
  if (messages.images != ros::ImageTransport::raw)
    refuse_sensors("--image-transport", prepared, "a camera");
  if (messages.depth_in_mm) refuse_sensors("--depth-image", prepared, "a camera");
}

}  // namespace

PoseOrigin pose_origin(const StreamFlags& flags) {
  return has_pose_source(flags) || flags.replays_requests ? PoseOrigin::frames : PoseOrigin::motion;
}

double time_speed(const StreamFlags& flags, const Sensor& first_sensor) {
  if (flags.replay.empty()) return has_pose_source(flags) || flags.is_unpaced ? 0.0 : 1.0;
  if (flags.replay_rate_hz) return *flags.replay_rate_hz / first_sensor.rate_hz;
  return flags.foxglove ? 1.0 : 0.0;
}

OutputRig output_rig(const RenderFlags& flags, const PreparedScene& prepared, PoseOrigin origin) {
  OutputRig rig{.scene = prepared.scene, .sensors = {}};
  for (const ActiveSensor& active : prepared.sensors) {
    rig.sensors.push_back({.name = active.name,
                           .label = label_of(flags, active),
                           .id = active.id,
                           .sensor = active.sensor,
                           .beams = active.beams,
                           .rig_from_sensor = active.rig_from_sensor});
  }
  if (origin == PoseOrigin::motion) rig.motion = prepared.motion;
  rig.imus = prepared.imus;
  rig.gravity_m_s2 = prepared.gravity_m_s2;
  rig.seed = flags.seed;
  rig.start_ns = prepared.start_ns;
  rig.renderer = renderer_name(flags);
  rig.inputs = prepared.files;
  return rig;
}

std::vector<std::unique_ptr<Output>> open_recordings(const OutputFlags& flags,
                                                     const OutputRig& rig) {
  std::vector<std::unique_ptr<Output>> outputs;
  with_option_name("--output", [&] {
    check_names(flags.recording_paths);
    for (const std::string& path : flags.recording_paths)
      outputs.push_back(open_output(path, rig, flags));
  });
  return outputs;
}

std::unique_ptr<Output> open_imu_outputs(const OutputFlags& flags, const OutputRig& rig,
                                         Console& console) {
  std::unique_ptr<Output> output;
  if (flags.imu_paths.empty()) return output;
  with_option_name("--output",
                   [&] { output = open_imu_samples(flags.imu_paths, rig, console.report()); });
  return output;
}

std::vector<std::unique_ptr<Output>> open_stream_outputs(const StreamFlags& flags,
                                                         const OutputRig& rig,
                                                         link::ErrorLog& errors, Console& console) {
  const OutputFlags& files = flags.render.output;
  std::vector<std::unique_ptr<Output>> outputs = open_recordings(files, rig);
  if (auto imu = open_imu_outputs(files, rig, console)) outputs.push_back(std::move(imu));
  PacketOutputs packets(flags, rig, errors, console);
  for (const PacketTarget& target : flags.udp) outputs.push_back(packets.open(target));
  return outputs;
}

std::chrono::milliseconds serve_interval(const std::vector<std::unique_ptr<Output>>& outputs) {
  std::chrono::milliseconds interval = Output::kServeInterval;
  for (const auto& output : outputs) interval = std::min(interval, output->serve_interval());
  return interval;
}

HitColumnMask needed_hit_columns(const std::vector<std::unique_ptr<Output>>& outputs,
                                 std::size_t sensor_count) {
  HitColumnMask needed;
  for (const auto& output : outputs) {
    for (std::size_t i = 0; i < sensor_count; ++i) needed = needed | output->hit_columns(i);
  }
  return needed;
}

void check_layout(const OutputFlags& flags) {
  glidar::check_layout(flags, has_bag(flags));
}

void refuse_unused_output_options(const OutputFlags& flags, const PreparedScene& prepared,
                                  const LiveOutputs& live) {
  const bool has_messages = has_bag(flags) || live.topics;
  const bool sends_packets = has_capture(flags) || live.packets;
  const auto is_doppler = [](const Sensor& sensor) { return sensor.doppler.has_value(); };
  if (!any_sensor(prepared, is_doppler)) {
    check_columns(prepared.sensors.front().sensor, flags.columns);
  }
  const MessageOptions& messages = flags.messages;
  const std::string message_option = given_message_option(messages);
  const bool is_framed = live.viewers && !messages.frame_prefix.empty();
  if (!message_option.empty() && !has_messages && !is_framed)
    refuse_without_output(message_option.c_str(), "ROS messages", "a bag, or --ros2",
                          "-o run.mcap");
  if (messages.tf && !has_messages && !live.viewers)
    refuse_without_output("--tf", "ROS messages", "a bag, or --ros2", "-o run.mcap");
  check_camera_options(messages, prepared);
  if (messages.imu_orientation && prepared.imus.empty())
    throw Error({"--imu-orientation", "there is no IMU", "a scene file with 'imus', or --imu",
                 "leave it out"});
  if (flags.ouster_profile) {
    check_packets("--ouster-profile", sends_packets || (messages.packet_topics && has_messages),
                  any_sensor(prepared, is_ouster), "a preset of an Ouster sensor", prepared);
  }
  if (flags.livox_type) {
    check_packets("--livox-data-type", sends_packets, any_sensor(prepared, is_livox),
                  "a preset of a Livox sensor", prepared);
  }
}

void refuse_unused_imu(const RenderFlags& flags, const PreparedScene& prepared,
                       const LiveOutputs& live, PoseOrigin origin) {
  if (flags.imu.empty()) return;
  if (origin == PoseOrigin::frames) {
    throw Error({"--imu", "a simulator or ROS 2 gives the poses of frames",
                 "a motion that is known at all times", "leave --imu out"});
  }
  const OutputFlags& output = flags.output;
  const bool is_live = live.topics || live.viewers || live.record;
  if (!output.imu_paths.empty() || has_bag(output) || is_live) return;
  const bool sends_packets = has_capture(output) || live.packets;
  if (sends_packets && any_sensor(prepared, has_imu_packets)) return;
  refuse_without_output("--imu", "samples of an IMU",
                        "the suffixes .imu.csv and .imu.npz, a bag, --ros2, --foxglove, --record, "
                        "or packets of Ouster and "
                        "Livox sensors",
                        "-o run.imu.csv with --duration");
}

}  // namespace glidar::app
