// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/advice.hpp>
#include <apps/glidar/commands.hpp>
#include <apps/glidar/console.hpp>
#include <apps/glidar/exit_code.hpp>
#include <apps/glidar/model_options.hpp>
#include <apps/glidar/output_options.hpp>
#include <apps/glidar/pose_options.hpp>
#include <apps/glidar/sensor_options.hpp>
#include <glidar/core/error.hpp>
#include <glidar/io/scene_file.hpp>
#include <glidar/simulate.hpp>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <charconv>
#include <memory>

namespace glidar::app {
namespace {

constexpr const char* kExamples = R"(Examples:
  glidar render builtin:asteroid -o asteroid.pcd -o asteroid.png
  glidar render builtin:box --eye 4,-6,3 --target 0,0,0 --width 640 --height 480 --fov 40 -o box.ply
  glidar render builtin:torus --fx 500 --cx 300 --cy 250 -w 640 --height 480 -o torus.depth.png
  glidar render builtin:sphere --columns all -o sphere.npz
  glidar render builtin:box --sensor VLP-16 --eye 0,0,0 --columns all -o room.pcd -o room.png
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
  OutputFlags output;
  std::string renderer = "embree";
  unsigned threads = 0;
  std::string seed_text = "1";
  bool quiet = false;
};

bool is_scene_file(const std::string& input) {
  return input.ends_with(".yaml") || input.ends_with(".yml");
}

SceneFile load(const RenderFlags& flags, const Report& report) {
  const ModelOptions options = model_options(flags.model);
  if (is_scene_file(flags.input)) return load_scene_file(flags.input, options, report);
  SceneFile loaded;
  add_model(loaded.scene, load_model(flags.input, options, report));
  return loaded;
}

void tell(const std::vector<std::string>& advice, Console& console) {
  for (const std::string& sentence : advice) console.warn(sentence);
}

/// The seed as a whole number; the command line library would take -1 for a large one.
std::uint64_t seed_of(const std::string& text) {
  std::uint64_t seed = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, seed);
  if (error == std::errc() && stop == end) return seed;
  throw Error({.where = "--seed",
               .found = "'" + text + "'",
               .allowed = "a whole number from 0 to 18446744073709551615",
               .remedy = ""});
}

void measure(const RenderFlags& flags, const Setup& setup, const HitFields& fields,
             Console& console, Frame& frame) {
  const Working working(console, fmt::format("casting {} beams", setup.beams.size()));
  frame.seed = seed_of(flags.seed_text);
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

int run(const RenderFlags& flags) {
  Console console(flags.quiet);
  Scene scene;
  Beams beams;
  Sensor sensor;
  const std::vector<Output> outputs =
      plan_outputs(flags.output, flags.input,
                   {.scene = scene, .sensor = sensor, .beams = beams, .renderer = flags.renderer});
  if (!is_scene_file(flags.input)) sensor = make_sensor(flags.sensor, {});  // before a long load

  SceneFile loaded = load(flags, console.report());
  console.clear();
  scene = std::move(loaded.scene);
  sensor = make_sensor(flags.sensor, loaded.sensor);
  beams = make_beams(sensor);
  pose_model(flags.pose, scene);
  tell(size_advice(scene, !flags.model.unit.empty() || flags.pose.scale), console);
  const ScenePose scene_pose = {loaded.world_from_sensor, loaded.looks_at};
  const Pose world_from_sensor = pose_sensor(flags.pose, scene_pose, beams, scene);
  if (heads_along_x(beams) && !scene_pose.world_from_sensor && !sensor_pose_given(flags.pose)) {
    console.info(beside_advice(scene, world_from_sensor));
  }

  const auto renderer = make_renderer(scene, {.kind = flags.renderer, .threads = flags.threads});
  const Motion motion = standing_still(scene, world_from_sensor);
  Frame frame;
  measure(flags, {scene, sensor, beams, motion, *renderer}, fields_for(outputs), console, frame);

  const View view{scene, sensor, beams, frame};
  tell(view_advice(view), console);
  {
    const Working working(console, "writing");
    write_outputs(outputs, frame, beams, scene);
  }
  if (!flags.quiet) print_summary(view, outputs);
  return kDone;
}

}  // namespace

Command add_render(CLI::App& program) {
  CLI::App& command =
      *program.add_subcommand("render", "Measure a model or scene with a 3D sensor");
  const auto flags = std::make_shared<RenderFlags>();
  command.footer(kExamples);
  command.add_option("input", flags->input, "Model file, builtin:NAME or scene file (.yaml)")
      ->required()
      ->type_name("MODEL|SCENE.yaml");
  add_output_flags(command, flags->output);
  add_sensor_flags(command, flags->sensor);
  add_pose_flags(command, flags->pose);
  add_model_flags(command, flags->model);
  const std::string group = "Run";
  command.add_option("--renderer", flags->renderer, "Renderer: embree [embree]")
      ->type_name("NAME")
      ->group(group);
  command.add_option("--threads", flags->threads, "Threads, 0: all processors [0]")
      ->check(CLI::Range(0, 1024))
      ->type_name("N")
      ->group(group);
  command.add_option("--seed", flags->seed_text, "Seed of random numbers, kept in the sidecar [1]")
      ->type_name("N")
      ->group(group);
  command.add_flag("--quiet", flags->quiet, "No summary and no progress; warnings stay")
      ->group(group);
  return [flags] { return run(*flags); };
}

}  // namespace glidar::app
