// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/commands/commands.hpp>
#include <apps/glidar/run/console.hpp>
#include <apps/glidar/run/program_search.hpp>
#include <glidar/core/error.hpp>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

namespace glidar::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kName = "glidar-campaign";
constexpr const char* kRemedy =
    "install GLIDAR's Python package: pip install '.[campaign]' in its source";

constexpr const char* kHelp = R"(Commands ('glidar campaign COMMAND --help' lists the options):
  run CAMPAIGN.yaml -o DIR   measure all trials, or resume an earlier run
  merge DIR... [-o DIR]      merge the parts of a campaign, from one machine or many
  report DIR                 write DIR/report.html: distributions, coverage, views, failures, speed
  check DIR                  compare every file with the hashes in DIR/manifest.json

Examples:
  glidar campaign run views.yaml -o views
  glidar campaign run views.yaml -o part0 --shard 0/2
  glidar campaign merge part0 part1 -o views
  glidar campaign run views.yaml -o views --no-durable   # does not sync files to the disk
  glidar campaign run views.yaml -o views --executor slurm --tasks 16
  glidar campaign report views

They run the program glidar-campaign of GLIDAR's Python package, beside this program or in PATH,
else 'python3 -P -m glidar.campaign'. Only absolute folders of PATH and PYTHONPATH are used, so that
nothing in the current folder is run. docs/campaigns.md describes campaign files.
Exit codes: 0 done, 1 done but trials failed or files differ, 2 bad input, 130 interrupted.)";

/// Runs the module if it is installed, else prints the same error as this program.
constexpr const char* kPythonCode = R"(import importlib.util, runpy, sys
try:
    found = importlib.util.find_spec('glidar.campaign')
except ModuleNotFoundError:
    found = None
if found is None:
    sys.stderr.write('glidar: error: ' + sys.argv[1] + '\n')
    sys.exit(2)
del sys.argv[1]
runpy.run_module('glidar.campaign', run_name='__main__', alter_sys=True))";

Error missing() {
  return Error(
      {.where = std::string("program ") + kName,
       .found = "it is neither beside glidar nor in PATH, and python3 has no glidar.campaign",
       .remedy = kRemedy});
}

fs::path beside_this_program() {
  std::error_code error;
  const fs::path self = fs::read_symlink("/proc/self/exe", error);
  const fs::path program = self.parent_path() / kName;
  return !error && ::access(program.c_str(), X_OK) == 0 ? program : fs::path();
}

/// Replaces this process by another program; returns only when it cannot be run.
void become(const fs::path& program, std::vector<std::string> arguments) {
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  ::execv(program.c_str(), pointers.data());
}

/// Keeps only absolute folders in PATH and PYTHONPATH, for the program and its children: an empty
/// entry means the current folder, which may contain untrusted files.
void keep_absolute_folders() {
  for (const char* name : {"PATH", "PYTHONPATH"}) {
    const char* const value = std::getenv(name);
    if (value == nullptr) continue;
    const std::string kept = joined_folders(absolute_folders(value));
    if (kept.empty()) ::unsetenv(name);
    if (!kept.empty()) ::setenv(name, kept.c_str(), 1);
  }
  ::setenv("PYTHONSAFEPATH", "1", 1);  // as -P, for glidar-campaign and its workers too
}

std::vector<std::string> concatenated(std::vector<std::string> first,
                                      const std::vector<std::string>& rest) {
  first.insert(first.end(), rest.begin(), rest.end());
  return first;
}

int run_campaign(const std::vector<std::string>& arguments) {
  std::fflush(nullptr);
  const std::vector<fs::path> folders = program_folders();
  keep_absolute_folders();
  if (const fs::path program = beside_this_program(); !program.empty()) {
    become(program, concatenated({program.string()}, arguments));
  }
  for (const fs::path& program : find_programs(kName, folders)) {
    become(program, concatenated({program.string()}, arguments));
  }
  for (const fs::path& python : find_programs("python3", folders)) {
    become(python, concatenated({"python3", "-P", "-c", kPythonCode, missing().what()}, arguments));
  }
  throw missing();
}

}  // namespace

Command add_campaign(CLI::App& program) {
  CLI::App& command = *program.add_subcommand(
      "campaign", "Measure many random trials into a data set (Monte Carlo)");
  command.prefix_command();  // the other program parses the following arguments
  command.footer(kHelp);
  return [&command] {
    const std::vector<std::string> arguments = command.remaining();
    if (arguments.empty()) {
      throw Error({.where = "glidar campaign",
                   .found = "no command",
                   .allowed = "run, merge, report, check",
                   .remedy = "see glidar campaign --help"});
    }
    return run_campaign(arguments);
  };
}

}  // namespace glidar::app
