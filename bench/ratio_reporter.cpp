// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "ratio_reporter.hpp"

#include <algorithm>
#include <cstdio>

namespace glidar::bench {
namespace {

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Google Benchmark 1.8 replaced the flag of a failed run by an enumeration.
template <class Run>
bool has_failed(const Run& run) {
  if constexpr (requires { run.error_occurred; }) {
    return run.error_occurred;
  } else {
    return run.skipped != decltype(run.skipped){};
  }
}

}  // namespace

void RatioReporter::ReportRuns(const std::vector<Run>& runs) {
  for (const Run& run : runs) {
    if (run.run_type != Run::RT_Iteration || has_failed(run)) continue;
    seconds_[run.run_name.function_name].push_back(run.real_accumulated_time /
                                                   static_cast<double>(run.iterations));
  }
  std::vector<Run> aggregates;
  std::copy_if(runs.begin(), runs.end(), std::back_inserter(aggregates),
               [](const Run& run) { return run.run_type == Run::RT_Aggregate; });
  if (!aggregates.empty()) ConsoleReporter::ReportRuns(aggregates);
}

void RatioReporter::Finalize() {
  std::printf("\n%-58s %8s %8s\n", "ratio of medians", "found", "goal");
  for (const Ratio& ratio : ratios_) {
    if (seconds_.count(ratio.baseline) == 0 || seconds_.count(ratio.ours) == 0) continue;
    const double found = median(seconds_.at(ratio.baseline)) / median(seconds_.at(ratio.ours));
    std::printf("%-58s %8.3f %8.2f %s\n", ratio.what.c_str(), found, ratio.goal,
                found >= ratio.goal ? "" : "  below");
  }
}

void print_at_most(const std::string& what, double found, double goal) {
  std::printf("%-58s %8.3f %8.2f at most %s\n", what.c_str(), found, goal,
              found <= goal ? "" : "  above");
}

int run(int argc, char** argv, std::vector<Ratio> ratios) {
  std::vector<char*> arguments(argv, argv + argc);
  std::string interleaved = "--benchmark_enable_random_interleaving=true";
  std::string repetitions = "--benchmark_repetitions=15";
  std::string shortened = "--benchmark_min_time=0.05";
  arguments.insert(arguments.begin() + 1,
                   {interleaved.data(), repetitions.data(), shortened.data()});
  int count = static_cast<int>(arguments.size());
  benchmark::Initialize(&count, arguments.data());
  if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) return 2;
  RatioReporter reporter(std::move(ratios));
  benchmark::RunSpecifiedBenchmarks(&reporter);
  return 0;
}

}  // namespace glidar::bench
