// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/options/render_options.hpp>

#include <apps/glidar/options/option_kinds.hpp>
#include <apps/glidar/options/run_options.hpp>
#include <glidar/core/error.hpp>

#include <CLI/CLI.hpp>

#include <charconv>
#include <string_view>

namespace glidar::app {
namespace {

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

}  // namespace

std::string renderer_name(const RenderFlags& flags) {
  return flags.renderer.kind + (has_paper_target(flags) ? ", paper target" : "");
}

void add_render_flags(CLI::App& command, RenderFlags& flags) {
  command.add_option("MODEL", flags.input, "Model file, builtin:NAME or scene file (.yaml)")
      ->required()
      ->type_name("");
  add_output_flags(command, flags.output);
  add_information_flags(command, flags.information);
  add_sensor_flags(command, flags.sensor);
  add_pose_flags(command, flags.pose);
  add_motion_flags(command, flags.motion);
  add_model_flags(command, flags.model);
  add_text(command,
           {"--surface", "NAME", "Surface of the model (glidar sensors --surfaces)", "Model"},
           flags.surface);
  add_text(
      command,
      {"--sensor-name", "NAME", "Only this one of the sensors on the scene file's rig", "Sensor"},
      flags.mount);
  const std::string group = "Run";
  add_run_flags(command, flags.renderer, group);
  add_choice(
      command,
      {"--render-target", "NAME", "What opengl draws: float, paper (8 and 16 bits) [float]", group},
      {"float", "paper"}, flags.target);
  add_option(command, {"--seed", "N", "Seed of random numbers, kept in the sidecar [1]", group},
             [&seed = flags.seed](std::string_view option, const std::string& text) {
               seed = parse_seed(option, text);
             });
  add_number(command, {"--duration", "S", "Numbered frames, NAME_000000 ..., for so long", group},
             flags.duration_s);
  command.add_flag("--quiet", flags.quiet, "No summary and no progress; warnings stay")
      ->group(group);
}

}  // namespace glidar::app
