// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace glidar::testing {

/// Decodes raw time-of-flight images: ten bytes select the size and the options, floats follow.
/// Every result must keep the promises of decode_tof() and explain_tof().
void read_raw_tof_images(const std::filesystem::path& file);

/// Matches a stereo pair: ten bytes select the size and the options, grey levels of both images
/// follow. The result must be the same with the instructions that every processor has.
void read_raw_stereo_pair(const std::filesystem::path& file);

}  // namespace glidar::testing
