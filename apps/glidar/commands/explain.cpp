// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/commands/commands.hpp>
#include <apps/glidar/options/option_group.hpp>
#include <apps/glidar/options/option_values.hpp>
#include <apps/glidar/options/stream_options.hpp>
#include <apps/glidar/run/console.hpp>
#include <apps/glidar/run/prepared_scene.hpp>
#include <apps/glidar/run/recorded_command.hpp>
#include <glidar/core/error.hpp>
#include <glidar/explain/trace_text.hpp>
#include <glidar/io/formats/las_scan.hpp>
#include <glidar/io/formats/sidecar.hpp>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <limits>
#include <memory>
#include <numeric>

namespace glidar::app {
namespace {

constexpr const char* kExplainExamples =
    R"(Repeats the measurement of a cloud by its sidecar (NAME.glidar.json) and prints the trace of one point:
the beam, the surface, the received signal, echoes, every noise step with its random numbers, and
the reported values.
Examples:
  glidar render builtin:asteroid --sensor VLP-16 --eye 4,0,0 -o scan.pcd
  glidar explain scan.pcd --index 812
  glidar explain scan.pcd --row 3 --col 200)";

struct ExplainFlags {
  std::string cloud;
  std::optional<std::int64_t> index;
  std::optional<std::int64_t> row;
  std::optional<std::int64_t> col;
  std::optional<std::int64_t> return_number;
};

/// The options of the `render` or `stream` command in a sidecar.
RenderFlags flags_of(const Sidecar& sidecar) {
  const std::vector<std::string>& arguments = sidecar.command.arguments;
  CLI::App command;
  if (!arguments.empty() && arguments.front() == "stream") {
    StreamFlags flags;
    add_stream_options(command, flags);
    parse_recorded(arguments, "stream", sidecar.path.string(), command);
    flags.render.duration_s.reset();
    flags.render.motion.to.reset();
    return flags.render;
  }
  RenderFlags flags;
  add_render_options(command, flags);
  add_per_frame_option(command, flags.output);
  parse_recorded(arguments, "render", sidecar.path.string(), command);
  return flags;
}

/// Throws Error when the models are not those of the cloud.
void check_models(const Sidecar& sidecar, const Scene& scene) {
  std::vector<std::string> hashes;
  for (const Instance& instance : scene.instances) {
    hashes.push_back(scene.sources.at(instance.mesh).hash);
  }
  if (hashes == sidecar.model_hashes) return;
  throw Error({sidecar.path.string(), "the models have changed",
               "the models at the time of writing", "render the cloud again"});
}

/// The frame of the point, and the index of the point in it.
struct PointPlace {
  const SidecarFrame& frame;
  std::size_t index = 0;
};

PointPlace place_of(const ExplainFlags& flags, const Sidecar& sidecar) {
  const std::vector<SidecarFrame>& frames = sidecar.frames;
  if (flags.row) {
    if (frames.size() == 1) return {frames.front()};
    throw Error({"--row and --col", fmt::format("a cloud of {} frames", frames.size()), "--index",
                 "select the point by its place in the file"});
  }
  auto index = static_cast<std::size_t>(*flags.index);
  std::size_t all = 0;
  for (const SidecarFrame& frame : frames) {
    if (index < all + frame.points) return {frame, index - all};
    all += frame.points;
  }
  throw Error({"--index", std::to_string(index),
               fmt::format("below {}, the number of points whose frames {} lists", all,
                           sidecar.path.filename().string())});
}

/// The entry of a row, column and return.
std::size_t selected_entry(const ExplainFlags& flags, const Beams& beams) {
  const auto pulses_rows = static_cast<std::int64_t>(beams.rows / beams.returns);
  const std::int64_t return_number = flags.return_number.value_or(0);
  if (*flags.row >= pulses_rows || *flags.col >= beams.cols || return_number >= beams.returns) {
    throw Error({"--row, --col, --return",
                 fmt::format("{}, {}, {}", *flags.row, *flags.col, return_number),
                 fmt::format("{} rows, {} columns, {} returns, each from 0", pulses_rows,
                             beams.cols, beams.returns)});
  }
  const std::int64_t row = return_number * pulses_rows + *flags.row;
  return static_cast<std::size_t>(row * beams.cols + *flags.col);
}

/// The entry of the frame that the flags select.
std::size_t entry_of(const ExplainFlags& flags, const Sidecar& sidecar, const PointPlace& place,
                     const Frame& frame, const Beams& beams) {
  if (flags.row) return selected_entry(flags, beams);
  const std::size_t points = place.frame.points;
  const bool is_las = format_for(flags.cloud).suffix == ".las";
  std::vector<std::uint32_t> entries = las_order(frame, beams);  // the cloud has only hits
  if (!is_las && points == beams.size()) {
    entries.resize(points);
    std::iota(entries.begin(), entries.end(), 0U);
  } else if (!is_las) {
    std::ranges::sort(entries);
  }
  if (sidecar.has_all_frames && !is_las && !beams.times_ns.empty())
    std::ranges::stable_sort(entries, {}, [&](std::uint32_t i) { return beams.times_ns[i]; });
  if (place.index < entries.size()) return entries[place.index];
  throw Error({sidecar.path.string(),
               fmt::format("a cloud of {} points from {} beams with {} hits", points, beams.size(),
                           entries.size()),
               "all beams, or all hits", "write the cloud again"});
}

/// Throws Error when the repeated frame is not that of the cloud.
void check_frame(const Sidecar& sidecar, const SidecarFrame& recorded, const Frame& frame) {
  if (frame_hash(frame) == recorded.hash) return;
  throw Error({sidecar.path.string(), "the repeated measurement differs from the recorded one",
               "the same models, scene and sensor files, and the same program",
               "write the cloud again"});
}

void check(const ExplainFlags& flags) {
  const bool by_pixel = flags.row || flags.col || flags.return_number;
  const bool is_whole = flags.index ? !by_pixel : flags.row && flags.col;
  if (is_whole) return;
  throw Error({"explain", flags.index ? "a point is selected in two ways" : "no point is selected",
               "--index N, or --row R and --col C, with --return K if it is not the first"});
}

int run_explain(const ExplainFlags& flags) {
  check(flags);
  Console console;
  const Sidecar sidecar = read_sidecar(flags.cloud);
  const PointPlace place = place_of(flags, sidecar);
  const RenderFlags render = flags_of(sidecar);
  compare_version(sidecar.version, sidecar.path.string(), console);
  enter_folder(sidecar.command, sidecar.path.string());
  PreparedScene prepared;
  prepare_scene(
      render, [] {}, console, prepared);
  check_models(sidecar, prepared.scene);
  Frame frame;
  const ActiveSensor& active = only_sensor(prepared);
  set_frame_header(render, prepared, active, place.frame.number, frame);
  const auto pick = [&](const Frame& repeated) {
    check_frame(sidecar, place.frame, repeated);
    return entry_of(flags, sidecar, place, repeated, *active.simulator->beams(repeated.number));
  };
  PointTrace trace;
  {
    const ProgressScope progress(console, "repeating the measurement");
    trace = explain(*active.simulator, active.motion, pick, frame,
                    [&console](double fraction) { console.set_progress(fraction); });
  }
  print_lines(stdout, format_trace(trace, *active.simulator, frame));
  return kDone;
}

}  // namespace

Command add_explain(CLI::App& program) {
  CLI::App& command =
      *program.add_subcommand("explain", "Trace the measurement of a point of a cloud");
  const auto flags = std::make_shared<ExplainFlags>();
  command.footer(kExplainExamples);
  command.add_option("CLOUD", flags->cloud, "Cloud written by render or stream, with its sidecar")
      ->required()
      ->type_name("");
  const OptionGroup group(command, "Point");
  const auto index = whole<std::int64_t>(0, std::numeric_limits<std::int64_t>::max());
  group.add("--index", "N", "Which point, from 0 in the order of the file", flags->index, index);
  group.add("--row", "R", "Which row of the sensor's beams, from 0; with --col", flags->row, index);
  group.add("--col", "C", "Which column, from 0; with --row", flags->col, index);
  group.add("--return", "K", "Which return of that beam, from 0 [0]", flags->return_number,
            whole<std::int64_t>(0, 15));
  return [flags] { return run_explain(*flags); };
}

}  // namespace glidar::app
