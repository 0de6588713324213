// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <benchmark/benchmark.h>

#include <map>
#include <string>
#include <vector>

namespace glidar::bench {

/// A goal for two benchmarks of one run: median time of `baseline` over that of `ours`.
struct Ratio {
  std::string what;
  std::string baseline;
  std::string ours;
  double goal;  ///< minimum
};

/// Google Benchmark's console output, and after it the ratios with their goals.
class RatioReporter : public benchmark::ConsoleReporter {
 public:
  explicit RatioReporter(std::vector<Ratio> ratios) : ratios_(std::move(ratios)) {}
  void ReportRuns(const std::vector<Run>& runs) override;
  void Finalize() override;

 private:
  std::vector<Ratio> ratios_;
  std::map<std::string, std::vector<double>> seconds_;  ///< per benchmark, one per repetition
};

/// The line of a ratio that must not be above its goal.
void print_at_most(const std::string& what, double found, double goal);

/// Runs all registered benchmarks, with interleaved repetitions, and prints the ratios.
int run(int argc, char** argv, std::vector<Ratio> ratios);

}  // namespace glidar::bench
