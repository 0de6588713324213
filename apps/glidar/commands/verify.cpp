// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/commands/commands.hpp>
#include <apps/glidar/options/render_options.hpp>
#include <apps/glidar/run/console.hpp>
#include <glidar/core/version.hpp>
#include <glidar/verify/verify.hpp>

#include <CLI/CLI.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <memory>

namespace glidar::app {
namespace {

constexpr const char* kVerifyExamples = R"(Examples:
  glidar verify
  glidar verify --threads 1 --json
  glidar verify --renderer raster

Each row is one case with one shape at one distance from the sensor. "One shape at rest" measures a
shape that grows with the distance and one of 1 m, at the world's origin and 1 km and 1000 km from
it (by its pose, and by its vertices). docs/internals/accuracy.md lists the hard and large cases.
Scope: hit or miss, instance, triangle, range and every geometric column of hits (normals, depth,
cosines, barycentric weights, points of the object), with several tiles, 1,000 instances, 209,088
triangles, culled back faces and motion; rays through lenses; signals of the lidar equation, echoes
of beams with a footprint, poses and radial velocities of a moving sensor. Every beam is compared
with closed forms in extended precision, which share no code with what they verify.
Not covered: textures, weather, noise, depth from raw images, files and messages.
With "one shape at rest" rays that pass an edge at less than 2e-6 of the shape's radius are not
compared.
Bounds: range within 0.001 ulp of float32, normals within 1e-6 rad, no wrong hit, miss or id. The
column "other" is the largest error of all other quantities, as a share of its bound: at most 1.
raster supports pinhole cameras only: cases with other beams do not apply.
A known failure is a documented limit of a renderer, up to a known number of wrong rays and a known
range error; anything worse is a failure. FIXED: a known failure passes on this machine.
Exit codes: 0 all passed or known, 1 a failure, 2 bad input.)";

struct VerifyFlags {
  RendererOptions renderer;
  bool json = false;
};

void print_row(const AccuracyCase& row) {
  const VerifyResult& r = row.result;
  if (!row.applies) {
    print("{:<25} {:<15} {:>8}  not applicable: this renderer does not cast such beams\n", row.name,
          row.shape, row.distance_m);
    return;
  }
  print("{:<25} {:<15} {:>8} {:>7} {:>7} {:>6} {:>9.2e} {:>9.2e} {:>9.2e} {:>8.1e} {:>5}  {}\n",
        row.name, row.shape, row.distance_m, r.compared_hits, r.compared_misses, r.near_edges,
        r.range_error_m, r.range_error_ulp, r.normal_error_rad, r.other_error, r.wrong(),
        verdict_name(row.verdict()));
}

/// The known failures with their reasons.
void print_known(const std::vector<AccuracyCase>& rows) {
  for (const AccuracyCase& row : rows) {
    if (row.known.reason.empty() || !row.applies) continue;
    const VerifyResult& r = row.result;
    if (row.verdict() == Verdict::fixed) {
      print("FIXED: {}, {}, {} m passes here but is listed as a known failure\n", row.name,
            row.shape, row.distance_m);
      continue;
    }
    print(
        "{}: {}, {}, {} m: {} wrong hits, {} wrong misses, {} wrong ids of {} rays, "
        "range error {:.2e} ulp; {}\n",
        verdict_name(row.verdict()), row.name, row.shape, row.distance_m, r.wrong_hits,
        r.wrong_misses, r.wrong_ids, r.rays, r.range_error_ulp, row.known.reason);
    if (row.verdict() == Verdict::failed) {
      print("  more than is known: at most {} wrong rays, range error {:g} ulp\n",
            std::floor(row.known.max_wrong_share * static_cast<double>(r.rays)),
            row.known.max_range_error_ulp);
    }
  }
}

std::size_t count(const std::vector<AccuracyCase>& rows, Verdict verdict) {
  return static_cast<std::size_t>(std::count_if(
      rows.begin(), rows.end(), [&](const AccuracyCase& row) { return row.verdict() == verdict; }));
}

void print_table(const std::vector<AccuracyCase>& rows, const std::string& renderer) {
  constexpr const char* kHead =
      "{:<25} {:<15} {:>8} {:>7} {:>7} {:>6} {:>9} {:>9} {:>9} {:>8} {:>5}\n";
  print("glidar {}, renderer {}\n", version(), renderer);
  print(kHead, "case", "shape", "distance", "hits", "misses", "edge", "range err", "range err",
        "normal", "other", "wrong");
  print(kHead, "", "", "m", "tested", "tested", "skip", "m", "ulp (f32)", "rad", "bounds", "");
  VerifyResult all;
  for (const AccuracyCase& row : rows) {
    print_row(row);
    if (row.verdict() == Verdict::passed) all.add(row.result);
  }
  print_known(rows);
  print("bounds: range {} ulp of float32, normal {} rad, no wrong hit, miss or id\n",
        kRangeBound_ulp, kNormalBound_rad);
  print(
      "{}: {} rows passed ({} rays, largest range error {:.2e} ulp, normal error {:.2e} rad), "
      "{} failed, {} known failures, {} fixed, {} not applicable\n",
      all_passed(rows) ? "passed" : "FAILED", count(rows, Verdict::passed), all.rays,
      all.range_error_ulp, all.normal_error_rad, count(rows, Verdict::failed),
      count(rows, Verdict::known_failure), count(rows, Verdict::fixed),
      count(rows, Verdict::not_applicable));
}

nlohmann::ordered_json json_of(const AccuracyCase& row) {
  const VerifyResult& r = row.result;
  return {{"case", row.name},
          {"shape", row.shape},
          {"distance_m", row.distance_m},
          {"rays", r.rays},
          {"compared_hits", r.compared_hits},
          {"compared_misses", r.compared_misses},
          {"near_edges", r.near_edges},
          {"wrong_hits", r.wrong_hits},
          {"wrong_misses", r.wrong_misses},
          {"wrong_ids", r.wrong_ids},
          {"max_range_error_m", r.range_error_m},
          {"max_range_error_ulp", r.range_error_ulp},
          {"max_normal_error_rad", r.normal_error_rad},
          {"max_other_error", r.other_error},
          {"known_failure", row.known.reason},
          {"verdict", verdict_name(row.verdict())},
          {"passed", row.verdict() == Verdict::passed}};
}

void print_report(const std::vector<AccuracyCase>& rows, const std::string& renderer) {
  nlohmann::ordered_json table = nlohmann::ordered_json::array();
  for (const AccuracyCase& row : rows) table.push_back(json_of(row));
  const nlohmann::ordered_json report = {
      {"version", version()},
      {"renderer", renderer},
      {"bounds", {{"range_ulp", kRangeBound_ulp}, {"normal_rad", kNormalBound_rad}}},
      {"passed", all_passed(rows)},
      {"rows", table}};
  print_json(report);
}

int run_verify(const VerifyFlags& flags) {
  Console console;
  std::vector<AccuracyCase> rows;
  {
    const ProgressScope progress(console, "verifying");
    rows = verify(flags.renderer, [&console](double fraction) { console.set_progress(fraction); });
  }
  if (flags.json) {
    print_report(rows, flags.renderer.kind);
  } else {
    print_table(rows, flags.renderer.kind);
  }
  return all_passed(rows) ? kDone : kCheckFailed;
}

}  // namespace

Command add_verify(CLI::App& program) {
  CLI::App& command = *program.add_subcommand(
      "verify", "Verify hits, their columns and measurements on this machine by closed forms");
  const auto flags = std::make_shared<VerifyFlags>();
  command.footer(kVerifyExamples);
  add_run_options(command, flags->renderer, "Options");
  command.add_flag("--json", flags->json, "Print JSON instead of a table");
  return [flags] { return run_verify(*flags); };
}

}  // namespace glidar::app
