// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/grey_image.hpp>

#include <filesystem>

namespace glidar {

/// A PNG of 8 or 16 bits: grey, or colours with equal channels, of which an alpha channel is
/// ignored. Throws Error when it cannot be read, is no PNG, is damaged, has colours, or more than
/// 2^26 pixels.
GreyImage load_grey_image(const std::filesystem::path& path);

}  // namespace glidar
