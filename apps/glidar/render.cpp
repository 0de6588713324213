// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/advice.hpp>
#include <apps/glidar/commands.hpp>
#include <apps/glidar/console.hpp>
#include <apps/glidar/exit_code.hpp>
#include <apps/glidar/information_options.hpp>
#include <apps/glidar/model_options.hpp>
#include <apps/glidar/motion_options.hpp>
#include <apps/glidar/numbers.hpp>
#include <apps/glidar/option_kinds.hpp>
#include <apps/glidar/output_options.hpp>
#include <apps/glidar/pose_options.hpp>
#include <apps/glidar/run_options.hpp>
#include <apps/glidar/sensor_options.hpp>
#include <glidar/core/error.hpp>
#include <glidar/io/scene_file.hpp>
#include <glidar/io/surfaces.hpp>
#include <glidar/simulate.hpp>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>

namespace glidar::app {
namespace {

constexpr const char* kExamples = R"(Examples:
  glidar render builtin:asteroid -o asteroid.pcd -o asteroid.png
  glidar render builtin:box --eye 4,-6,3 --target 0,0,0 --width 640 --height 480 --fov 40 -o box.ply
  glidar render builtin:torus --fx 500 --cx 300 --cy 250 -w 640 --height 480 -o torus.depth.png
  glidar render builtin:sphere --columns all -o sphere.npz
  glidar render builtin:box --sensor VLP-16 --eye 0,0,0 --columns all -o room.pcd -o room.png
  glidar render builtin:box --sensor VLP-16 --eye 0,0,0 --layout velodyne --dense -o scan.pcd
  glidar render builtin:box --sensor OS1-32 --eye 0,0,0 --camera-dr 0,1,0 --duration 1 -o scan.pcd
  glidar render builtin:asteroid --model-q 0.7,0,0.7,0 --camera-z 10 --pcd view
With your own files:
  glidar render part.stl --unit mm --up y -o part.pcd
  glidar render scene.yaml --sensor camera.yaml --cloud-frame ros -o cloud.npz

The pose as in the 2015 program: quaternions are attitudes, they take inertial vectors into the
body. The object stands at the inertial zero, the sensor at (0, 0, -D), and
  p_sensor = R(camera-q) (R(model-q)^T p_object + (0, 0, D))
in the frame x left, y up, z forward. --model-q goes with any other pose option too.
Exit codes: 0 done (also when nothing was hit), 2 bad input, 130 interrupted.)";

struct RenderFlags {
  std::string input;
  ModelFlags model;
  SensorFlags sensor;
  PoseFlags pose;
  MotionFlags motion;
  std::string surface;  ///< of the whole model; empty: its own
  OutputFlags output;
  InformationFlags information;
  RendererOptions renderer;
  std::string target = "float";  ///< what the renderer draws: float or paper
  std::uint64_t seed = 1;
  std::optional<double> duration_s;  ///< of a sequence of frames; empty: a single one
  bool quiet = false;
};

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

void tell(const std::vector<std::string>& advice, Console& console) {
  for (const std::string& sentence : advice) console.warn(sentence);
}

/// The seed as a whole number; the command line library would take -1 for a large one.
std::uint64_t parse_seed(std::string_view option, const std::string& text) {
  std::uint64_t seed = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, seed);
  if (error == std::errc() && stop == end) return seed;
  throw Error({.where = std::string(option),
               .found = "'" + text + "'",
               .allowed = "a whole number from 0 to 18446744073709551615",
               .remedy = ""});
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

/// The outputs of one frame of a sequence: NAME_000007.pcd for NAME.pcd.
OutputFlags numbered(const OutputFlags& flags, std::uint32_t frame) {
  const std::string number = fmt::format("_{:06}", frame);
  OutputFlags result = flags;
  for (std::string& path : result.paths) {
    path.insert(path.size() - format_for(path).suffix.size(), number);
  }
  if (!result.legacy_name.empty()) result.legacy_name += number;
  return result;
}

/// Builds the renderer; the console shows how long that takes.
std::unique_ptr<Renderer> prepare(const RenderFlags& flags, const Scene& scene, Console& console) {
  const Working working(console, "preparing the scene");
  return make_renderer(scene, flags.renderer);
}

bool has_paper_target(const RenderFlags& flags) {
  return flags.target == "paper";
}

void check_target(const RenderFlags& flags) {
  if (!has_paper_target(flags) || flags.renderer.kind == "opengl") return;
  throw Error({.where = "--render-target paper",
               .found = "the renderer " + flags.renderer.kind,
               .allowed = "opengl",
               .remedy = "add --renderer opengl"});
}

/// How the beams are cast, as the sidecar tells it.
std::string renderer_name(const RenderFlags& flags) {
  return flags.renderer.kind + (has_paper_target(flags) ? ", paper target" : "");
}

/// What --render-target paper measures with.
struct Paper {
  std::unique_ptr<PaperCamera> camera;  ///< nullptr for the float target
  PaperPicture picture;

  Paper(const RenderFlags& flags, const Scene& scene)
      : camera(has_paper_target(flags) ? make_paper_camera(scene, flags.renderer) : nullptr) {}

  std::optional<PaperTarget> target() {
    if (camera == nullptr) return {};
    return PaperTarget{.camera = *camera, .picture = picture};
  }
};

/// Measures the scene; the console shows how far that is.
void measure(const Setup& setup, const HitFields& fields, Console& console, Frame& frame) {
  const Working working(console, fmt::format("casting {} beams", setup.beams.size()));
  simulate(setup, fields, frame);
}

void print_summary(const View& view, const std::vector<Output>& outputs) {
  const FrameSummary s = summarise(view.frame);
  const double percent =
      100.0 * static_cast<double>(s.hits) / static_cast<double>(view.beams.size());
  fmt::print("{} x {} beams, {} hits ({:.1f} %)", view.beams.cols, view.beams.rows, s.hits,
             percent);
  const double offset_m = view.beams.range_offset_m;
  if (s.hits > 0) {
    fmt::print(", range {:.6g} to {:.6g} m", s.nearest_m + offset_m, s.farthest_m + offset_m);
  }
  fmt::print("\nwrote");
  for (const Output& output : outputs) fmt::print(" {}", output.path.string());
  fmt::print("\n");
}

/// The beams and where they start; the console shows how long that takes.
Beams aim(const RenderFlags& flags, const Sensor& sensor, const Scene& scene,
          const ScenePose& scene_pose, Console& console, Pose& world_from_sensor) {
  const Working working(console, "aiming the sensor");
  Beams beams = make_beams(sensor);
  world_from_sensor = pose_sensor(flags.pose, scene_pose, beams, scene);
  if (heads_along_x(beams) && !scene_pose.world_from_sensor && !sensor_pose_given(flags.pose)) {
    console.info(beside_advice(scene, world_from_sensor));
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

HitFields needed_fields(const RenderFlags& flags, const std::vector<Output>& outputs) {
  HitFields fields = fields_for(outputs);
  fields.normal = fields.normal || flags.information.wanted;
  return fields;
}

/// When the last beam of the last frame leaves.
std::int64_t last_firing_ns(const Sensor& sensor, const Beams& beams, std::uint32_t count) {
  const std::int64_t start_ns = scan_window(sensor, count - 1).start_ns;
  if (beams.times_ns.empty()) return start_ns;
  return start_ns + *std::max_element(beams.times_ns.begin(), beams.times_ns.end());
}

/// Writes a frame and says so.
void write(const RenderFlags& flags, const View& view, const std::vector<Output>& outputs,
           Console& console) {
  {
    const Working working(console, "writing");
    write_outputs(outputs, view.frame, view.beams, view.scene, console.report());
  }
  if (!flags.quiet) print_summary(view, outputs);
  tell_information(flags.information, view.frame, view.beams, outputs, flags.quiet);
}

int run(const RenderFlags& flags) {
  Console console(flags.quiet);
  check(flags.information);
  check_target(flags);
  Scene scene;
  Beams beams;
  Sensor sensor;
  const auto plan = [&](const OutputFlags& files) {
    return plan_outputs(
        files, flags.input,
        {.scene = scene, .sensor = sensor, .beams = beams, .renderer = renderer_name(flags)},
        console.report(), [&console](double fraction) { console.tell(fraction); });
  };
  std::vector<Output> outputs = plan(flags.output);
  if (!is_scene_file(flags.input)) sensor = make_sensor(flags.sensor, {});  // before a long load

  SceneFile loaded = load(flags, console);
  const std::vector<std::string> files = files_read(flags, loaded);
  protect_files(files, outputs);
  scene = std::move(loaded.scene);
  sensor = make_sensor(flags.sensor, loaded.sensor);
  cover(flags, sensor, scene);
  pose_model(flags.pose, scene);
  tell(size_advice(scene, !flags.model.unit.empty() || flags.pose.scale), console);
  Pose world_from_sensor = Pose::Identity();
  beams = aim(flags, sensor, scene, {loaded.world_from_sensor, loaded.looks_at}, console,
              world_from_sensor);

  const std::uint32_t count = frame_count(flags, sensor);
  const TimeSpan asked = {.first_ns = 0, .last_ns = last_firing_ns(sensor, beams, count)};
  const Motion motion =
      make_motion(flags, loaded, scene, world_from_sensor, asked, console.report());
  const auto renderer = prepare(flags, scene, console);
  Paper paper(flags, scene);
  const Setup setup{.scene = scene,
                    .sensor = sensor,
                    .beams = beams,
                    .motion = motion,
                    .renderer = *renderer,
                    .progress = [&console](double fraction) { console.tell(fraction); },
                    .paper = paper.target()};
  Frame frame;
  frame.seed = flags.seed;
  const View view{scene, sensor, beams, frame};
  for (std::uint32_t k = 0; k < count; ++k) {
    const ScanWindow window = scan_window(sensor, k);
    if (k > 0) beams = make_beams(sensor, window);
    frame.number = k;
    frame.stamp_ns = window.start_ns;
    measure(setup, needed_fields(flags, outputs), console, frame);
    if (k == 0) tell(view_advice(view), console);
    if (flags.duration_s) {
      outputs = plan(numbered(flags.output, k));
      protect_files(files, outputs);
    }
    write(flags, view, outputs, console);
  }
  return kDone;
}

}  // namespace

Command add_render(CLI::App& program) {
  CLI::App& command =
      *program.add_subcommand("render", "Measure a model or scene with a 3D sensor");
  const auto flags = std::make_shared<RenderFlags>();
  command.footer(output_names_text() + kExamples);
  command.add_option("MODEL", flags->input, "Model file, builtin:NAME or scene file (.yaml)")
      ->required()
      ->type_name("");
  add_output_flags(command, flags->output);
  add_information_flags(command, flags->information);
  add_sensor_flags(command, flags->sensor);
  add_pose_flags(command, flags->pose);
  add_motion_flags(command, flags->motion);
  add_model_flags(command, flags->model);
  add_text(command,
           {"--surface", "NAME", "Surface of the model (glidar sensors --surfaces)", "Model"},
           flags->surface);
  const std::string group = "Run";
  add_run_flags(command, flags->renderer, group);
  add_choice(command,
             {"--render-target", "NAME",
              "What opengl draws: float, or paper (8 bits of light, 16 of depth) [float]", group},
             {"float", "paper"}, flags->target);
  add_option(command, {"--seed", "N", "Seed of random numbers, kept in the sidecar [1]", group},
             [&seed = flags->seed](std::string_view option, const std::string& text) {
               seed = parse_seed(option, text);
             });
  add_number(command, {"--duration", "S", "Numbered frames, NAME_000000 ..., for so long", group},
             flags->duration_s);
  command.add_flag("--quiet", flags->quiet, "No summary and no progress; warnings stay")
      ->group(group);
  return [flags] { return run(*flags); };
}

}  // namespace glidar::app
