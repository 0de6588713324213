// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/options/render_options.hpp>

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <optional>

namespace glidar::app {

/// Throws Error when --fisher is given without an output file beside which its file is written.
void check_fisher(const RenderFlags& flags);

/// NAME.fisher.json beside an output NAME.SUFFIX. If NAME.SUFFIX holds a whole sequence,
/// each frame has a file NAME_NNNNNN.fisher.json, as the frames of other formats have.
std::filesystem::path fisher_path(const std::filesystem::path& output,
                                  std::optional<std::uint32_t> frame = {});

/// Writes the file beside an output and prints the table to `to` unless it is
/// nullptr. `number` is that of a frame of a sequence.
void write_fisher(const FisherFlags& flags, const Frame& frame, const Beams& beams,
                  const std::filesystem::path& output, std::optional<std::uint32_t> number,
                  std::FILE* to);

}  // namespace glidar::app
