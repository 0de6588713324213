// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/options/cli_fwd.hpp>
#include <apps/glidar/options/output_options.hpp>

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <optional>

namespace glidar::app {

/// Whether to tell what a scan says about the sensor's pose, as given.
struct InformationFlags {
  bool wanted = false;
  std::optional<double> sigma_m = {};  ///< of ranges when the sensor has no noise of its own
};

void add_information_flags(CLI::App& command, InformationFlags& flags);

/// Throws Error when a flag is out of range or given without the other, or there is no file among
/// the outputs.
void check(const InformationFlags& flags, const OutputFlags& outputs);

/// NAME.information.json beside an output NAME.SUFFIX. Of a sequence in one folder NAME.SUFFIX each
/// frame has a file, NAME_NNNNNN.information.json, as the frames of other formats have.
std::filesystem::path information_path(const std::filesystem::path& output,
                                       std::optional<std::uint32_t> frame = {});

/// If wanted: writes the file beside the first output and prints the table to `to`; nullptr: not.
/// `number` is that of a frame of a sequence.
void tell_information(const InformationFlags& flags, const Frame& frame, const Beams& beams,
                      const std::vector<Output>& outputs, std::optional<std::uint32_t> number,
                      std::FILE* to);

}  // namespace glidar::app
