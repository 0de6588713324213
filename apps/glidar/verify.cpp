// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/commands.hpp>
#include <apps/glidar/console.hpp>
#include <apps/glidar/exit_code.hpp>
#include <apps/glidar/run_options.hpp>
#include <glidar/core/version.hpp>
#include <glidar/verify/verify.hpp>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <memory>

namespace glidar::app {
namespace {

constexpr const char* kExamples = R"(Examples:
  glidar verify
  glidar verify --threads 1 --json

Each row is one shape at one distance from the sensor, as a shape that grows with the distance and
as one of 1 m, at the world's zero and 1 km and 1000 km from it (by its pose, and by its vertices).
Every ray is judged by the shape's closed form in extended precision, worked out apart from all
rendering code. Rays that pass an edge nearer than 2e-6 of the shape's radius are not judged.
Bounds: range within 1 step (ulp) of float32, normals within 1e-6 rad, no wrong hit, no wrong miss.
Exit codes: 0 within all bounds, 1 not, 2 bad input.)";

struct VerifyFlags {
  RendererOptions renderer;
  bool json = false;
};

void print_table(const std::vector<VerifyRow>& rows, const std::string& renderer) {
  constexpr const char* kHead = "{:<16} {:>10} {:>8} {:>8} {:>8} {:>11} {:>11} {:>11} {:>6}  {}\n";
  fmt::print("glidar {}, renderer {}\n", version(), renderer);
  fmt::print(kHead, "shape", "distance", "hits", "misses", "at edge", "range err", "range err",
             "normal err", "wrong", "");
  fmt::print(kHead, "", "m", "judged", "judged", "unjudged", "m", "ulp (f32)", "rad", "", "");
  for (const VerifyRow& row : rows) {
    const VerifyResult& r = row.result;
    fmt::print("{:<16} {:>10} {:>8} {:>8} {:>8} {:>11.2e} {:>11.2e} {:>11.2e} {:>6}  {}\n",
               row.shape, row.distance_m, r.judged_hits, r.judged_misses, r.near_edges,
               r.range_error_m, r.range_error_ulp, r.normal_error_rad,
               r.wrong_hits + r.wrong_misses, r.passed() ? "ok" : "FAILED");
  }
  VerifyResult all;
  for (const VerifyRow& row : rows) all.add(row.result);
  fmt::print("bounds: range {} ulp of float32, normal {} rad, no wrong hit or miss\n",
             kRangeBound_ulp, kNormalBound_rad);
  fmt::print(
      "{}: {} rays, largest range error {:.2e} ulp, largest normal error {:.2e} rad, "
      "{} wrong hits, {} wrong misses\n",
      all_passed(rows) ? "passed" : "FAILED", all.rays, all.range_error_ulp, all.normal_error_rad,
      all.wrong_hits, all.wrong_misses);
}

void print_json(const std::vector<VerifyRow>& rows, const std::string& renderer) {
  nlohmann::ordered_json table = nlohmann::ordered_json::array();
  for (const VerifyRow& row : rows) {
    const VerifyResult& r = row.result;
    table.push_back({{"shape", row.shape},
                     {"distance_m", row.distance_m},
                     {"rays", r.rays},
                     {"judged_hits", r.judged_hits},
                     {"judged_misses", r.judged_misses},
                     {"near_edges", r.near_edges},
                     {"wrong_hits", r.wrong_hits},
                     {"wrong_misses", r.wrong_misses},
                     {"max_range_error_m", r.range_error_m},
                     {"max_range_error_ulp", r.range_error_ulp},
                     {"max_normal_error_rad", r.normal_error_rad},
                     {"passed", r.passed()}});
  }
  const nlohmann::ordered_json report = {
      {"version", version()},
      {"renderer", renderer},
      {"bounds", {{"range_ulp", kRangeBound_ulp}, {"normal_rad", kNormalBound_rad}}},
      {"passed", all_passed(rows)},
      {"rows", table}};
  fmt::print("{}\n", report.dump(2));
}

int run(const VerifyFlags& flags) {
  Console console;
  std::vector<VerifyRow> rows;
  {
    const Working working(console, "verifying");
    rows = verify(flags.renderer, [&console](double fraction) { console.tell(fraction); });
  }
  if (flags.json) {
    print_json(rows, flags.renderer.kind);
  } else {
    print_table(rows, flags.renderer.kind);
  }
  return all_passed(rows) ? kDone : kCheckFailed;
}

}  // namespace

Command add_verify(CLI::App& program) {
  CLI::App& command =
      *program.add_subcommand("verify", "Prove the accuracy of ranges and normals on this machine");
  const auto flags = std::make_shared<VerifyFlags>();
  command.footer(kExamples);
  add_run_flags(command, flags->renderer, "Options");
  command.add_flag("--json", flags->json, "Print JSON instead of a table");
  return [flags] { return run(*flags); };
}

}  // namespace glidar::app
