// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/session.hpp>

#include <apps/glidar/advice.hpp>
#include <apps/glidar/numbers.hpp>
#include <glidar/core/error.hpp>
#include <glidar/io/scene_file.hpp>
#include <glidar/io/surfaces.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace glidar::app {
namespace {

bool is_scene_file(const std::string& input) {
  return input.ends_with(".yaml") || input.ends_with(".yml");
}

/// Gives the model of a single file the surface asked for.
void cover(const RenderFlags& flags, const Sensor& sensor, Scene& scene) {
  if (flags.surface.empty()) return;
  const auto refuse = [](const char* found, const char* remedy) {
    throw Error({.where = "--surface", .found = found, .allowed = "", .remedy = remedy});
  };
  if (is_scene_file(flags.input)) {
    refuse("the input is a scene file", "write 'surface: ...' into its materials");
  }
  if (!sensor.pulse) {
    refuse("the sensor has no pulse light", "choose one that has, such as VLP-16");
  }
  const Surface surface = find_surface(flags.surface, "--surface");
  for (Material& material : scene.materials) apply_surface(surface, material);
}

/// Whether the view is chosen by us: then it matters what is up.
bool is_framed(const RenderFlags& flags) {
  return flags.model.up.empty() && flags.pose.model_q.empty() && flags.pose.model_r.empty() &&
         flags.pose.up_vector.empty() && !sensor_pose_given(flags.pose);
}

SceneFile load(const RenderFlags& flags, Console& console) {
  const Working working(console, "loading " + flags.input);
  const ModelOptions options = model_options(flags.model);
  if (is_scene_file(flags.input)) return load_scene_file(flags.input, options, console.report());
  SceneFile loaded;
  Model model = load_model(flags.input, options, console.report());
  const std::string up_hint =
      is_framed(flags) ? up_advice(model.format, bounds(model.mesh)) : std::string();
  if (!up_hint.empty()) console.info(up_hint);
  add_model(loaded.scene, std::move(model));
  return loaded;
}

/// Scene and sensor files, models and what belongs to these: textures, materials, buffers.
std::vector<std::string> files_read(const RenderFlags& flags, const SceneFile& loaded) {
  std::vector<std::string> files = loaded.files;
  if (!flags.sensor.file.empty()) files.push_back(flags.sensor.file);
  for (const std::string& file : files_of(flags.motion)) files.push_back(file);
  for (const MeshSource& source : loaded.scene.sources)
    files.insert(files.end(), source.files.begin(), source.files.end());
  return files;
}

/// How many frames there are in the duration asked for; one without.
std::uint32_t frame_count(const RenderFlags& flags, const Sensor& sensor) {
  if (!flags.duration_s) return 1;
  constexpr double kMostFrames = 1e6;
  constexpr double kRounding = 1e-9;  // 0.3 s at 10 Hz are three frames
  const double frames = std::ceil(*flags.duration_s * sensor.rate_hz - kRounding);
  require(*flags.duration_s > 0.0 && frames <= kMostFrames, "--duration", *flags.duration_s,
          "seconds above 0, up to a million frames");
  return static_cast<std::uint32_t>(std::max(1.0, frames));
}

/// The beams and where they start; the console shows how long that takes.
Beams aim(const RenderFlags& flags, const SceneFile& loaded, const Session& session,
          Console& console, Pose& world_from_sensor) {
  const Working working(console, "aiming the sensor");
  Beams beams = make_beams(session.sensor);
  const ScenePose in_file{loaded.world_from_sensor, loaded.looks_at};
  world_from_sensor = pose_sensor(flags.pose, in_file, beams, session.scene);
  const bool is_placed = in_file.world_from_sensor || loaded.sensor_motion ||
                         sensor_pose_given(flags.pose) || !flags.motion.trajectory.empty();
  if (!looks_along_z(beams) && !is_placed) {
    console.info(beside_advice(session.scene, world_from_sensor));
  }
  return beams;
}

/// How all moves; tells which poses at time 0 are only the end of a trajectory.
Motion make_motion(const RenderFlags& flags, const SceneFile& loaded, const Scene& scene,
                   const Pose& world_from_sensor, const TimeSpan& asked, const Report& report) {
  const Motion motion =
      moving(scene,
             sensor_trajectory(flags.motion, world_from_sensor, sensor_pose_given(flags.pose),
                               loaded.sensor_motion),
             instance_trajectories(flags.motion, scene, loaded.world_from_instance));
  warn_of_held_poses(motion.world_from_sensor, "sensor", asked, report);
  for (std::size_t i = 0; i < motion.world_from_instance.size(); ++i) {
    warn_of_held_poses(motion.world_from_instance[i], scene.instances[i].name, asked, report);
  }
  return motion;
}

/// When the last beam of the last frame leaves.
std::int64_t last_firing_ns(const Sensor& sensor, const Beams& beams, std::uint32_t count) {
  const std::int64_t start_ns = scan_window(sensor, count - 1).start_ns;
  if (beams.times_ns.empty()) return start_ns;
  return start_ns + *std::max_element(beams.times_ns.begin(), beams.times_ns.end());
}

void check_target(const RenderFlags& flags) {
  for (const std::string& path : flags.output.paths) {
    if (has_paper_target(flags) || format_for(path).suffix != ".paper.png") continue;
    throw Error({.where = "--output, " + path,
                 .found = "the float target, which draws no such picture",
                 .allowed = "this output with --render-target paper",
                 .remedy = "add --renderer opengl --render-target paper"});
  }
  if (!has_paper_target(flags) || flags.renderer.kind == "opengl") return;
  throw Error({.where = "--render-target paper",
               .found = "the renderer " + flags.renderer.kind,
               .allowed = "opengl",
               .remedy = "add --renderer opengl"});
}

/// Where sensor and objects are and how they move.
void place_all(const RenderFlags& flags, const SceneFile& loaded, Console& console,
               Session& session) {
  Pose world_from_sensor = Pose::Identity();
  session.beams = aim(flags, loaded, session, console, world_from_sensor);
  session.frames = frame_count(flags, session.sensor);
  const TimeSpan asked = {.first_ns = 0,
                          .last_ns = last_firing_ns(session.sensor, session.beams, session.frames)};
  session.motion =
      make_motion(flags, loaded, session.scene, world_from_sensor, asked, console.report());
}

}  // namespace

void tell(const std::vector<std::string>& advice, Console& console) {
  for (const std::string& sentence : advice) console.warn(sentence);
}

void open(const RenderFlags& flags, const std::function<void()>& on_loaded, Console& console,
          Session& session) {
  check_target(flags);
  // before a long load
  if (!is_scene_file(flags.input)) session.sensor = make_sensor(flags.sensor, {});
  SceneFile loaded = load(flags, console);
  session.files = files_read(flags, loaded);
  if (on_loaded) on_loaded();
  session.scene = std::move(loaded.scene);
  session.sensor = make_sensor(flags.sensor, loaded.sensor);
  cover(flags, session.sensor, session.scene);
  pose_model(flags.pose, session.scene);
  tell(size_advice(session.scene, !flags.model.unit.empty() || flags.pose.scale), console);
  place_all(flags, loaded, console, session);
  const Working working(console, "preparing the scene");
  session.renderer = make_renderer(session.scene, flags.renderer);
  if (has_paper_target(flags)) {
    session.paper = make_paper_camera(session.scene, flags.renderer);
  }
}

void turn_to(const RenderFlags& flags, std::uint32_t number, Session& session, Frame& frame) {
  const ScanWindow window = scan_window(session.sensor, number);
  if (number > 0) session.beams = make_beams(session.sensor, window);
  frame.number = number;
  frame.stamp_ns = window.start_ns;
  frame.seed = flags.seed;
}

Setup setup_of(const Session& session, Console& console) {
  Setup setup{.scene = session.scene,
              .sensor = session.sensor,
              .beams = session.beams,
              .motion = session.motion,
              .renderer = *session.renderer,
              .progress = [&console](double fraction) { console.tell(fraction); }};
  if (session.paper) setup.paper.emplace(PaperTarget{.camera = *session.paper});
  return setup;
}

}  // namespace glidar::app
