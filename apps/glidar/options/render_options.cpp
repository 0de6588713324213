// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/options/render_options.hpp>

#include <glidar/io/config/length_unit.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>
#include <apps/glidar/options/help_text.hpp>
#include <apps/glidar/options/option_group.hpp>
#include <apps/glidar/options/option_values.hpp>

#include <limits>

namespace glidar::app {

void add_model_options(CLI::App& command, ModelOptions& options) {
  const OptionGroup group(command, "Model");
  std::vector<std::pair<std::string, double>> units;
  for (const Named<double>& unit : kLengthUnits) units.emplace_back(unit.name, unit.value);
  group.add("--unit", "UNIT", "Unit: mm, cm, m, in or ft [as the file declares, or m]",
            options.metres_per_unit, one_of(units));
  group.add("--up", "AXIS", "Axis that points up: x, y or z [as the file declares, or z]",
            options.up, one_of<Axis>({{"x", Axis::x}, {"y", Axis::y}, {"z", Axis::z}}));
  group.add_flag("--centre", "Move the centre of the model's bounding box to its origin",
                 options.centre);
  group.add_repeatable(
      "--texture-folder", "DIR", "Folder of textures outside the model's folder [none]; repeatable",
      [&options](const std::string& text) { options.texture_folders.emplace_back(text); });
  group.add_flag("--no-cache", "Neither read nor write the model cache", options.use_cache, false);
  group.add("--cache-folder", "DIR", "Folder of the model cache [~/.cache/glidar]",
            [&options](const std::string& text) { options.cache_folder = text; });
}

namespace {

void add_fisher_options(CLI::App& command, FisherFlags& flags) {
  const OptionGroup group(command, "Fisher information");
  group.add_flag("--fisher", "Cramer-Rao bounds of the sensor's pose, to NAME.fisher.json",
                 flags.is_requested);
  group.add("--range-sigma", "M", "Sigma of ranges if the sensor has no noise, m [0.01]",
            flags.sigma_m, number(kAboveZero, kFinite, "a finite number above 0"));
  require_option(command, {"--range-sigma"}, "--fisher");
}

}  // namespace

RendererOptions hit_renderer(const RenderFlags& flags) {
  RendererOptions options = flags.renderer;
  if (flags.quantized_framebuffer) options.kind = "auto";
  return options;
}

std::string renderer_name(const RenderFlags& flags) {
  return flags.renderer.kind + (flags.quantized_framebuffer ? ", quantized framebuffer" : "");
}

void add_run_options(CLI::App& command, RendererOptions& options, const std::string& heading) {
  const OptionGroup group(command, heading);
  std::vector<std::string> names = renderer_kinds();
  names.emplace_back("opengl");  // another name of gpu
  group.add("--renderer", "NAME",
            fmt::format("How beams are cast: {} [{}]; opengl: gpu",
                        fmt::join(renderer_kinds(), ", "), options.kind),
            options.kind, one_of(std::move(names)));
  add_threads_option(group, options);
  constexpr unsigned kMaxDevice = 63;
  group.add("--graphics-device", "N", "Device for gpu [the first that works]",
            options.graphics_device, whole(0U, kMaxDevice));
}

void add_threads_option(const OptionGroup& group, RendererOptions& options) {
  constexpr unsigned kMaxThreads = 1024;
  group.add("-j,--threads", "N", "Number of threads; 0: one per processor [0]", options.threads,
            whole(0U, kMaxThreads));
}

void add_render_options(CLI::App& command, RenderFlags& flags) {
  command.add_option("MODEL", flags.input, "Model file, builtin:NAME or scene file (.yaml)")
      ->required()
      ->type_name("");
  add_output_options(command, flags.output);
  add_box_classes_option(command, flags.output);
  add_fisher_options(command, flags.fisher);
  add_sensor_options(command, flags.sensor);
  OptionGroup(command, "Sensor")
      .add("--sensor-name", "NAME", "Measure with this sensor of the scene file's rig [all]",
           flags.sensor_name);
  OptionGroup(command, "Sensor")
      .add("--imu", "NAME", "IMU at the sensor: a preset or a file [those of the scene file]",
           flags.imu);
  add_pose_options(command, flags.pose);
  add_motion_options(command, flags.motion);
  add_model_options(command, flags.model);
  OptionGroup(command, "Model")
      .add("--surface", "NAME", "Surface preset of the model (see glidar sensors --surfaces)",
           flags.surface);
  add_run_options(command, flags.renderer, "Run");
  const OptionGroup run(command, "Run");
  run.add("--seed", "N", "Seed of random numbers, kept in the sidecar [1]", flags.seed,
          whole<std::uint64_t>(0, std::numeric_limits<std::uint64_t>::max()));
  run.add("--duration", "S", "Measure for S seconds: NAME, or NAME_000000 ... per frame",
          flags.duration_s, parse_number);
  forbid_together(command, {"--duration"}, {"--to"});
  run.add_flag("-q,--quiet", "No summary and no progress, only warnings", flags.quiet);
  add_legacy_output_option(command, flags.output);
  add_woods2016_pose_options(command, flags.pose);
  OptionGroup(command, kWoods2016Heading)
      .add_flag("--quantized-framebuffer", "Measure by the paper's 8-bit framebuffer, with opengl",
                flags.quantized_framebuffer);
}

}  // namespace glidar::app
