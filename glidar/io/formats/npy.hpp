// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace glidar {

/// The head of a NumPy array file, version 1.0, in C order; the numbers follow it.
/// `type` is NumPy's, e.g. "<f4". Source: numpy.lib.format ("Format Version 1.0").
std::string npy_header(std::string_view type, std::span<const std::size_t> shape);

}  // namespace glidar
