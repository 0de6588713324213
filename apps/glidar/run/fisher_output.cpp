// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/fisher_output.hpp>

#include <apps/glidar/run/console.hpp>
#include <glidar/core/error.hpp>
#include <glidar/io/formats/fisher_information_file.hpp>

#include <fmt/format.h>

namespace glidar::app {

void check_fisher(const RenderFlags& flags) {
  const bool has_file = !writes_standard_output(flags.output) || flags.output.paths.size() > 1;
  if (!flags.fisher.is_requested || has_file) return;
  throw Error({"--fisher", "there is no output file beside which its file would be",
               "an output file", "add one, such as -o scan.pcd"});
}

std::filesystem::path fisher_path(const std::filesystem::path& output,
                                  std::optional<std::uint32_t> frame) {
  const std::string name = output.string();
  const OutputKind kind = output_kind(output);
  const bool is_recording = kind == OutputKind::bag || kind == OutputKind::capture;
  const std::string suffix = is_recording ? output.extension().string() : format_for(output).suffix;
  // the names of files of one frame have the number
  const bool is_numbered = frame && (is_recording || format_for(output).is_folder);
  return name.substr(0, name.size() - suffix.size()) +
         (is_numbered ? fmt::format("_{:06}", *frame) : "") + ".fisher.json";
}

void write_fisher(const FisherFlags& flags, const Frame& frame, const Beams& beams,
                  const std::filesystem::path& output, std::optional<std::uint32_t> number,
                  std::FILE* to) {
  FisherOptions options;
  options.sigma_m = flags.sigma_m.value_or(options.sigma_m);
  const FisherInformation information = pose_information(frame, beams, options);
  const std::filesystem::path path = fisher_path(output, number);
  write_information(information, path);
  if (to == nullptr) return;
  print_lines(to, information_text(information));
  print(to, "wrote {}\n", path.string());
}

}  // namespace glidar::app
