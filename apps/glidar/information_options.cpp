// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/information_options.hpp>

#include <apps/glidar/help_text.hpp>
#include <apps/glidar/numbers.hpp>
#include <glidar/core/error.hpp>
#include <glidar/io/information_file.hpp>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

namespace glidar::app {

void add_information_flags(CLI::App& command, InformationFlags& flags) {
  const std::string group = "Output";
  command
      .add_flag(
          "--information", flags.wanted,
          wrapped("Tell what the scan says about the sensor's pose: least standard deviations "
                  "and degenerate directions; also as NAME.information.json beside the first "
                  "output"))
      ->group(group);
  command
      .add_option("--information-sigma", flags.sigma_m,
                  wrapped("Standard deviation of ranges for that, m, of a sensor without noise of "
                          "its own [0.01]"))
      ->type_name("M")
      ->group(group);
}

void check(const InformationFlags& flags) {
  if (!flags.sigma_m) return;
  require_positive("--information-sigma", *flags.sigma_m);
  if (flags.wanted) return;
  throw Error({"--information-sigma", "there is no --information", "", "give --information too"});
}

std::filesystem::path information_path(const std::filesystem::path& output) {
  const std::string name = output.string();
  return name.substr(0, name.size() - format_for(output).suffix.size()) + ".information.json";
}

void tell_information(const InformationFlags& flags, const Frame& frame, const Beams& beams,
                      const std::vector<Output>& outputs, bool quiet) {
  if (!flags.wanted) return;
  InformationOptions options;
  options.sigma_m = flags.sigma_m.value_or(options.sigma_m);
  const PoseInformation information = pose_information(frame, beams, options);
  const std::filesystem::path path = information_path(outputs.front().path);
  write_information(information, path);
  if (!quiet) fmt::print("{}wrote {}\n", information_text(information), path.string());
}

}  // namespace glidar::app
