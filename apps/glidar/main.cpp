// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/program.hpp>
#include <apps/glidar/run/exit_code.hpp>
#include <apps/glidar/run/interrupt.hpp>
#include <apps/viewer/view.hpp>
#include <glidar/io/files/atomic_file.hpp>

#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <vector>

namespace glidar::app {
namespace {

/// A subcommand that needs no arguments of the whole command line.
Subcommand subcommand(const char* name, Command (*add)(CLI::App&)) {
  return {name, [add](CLI::App& program, const std::vector<std::string>&) { return add(program); }};
}

std::vector<Subcommand> all_subcommands() {
  return {{"render", add_render},
          subcommand("view", add_view),
          {"stream", add_stream},
          subcommand("replay", add_replay),
          subcommand("decode", add_decode),
          subcommand("explain", add_explain),
          subcommand("info", add_info),
          subcommand("campaign", add_campaign),
          subcommand("sensors", add_sensors),
          subcommand("schema", add_schema),
          subcommand("filter", add_filter),
          subcommand("align", add_align),
          subcommand("stereo", add_stereo),
          subcommand("structured-light", add_structured_light),
          subcommand("tof", add_tof),
          subcommand("verify", add_verify)};
}

}  // namespace
}  // namespace glidar::app

int main(int argc, char** argv) {
  try {
    glidar::app::end_cleanly_on_interrupt();
    const int status = glidar::app::run_program(glidar::app::all_subcommands(),
                                                glidar::app::has_viewer(), argc, argv);
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
      return glidar::app::report_error("standard output could not be written; is the disk full?");
    }
    return status;
  } catch (const glidar::ClosedPipe&) {
    return glidar::app::kClosedPipe;  // no message: readers such as `| head` close the pipe on
                                      // purpose
  } catch (const std::bad_alloc&) {
    return glidar::app::report_error("out of memory; use a smaller image or a smaller model");
  } catch (const std::exception& error) {
    return glidar::app::report_error(error.what());
  }
}
