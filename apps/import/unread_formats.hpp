// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <import/source_model.hpp>

#include <optional>
#include <string_view>

namespace glidar::import {

/// The error for a file of a format that GLIDAR does not read, known by its first bytes or, if the
/// format has no mark, by its lower-case extension: its name and what to do. Nothing for others.
std::optional<Refusal> unread_format(std::string_view extension, std::string_view first_bytes);

}  // namespace glidar::import
