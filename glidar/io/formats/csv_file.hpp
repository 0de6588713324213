// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/formats/format.hpp>

namespace glidar {

/// Text tables: a line of field names, then a line per point.
Format csv_format();

}  // namespace glidar
