// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/options/information_options.hpp>

#include <apps/glidar/options/numbers.hpp>
#include <apps/glidar/options/option_kinds.hpp>
#include <glidar/core/error.hpp>
#include <glidar/io/formats/fisher_information_file.hpp>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <cmath>

namespace glidar::app {

void add_information_flags(CLI::App& command, InformationFlags& flags) {
  const std::string group = "Pose information";
  command
      .add_flag("--fisher", flags.wanted,
                "Bounds of the sensor's pose; also to NAME.information.json")
      ->group(group);
  add_number(
      command,
      {"--range-sigma", "M", "Its sigma of ranges if the sensor has no noise, m [0.01]", group},
      flags.sigma_m);
}

void check(const InformationFlags& flags, const OutputFlags& outputs) {
  if (flags.wanted && writes_standard_output(outputs) && outputs.paths.size() == 1) {
    throw Error({"--fisher", "there is no output file beside which its file would be",
                 "an output file", "add one, such as -o scan.pcd"});
  }
  if (!flags.sigma_m) return;
  require(std::isfinite(*flags.sigma_m) && *flags.sigma_m > 0.0, "--range-sigma", *flags.sigma_m,
          "a finite number above 0");
  if (flags.wanted) return;
  throw Error({"--range-sigma", "there is no --fisher", "", "give --fisher too"});
}

std::filesystem::path information_path(const std::filesystem::path& output,
                                       std::optional<std::uint32_t> frame) {
  const std::string name = output.string();
  const FileFormat& format = format_for(output);
  const bool is_numbered = frame && format.is_folder;  // the names of other formats have the number
  return name.substr(0, name.size() - format.suffix.size()) +
         (is_numbered ? fmt::format("_{:06}", *frame) : "") + ".information.json";
}

void tell_information(const InformationFlags& flags, const Frame& frame, const Beams& beams,
                      const std::vector<Output>& outputs, std::optional<std::uint32_t> number,
                      std::FILE* to) {
  if (!flags.wanted) return;
  FisherOptions options;
  options.sigma_m = flags.sigma_m.value_or(options.sigma_m);
  const FisherInformation information = pose_information(frame, beams, options);
  const std::filesystem::path path = information_path(outputs.front().path, number);
  write_information(information, path);
  if (to != nullptr) fmt::print(to, "{}wrote {}\n", information_text(information), path.string());
}

}  // namespace glidar::app
