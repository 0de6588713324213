// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/verify/verify.hpp>

namespace glidar {

/// The known failure of a renderer in a row's case; without a reason, the row must pass.
KnownFailure known_failure(const AccuracyCase& row);

}  // namespace glidar
