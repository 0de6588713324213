// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/verify/verify.hpp>

#include <string_view>

namespace glidar {

/// Why, and by how much, a renderer is known to fail a row's case; no reason: it has to pass.
KnownFailure known_failure(const AccuracyCase& row);

}  // namespace glidar
