// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/session.hpp>

#include <apps/glidar/run/advice.hpp>
#include <apps/glidar/run/placement.hpp>
#include <apps/glidar/run/sensor_setup.hpp>
#include <glidar/core/error.hpp>
#include <glidar/io/config/scene_file.hpp>
#include <glidar/io/config/surface_presets.hpp>
#include <glidar/io/files/overwrite_guard.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace glidar::app {
namespace {

bool is_scene_file(const std::string& input) {
  return input.ends_with(".yaml") || input.ends_with(".yml");
}

/// Applies --surface to the model of a single file.
void apply_surface_option(const RenderFlags& flags, const Sensor& sensor, Scene& scene) {
  if (flags.surface.empty()) return;
  const auto refuse = [](const char* found, const char* remedy) {
    throw Error({.where = "--surface", .found = found, .allowed = "", .remedy = remedy});
  };
  if (is_scene_file(flags.input)) {
    refuse("the input is a scene file", "write 'surface: ...' into its materials");
  }
  if (!sensor.pulse) {
    refuse("the sensor has no pulsed light", "choose one that has, such as VLP-16");
  }
  const SurfacePreset surface = find_surface(flags.surface, "--surface");
  for (Material& material : scene.materials) apply_surface(surface, material);
}

/// Whether the view is framed automatically, so that the up axis matters.
bool is_auto_framed(const RenderFlags& flags) {
  return !flags.model.up && !flags.pose.model_q && !flags.pose.up && !sensor_pose_given(flags.pose);
}

SceneFile load(const RenderFlags& flags, Console& console) {
  const ProgressScope progress(console, "loading " + flags.input);
  if (is_scene_file(flags.input)) {
    return load_scene_file(flags.input, flags.model, console.report());
  }
  SceneFile loaded;
  Model model = load_model(flags.input, flags.model, console.report());
  const std::string up_hint =
      is_auto_framed(flags) ? up_advice(model.format, bounds(model.mesh)) : std::string();
  if (!up_hint.empty()) console.info(up_hint);
  add_model(loaded.scene, std::move(model));
  return loaded;
}

/// Scene and sensor files, models and their textures, materials and buffers.
std::vector<std::string> files_read(const RenderFlags& flags, const SceneFile& loaded,
                                    const std::vector<Mount>& mounts) {
  std::vector<std::string> files = loaded.files;
  for (const Mount& mount : mounts) {
    files.insert(files.end(), mount.sensor.files.begin(), mount.sensor.files.end());
  }
  for (const std::string& file : files_of(flags.motion)) files.push_back(file);
  for (const std::string& file : files_of(loaded.scene)) files.push_back(file);
  std::sort(files.begin(), files.end());
  files.erase(std::unique(files.begin(), files.end()), files.end());
  return files;
}

/// The number of frames in the requested duration; 1 without.
std::uint32_t frame_count(const RenderFlags& flags, const Sensor& sensor) {
  if (!flags.duration_s) return 1;
  constexpr double kMaxFrames = 1e6;
  constexpr double kRounding = 1e-9;  // 0.3 s at 10 Hz are three frames
  const double frames = std::ceil(*flags.duration_s * sensor.rate_hz - kRounding);
  require_number(*flags.duration_s > 0.0 && frames <= kMaxFrames, "--duration", *flags.duration_s,
                 "seconds above 0, up to a million frames");
  return static_cast<std::uint32_t>(std::max(1.0, frames));
}

/// The names of sensors or mounts.
template <class Named>
std::string names_of(const std::vector<Named>& all) {
  std::string names;
  for (const Named& named : all) names += (names.empty() ? "" : ", ") + named.name;
  return names;
}

/// The sensors of the rig, configured by the flags.
std::vector<Mount> make_mounts(const RenderFlags& flags, const std::vector<RigSensor>& sensors) {
  if (sensors.empty() || sensors.front().name.empty()) {
    if (!flags.sensor_name.empty()) {
      throw Error({"--sensor-name", flags.sensor_name, "a scene file with a rig of sensors",
                   "leave it out"});
    }
    const Sensor* in_file = sensors.empty() ? nullptr : &sensors.front().sensor;
    return {{.sensor = make_sensor(flags.sensor, in_file)}};
  }
  if (names_sensor(flags.sensor)) {
    throw Error({"--sensor and camera options", "given for a scene file with a rig of sensors", "",
                 "leave them out; --sensor-name NAME chooses one of " + names_of(sensors)});
  }
  std::vector<Mount> mounts;
  for (std::uint32_t i = 0; i < sensors.size(); ++i) {
    mounts.push_back({.name = sensors[i].name,
                      .id = i,
                      .sensor = make_sensor(flags.sensor, &sensors[i].sensor),
                      .rig_from_sensor = sensors[i].rig_from_sensor});
  }
  const auto is_chosen = [&](const Mount& mount) { return mount.name == flags.sensor_name; };
  if (!flags.sensor_name.empty() && std::none_of(mounts.begin(), mounts.end(), is_chosen)) {
    throw Error({"--sensor-name", flags.sensor_name, names_of(sensors), ""});
  }
  return mounts;
}

/// The pose of the first sensor, which gives that of the rig.
Pose first_sensor_pose(const RenderFlags& flags, const SceneFile& loaded, const Session& session,
                       Console& console) {
  const Mount& first = session.mounts.front();
  ScenePose in_file{loaded.world_from_rig, loaded.looks_at};
  if (in_file.world_from_sensor) {
    in_file.world_from_sensor = *in_file.world_from_sensor * first.rig_from_sensor;
  }
  const Pose world_from_sensor = pose_sensor(flags.pose, in_file, first.beams, session.scene);
  const bool is_placed = in_file.world_from_sensor || loaded.rig_motion ||
                         sensor_pose_given(flags.pose) || !flags.motion.trajectory.empty();
  if (!looks_along_z(first.beams) && !is_placed) {
    console.info(placement_advice(session.scene, world_from_sensor));
  }
  return world_from_sensor;
}

/// The motion of the rig and the objects. Options give the pose and rotation of the first sensor;
/// the scene file and trajectories give those of the rig, which are the sensor's if there is only
/// one.
RigMotion make_motion(const RenderFlags& flags, const SceneFile& loaded, const Session& session,
                      const Pose& world_from_first) {
  const bool is_given = sensor_pose_given(flags.pose);
  const Mount& first = session.mounts.front();
  const bool is_in_file = loaded.rig_motion || (loaded.world_from_rig && !loaded.looks_at &&
                                                !flags.motion.sensor_rate_rad_s);
  const bool is_rigs = !flags.motion.trajectory.empty() || (is_in_file && !is_given);
  const Pose start = is_rigs ? loaded.world_from_rig.value_or(Pose::Identity()) : world_from_first;
  const Pose optical_from_first =
      looks_along_z(first.beams) ? Pose::Identity() : optical_from_body();
  Trajectory trajectory =
      sensor_trajectory(flags.motion, start, optical_from_first, is_given, loaded.rig_motion);
  if (!is_rigs) trajectory = compose_extrinsic(trajectory, first.rig_from_sensor.inverse());
  return {.world_from_rig = std::move(trajectory),
          .world_from_instance = make_motion(session.scene, ConstantPose{},
                                             instance_trajectories(flags.motion, session.scene,
                                                                   loaded.world_from_instance))
                                     .world_from_instance};
}

/// The firing time of the last beam of the last frame.
std::int64_t last_firing_ns(const Mount& mount) {
  const std::int64_t start_ns = frame_interval(mount.sensor, mount.frames - 1).start_ns;
  if (mount.beams.times_ns.empty()) return start_ns;
  return start_ns + *std::max_element(mount.beams.times_ns.begin(), mount.beams.times_ns.end());
}

/// Warns of times outside a trajectory.
void warn_extrapolation(const Session& session, const Report& report) {
  TimeInterval requested{.first_ns = 0, .last_ns = 0};
  for (const Mount& mount : session.mounts) {
    requested.last_ns = std::max(requested.last_ns, last_firing_ns(mount));
  }
  glidar::warn_extrapolation(session.motion.world_from_rig, "sensor", requested, report);
  for (std::size_t i = 0; i < session.motion.world_from_instance.size(); ++i) {
    glidar::warn_extrapolation(session.motion.world_from_instance[i],
                               session.scene.instances[i].name, requested, report);
  }
}

void check_target(const RenderFlags& flags) {
  for (const std::string& path : flags.output.paths) {
    if (flags.quantized_framebuffer || format_of(flags.output, path).suffix != ".paper.png")
      continue;
    throw Error({.where = "--output, " + path,
                 .found = "the float framebuffer, which has no such image",
                 .allowed = "this output with --quantized-framebuffer",
                 .remedy = "add --renderer opengl --quantized-framebuffer"});
  }
  if (!flags.quantized_framebuffer || flags.renderer.kind == "opengl") return;
  throw Error({.where = "--quantized-framebuffer",
               .found = "the renderer " + flags.renderer.kind,
               .allowed = "opengl",
               .remedy = "add --renderer opengl"});
}

/// Computes the poses and motion of sensors and objects; shows the progress.
void place_sensors(const RenderFlags& flags, const SceneFile& loaded, Console& console,
                   Session& session) {
  const ProgressScope progress(console, "aiming the sensor");
  for (Mount& mount : session.mounts) {
    mount.beams = make_beams(mount.sensor);
    mount.frames = frame_count(flags, mount.sensor);
  }
  const Pose world_from_first = first_sensor_pose(flags, loaded, session, console);
  session.motion = make_motion(flags, loaded, session, world_from_first);
  warn_extrapolation(session, console.report());
  if (!flags.sensor_name.empty()) {  // last: the poses must not depend on the selected sensor
    std::erase_if(session.mounts,
                  [&](const Mount& mount) { return mount.name != flags.sensor_name; });
  }
  for (Mount& mount : session.mounts) mount.motion = motion_of(session.motion, mount);
}

}  // namespace

void print_advice(const std::vector<std::string>& advice, Console& console) {
  for (const std::string& sentence : advice) console.warn(sentence);
}

void open(const RenderFlags& flags, const std::function<void()>& on_loaded, Console& console,
          Session& session) {
  check_target(flags);
  // before a long load
  if (!is_scene_file(flags.input)) session.mounts = make_mounts(flags, {});
  SceneFile loaded = load(flags, console);
  session.mounts = make_mounts(flags, loaded.sensors);
  session.files = files_read(flags, loaded, session.mounts);
  if (on_loaded) on_loaded();
  session.scene = std::move(loaded.scene);
  apply_surface_option(flags, session.mounts.front().sensor, session.scene);
  pose_model(flags.pose, session.scene);
  print_advice(size_advice(session.scene, flags.model.metres_per_unit || flags.pose.scale),
               console);
  place_sensors(flags, loaded, console, session);
  const ProgressScope progress(console, "preparing the scene");
  session.renderer = make_renderer(session.scene, flags.renderer);
  if (flags.quantized_framebuffer) {
    session.paper = make_paper_camera(session.scene, flags.renderer);
  }
  for (Mount& mount : session.mounts) {
    mount.simulator =
        make_simulator(session, std::make_shared<const BeamCache>(mount.sensor, mount.beams));
  }
}

std::string label_of(const RenderFlags& flags, const Mount& mount) {
  return flags.sensor_name.empty() ? mount.name : std::string();
}

Mount& only_mount(Session& session) {
  if (session.mounts.size() == 1) return session.mounts.front();
  throw Error({"scene file", fmt::format("a rig of {} sensors", session.mounts.size()),
               "one sensor here", "choose it with --sensor-name: " + names_of(session.mounts)});
}

Motion motion_of(RigMotion motion, const Mount& mount) {
  return {.world_from_sensor = compose_extrinsic(motion.world_from_rig, mount.rig_from_sensor),
          .world_from_instance = std::move(motion.world_from_instance)};
}

void start_frame(const RenderFlags& flags, std::uint32_t number, const Mount& mount, Frame& frame) {
  frame.number = number;
  frame.sensor_id = mount.id;
  frame.stamp_ns = frame_interval(mount.sensor, number).start_ns;
  frame.seed = flags.seed;
}

std::shared_ptr<Simulator> make_simulator(const Session& session,
                                          const std::shared_ptr<const BeamCache>& sensor) {
  auto simulator = std::make_shared<Simulator>(session.scene, sensor, *session.renderer);
  if (session.paper) simulator->set_return_replacement(woods2016_measurement(*session.paper));
  return simulator;
}

}  // namespace glidar::app
