// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace glidar {

/// "major.minor.patch".
const char* version();

}  // namespace glidar
