// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/prepared_scene.hpp>

#include <apps/glidar/options/option_values.hpp>
#include <apps/glidar/run/advice.hpp>
#include <apps/glidar/run/placement.hpp>
#include <apps/glidar/run/sensor_setup.hpp>
#include <glidar/core/error.hpp>
#include <glidar/core/time_text.hpp>
#include <glidar/io/config/imu_file.hpp>
#include <glidar/io/config/sensor_document.hpp>
#include <glidar/io/config/surface_presets.hpp>
#include <glidar/io/files/atomic_file.hpp>
#include <glidar/motion/run_clock.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
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
    throw Error({.where = "--surface", .found = found, .remedy = remedy});
  };
  if (is_scene_file(flags.input)) {
    refuse("the input is a scene file", "write 'surface: ...' into its materials");
  }
  if (!sensor.lidar_equation) {
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
                                    const std::vector<ActiveSensor>& sensors) {
  std::vector<std::string> files = loaded.files;
  for (const ActiveSensor& active : sensors) {
    files.insert(files.end(), active.sensor.files.begin(), active.sensor.files.end());
  }
  for (const std::string& file : files_of(flags.motion)) files.push_back(file);
  for (const std::string& file : files_of(loaded.scene)) files.push_back(file);
  std::sort(files.begin(), files.end());
  files.erase(std::unique(files.begin(), files.end()), files.end());
  return files;
}

/// The number of frames in the duration; 1 without.
std::uint32_t frame_count(const std::optional<double>& duration_s, const Sensor& sensor) {
  if (!duration_s) return 1;
  constexpr double kMaxFrames = 1e6;
  constexpr double kRounding = 1e-9;  // 0.3 s at 10 Hz are three frames
  const double frames = std::ceil(*duration_s * sensor.rate_hz - kRounding);
  require_number(*duration_s > 0.0 && frames <= kMaxFrames, "--duration", *duration_s,
                 "seconds above 0, up to a million frames");
  return static_cast<std::uint32_t>(std::max(1.0, frames));
}

/// The names of the sensors.
template <class Named>
std::string names_of(const std::vector<Named>& all) {
  std::string names;
  for (const Named& named : all) names += (names.empty() ? "" : ", ") + named.name;
  return names;
}

/// The sensors of the rig, configured by the flags.
std::vector<ActiveSensor> make_active_sensors(const RenderFlags& flags,
                                              const std::vector<RigSensor>& in_file) {
  if (in_file.empty() || in_file.front().name.empty()) {
    if (!flags.sensor_name.empty()) {
      throw Error({"--sensor-name", flags.sensor_name, "a scene file with a rig of sensors",
                   "leave it out"});
    }
    const Sensor* only = in_file.empty() ? nullptr : &in_file.front().sensor;
    return {{.sensor = make_sensor(flags.sensor, only)}};
  }
  const auto is_chosen = [&](const RigSensor& one) { return one.name == flags.sensor_name; };
  const auto chosen = flags.sensor_name.empty()
                          ? in_file.begin()
                          : std::find_if(in_file.begin(), in_file.end(), is_chosen);
  if (chosen == in_file.end()) {
    throw Error({"--sensor-name", flags.sensor_name, names_of(in_file)});
  }
  if (names_sensor(flags.sensor)) {  // it replaces the rig's sensors, where one of them is
    return {{.name = flags.sensor_name,
             .id = static_cast<std::uint32_t>(chosen - in_file.begin()),
             .sensor = make_sensor(flags.sensor, nullptr),
             .rig_from_sensor = chosen->rig_from_sensor}};
  }
  if (!flags.sensor.calibration_files.empty()) {
    throw Error({"--calibration", "given for a scene file with a rig of sensors",
                 "a scene file with one sensor",
                 "name the file in the scene: 'calibration_file: ...' beside 'sensor: ...'"});
  }
  std::vector<ActiveSensor> sensors;
  for (std::uint32_t i = 0; i < in_file.size(); ++i) {
    sensors.push_back({.name = in_file[i].name,
                       .id = i,
                       .sensor = make_sensor(flags.sensor, &in_file[i].sensor),
                       .rig_from_sensor = in_file[i].rig_from_sensor});
  }
  return sensors;
}

/// The pose of the first sensor, which gives that of the rig.
Pose first_sensor_pose(const RenderFlags& flags, const SceneFile& loaded,
                       const PreparedScene& prepared, Console& console) {
  const ActiveSensor& first = prepared.sensors.front();
  ScenePose in_file{loaded.world_from_rig, loaded.looks_at};
  if (in_file.world_from_sensor) {
    in_file.world_from_sensor = *in_file.world_from_sensor * first.rig_from_sensor;
  }
  const Pose world_from_sensor = pose_sensor(flags.pose, in_file, first.beams, prepared.scene);
  const bool is_placed = in_file.world_from_sensor || loaded.rig_motion ||
                         sensor_pose_given(flags.pose) || !flags.motion.trajectory.empty();
  if (!looks_along_z(first.beams) && !is_placed) {
    console.info(placement_advice(prepared.scene, world_from_sensor));
  }
  return world_from_sensor;
}

/// The motion of the rig and the objects. Options give the pose and rotation of the first sensor;
/// the scene file and trajectories give those of the rig, which are the sensor's if there is only
/// one.
RigMotion make_motion(const RenderFlags& flags, const SceneFile& loaded,
                      const PreparedScene& prepared, const Pose& world_from_first) {
  const bool is_given = sensor_pose_given(flags.pose);
  const ActiveSensor& first = prepared.sensors.front();
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
          .world_from_instance = make_motion(prepared.scene, ConstantPose{},
                                             instance_trajectories(flags.motion, prepared.scene,
                                                                   loaded.world_from_instance))
                                     .world_from_instance};
}

/// The firing time of the last beam of the last frame.
std::int64_t last_firing_ns(const ActiveSensor& active) {
  const std::int64_t start_ns = frame_interval(active.sensor, active.frames - 1).start_ns;
  if (active.beams.times_ns.empty()) return start_ns;
  return start_ns + *std::max_element(active.beams.times_ns.begin(), active.beams.times_ns.end());
}

/// Whether outputs need dates.
bool are_stamps_dates(const RenderFlags& flags) {
  const auto needs_dates = [](const std::string& path) {
    const OutputKind kind = output_kind(path);
    return kind == OutputKind::bag || kind == OutputKind::capture;
  };
  const StampOrigin origin = flags.motion.stamp_origin;
  return origin == StampOrigin::date ||
         (origin == StampOrigin::outputs &&
          std::ranges::any_of(flags.output.recording_paths, needs_dates));
}

std::int64_t now_ns() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::nanoseconds>(now).count();
}

/// A time of the command line in the times of the trajectory.
std::int64_t own_time_ns(const TrajectoryTime& time, const TimeInterval& known) {
  return time.is_after_first ? known.first_ns + time.t_ns : time.t_ns;
}

/// The duration of the run until --to; `known` are the trajectory's own times.
double duration_until(const TrajectoryTime& end, const TimeInterval& known,
                      const PreparedScene& prepared) {
  if (known.first_ns == TimeInterval{}.first_ns)
    throw Error({"--to", "the sensor has no trajectory", "a file of timed poses", "leave it out"});
  const std::int64_t first_ns = valid_interval(prepared.motion.world_from_rig).first_ns;
  const std::int64_t start_ns = known.first_ns + (prepared.start_ns - first_ns);
  const std::int64_t end_ns = own_time_ns(end, known);
  if (end_ns > start_ns && end_ns <= known.last_ns)
    return 1e-9 * static_cast<double>(end_ns - start_ns);
  throw Error({"--to", decimal_seconds(end_ns) + " s",
               "after " + decimal_seconds(start_ns) + " s, where the run starts, up to " +
                   decimal_seconds(known.last_ns) + " s"});
}

/// Sets the start and duration of the run, and the motion of everything at the times of stamps.
void set_times(const RenderFlags& flags, PreparedScene& prepared) {
  const MotionFlags& given = flags.motion;
  RigMotion& motion = prepared.motion;
  prepared.duration_s = flags.duration_s;
  if (given.stamp_origin == StampOrigin::source) return;
  const bool has_dates = are_stamps_dates(flags);
  const TimeInterval known = valid_interval(motion.world_from_rig);
  RunStart run{.time_ns = given.start_time_ns,
               .origin_ns = has_dates ? kDefaultDate_ns : 0,
               .moves_trajectory = given.starts_now};
  if (given.starts_now && !run.time_ns) run.time_ns = now_ns();
  if (given.from) run.from_ns = own_time_ns(*given.from, known);
  with_option_name(given.from ? "--from" : "--start-time", [&] {
    prepared.start_ns = set_run_clock(run, motion.world_from_rig, motion.world_from_instance);
  });
  if (given.to) prepared.duration_s = duration_until(*given.to, known, prepared);
  if (given.starts_now || (has_dates && !given.start_time_ns))
    prepared.recorded_start = (given.starts_now ? "now=" : "") + decimal_seconds(prepared.start_ns);
  for (std::size_t i = 0; i < motion.world_from_instance.size(); ++i) {
    prepared.scene.instances[i].world_from_object =
        pose_at(motion.world_from_instance[i], prepared.start_ns);
  }
}

/// Warns of times outside a trajectory.
void warn_extrapolation(const PreparedScene& prepared, const Report& report) {
  TimeInterval requested{.first_ns = prepared.start_ns, .last_ns = prepared.start_ns};
  for (const ActiveSensor& active : prepared.sensors) {
    requested.last_ns = std::max(requested.last_ns, prepared.start_ns + last_firing_ns(active));
  }
  glidar::warn_extrapolation(prepared.motion.world_from_rig, "sensor", requested, report);
  for (std::size_t i = 0; i < prepared.motion.world_from_instance.size(); ++i) {
    glidar::warn_extrapolation(prepared.motion.world_from_instance[i],
                               prepared.scene.instances[i].name, requested, report);
  }
}

void check_target(const RenderFlags& flags) {
  for (const std::string& path : flags.output.paths) {
    if (flags.quantized_framebuffer || !format_of(flags.output, path).reads_framebuffer) continue;
    throw Error({.where = "--output, " + path,
                 .found = "the float framebuffer, which has no such image",
                 .allowed = "this output with --quantized-framebuffer",
                 .remedy = "add --renderer opengl --quantized-framebuffer"});
  }
  if (!flags.quantized_framebuffer || renderer_kind(flags.renderer.kind) == "gpu") return;
  throw Error({.where = "--quantized-framebuffer",
               .found = "the renderer " + flags.renderer.kind,
               .allowed = "gpu, or its other name opengl",
               .remedy = "add --renderer opengl"});
}

/// Computes the poses and motion of sensors and objects; shows the progress.
void place_sensors(const RenderFlags& flags, const SceneFile& loaded, Console& console,
                   PreparedScene& prepared) {
  const ProgressScope progress(console, "aiming the sensor");
  for (ActiveSensor& active : prepared.sensors) active.beams = make_beams(active.sensor);
  const Pose world_from_first = first_sensor_pose(flags, loaded, prepared, console);
  prepared.motion = make_motion(flags, loaded, prepared, world_from_first);
  set_times(flags, prepared);
  for (ActiveSensor& active : prepared.sensors)
    active.frames = frame_count(prepared.duration_s, active.sensor);
  warn_extrapolation(prepared, console.report());
  if (!flags.sensor_name.empty()) {  // last: the poses must not depend on the selected sensor
    std::erase_if(prepared.sensors,
                  [&](const ActiveSensor& active) { return active.name != flags.sensor_name; });
  }
  for (ActiveSensor& active : prepared.sensors) active.motion = motion_of(prepared.motion, active);
}

/// The IMUs of the scene file, or that of --imu at the sensor.
void set_imus(const RenderFlags& flags, const SceneFile& loaded, PreparedScene& prepared) {
  prepared.imus = loaded.imus;
  prepared.gravity_m_s2 = loaded.gravity_m_s2;
  if (flags.imu.empty()) return;
  if (!loaded.imus.empty()) {
    throw Error({"--imu", "the scene file has IMUs", "a scene without 'imus'", "leave it out"});
  }
  const std::filesystem::path file = find_imu_file(flags.imu);
  prepared.imus = {{.name = "imu", .imu = load_imu_file(file)}};
  prepared.files.push_back(file.string());
}

/// Drivers print messages of their own before the error that none of them gives a context.
void make_renderers(const RenderFlags& flags, PreparedScene& prepared) {
  std::optional<SilencedLibraries> silenced;
  if (renderer_kind(flags.renderer.kind) == "gpu") silenced.emplace();
  prepared.renderer = make_renderer(prepared.scene, hit_renderer(flags));
  if (flags.quantized_framebuffer) {
    prepared.woods2016_camera = make_woods2016_camera(prepared.scene, flags.renderer);
  }
}

}  // namespace

void print_advice(const std::vector<std::string>& advice, Console& console) {
  for (const std::string& sentence : advice) console.warn(sentence);
}

void prepare_scene(const RenderFlags& flags, const std::function<void()>& on_loaded,
                   Console& console, PreparedScene& prepared) {
  check_target(flags);
  // before a long load
  if (!is_scene_file(flags.input)) prepared.sensors = make_active_sensors(flags, {});
  SceneFile loaded = load(flags, console);
  prepared.sensors = make_active_sensors(flags, loaded.sensors);
  for (const ActiveSensor& active : prepared.sensors) {
    for (const std::string& note : active.sensor.notes) console.info(note);
    for (const std::string& sentence : implausible_numbers(active.sensor))
      console.warn(active.sensor.name + ": " + sentence);
  }
  prepared.files = files_read(flags, loaded, prepared.sensors);
  set_imus(flags, loaded, prepared);
  if (on_loaded) on_loaded();
  prepared.scene = std::move(loaded.scene);
  const std::vector<std::string>& given = flags.output.box_classes;
  prepared.boxed_classes = boxed_classes(
      prepared.scene.class_names, given.empty() ? loaded.box_classes : given, "--box-classes");
  apply_surface_option(flags, prepared.sensors.front().sensor, prepared.scene);
  pose_model(flags.pose, prepared.scene);
  double far_m = 0.0;
  for (const ActiveSensor& active : prepared.sensors)
    far_m = std::max(far_m, active.sensor.limits.far_m);
  const bool is_sized = flags.model.metres_per_unit || flags.pose.scale;
  print_advice(size_advice(prepared.scene, is_sized, far_m), console);
  place_sensors(flags, loaded, console, prepared);
  const ProgressScope progress(console, "preparing the scene");
  make_renderers(flags, prepared);
  for (ActiveSensor& active : prepared.sensors) {
    active.simulator =
        make_simulator(prepared, std::make_shared<const BeamCache>(active.sensor, active.beams));
  }
}

std::string label_of(const RenderFlags& flags, const ActiveSensor& active) {
  return flags.sensor_name.empty() ? active.name : std::string();
}

ActiveSensor& only_sensor(PreparedScene& prepared) {
  if (prepared.sensors.size() == 1) return prepared.sensors.front();
  throw Error({"scene file", fmt::format("a rig of {} sensors", prepared.sensors.size()),
               "one sensor here", "choose it with --sensor-name: " + names_of(prepared.sensors)});
}

Motion motion_of(RigMotion motion, const ActiveSensor& active) {
  return {.world_from_sensor = compose_extrinsic(motion.world_from_rig, active.rig_from_sensor),
          .world_from_instance = std::move(motion.world_from_instance)};
}

std::int64_t stamp_of(const PreparedScene& prepared, const ActiveSensor& active,
                      std::uint32_t number) {
  return prepared.start_ns + frame_interval(active.sensor, number).start_ns;
}

std::int64_t end_ns(const PreparedScene& prepared) {
  std::int64_t end = std::llround(prepared.duration_s.value_or(0.0) * 1e9);
  for (const ActiveSensor& active : prepared.sensors)
    end = std::max(end, frame_interval(active.sensor, active.frames - 1).end_ns);
  return prepared.start_ns + end;
}

void set_frame_header(const RenderFlags& flags, const PreparedScene& prepared,
                      const ActiveSensor& active, std::uint32_t number, Frame& frame) {
  frame.number = number;
  frame.sensor_id = active.id;
  frame.stamp_ns = stamp_of(prepared, active, number);
  frame.seed = flags.seed;
}

std::shared_ptr<Simulator> make_simulator(const PreparedScene& prepared,
                                          const std::shared_ptr<const BeamCache>& beam_cache) {
  std::shared_ptr<Simulator> simulator = make_simulator(
      prepared.scene, beam_cache, *prepared.renderer, prepared.woods2016_camera.get());
  simulator->set_boxed_classes(prepared.boxed_classes);
  return simulator;
}

std::shared_ptr<Simulator> make_simulator(const Scene& scene,
                                          const std::shared_ptr<const BeamCache>& beam_cache,
                                          Renderer& renderer, Woods2016Camera* camera) {
  auto simulator = std::make_shared<Simulator>(scene, beam_cache, renderer);
  if (camera != nullptr) simulator->set_return_replacement(woods2016_measurement(*camera));
  return simulator;
}

std::optional<SensorFrame> FrameOrder::next() {
  std::optional<std::size_t> first;
  std::int64_t first_ns = 0;
  for (std::size_t i = 0; i < sensors_.size(); ++i) {
    if (numbers_[i] >= sensors_[i].frames) continue;
    const std::int64_t start_ns = frame_interval(sensors_[i].sensor, numbers_[i]).start_ns;
    if (first && start_ns >= first_ns) continue;
    first = i;
    first_ns = start_ns;
  }
  if (!first) return std::nullopt;
  return SensorFrame{*first, numbers_[*first]++};
}

}  // namespace glidar::app
