// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/formats/format.hpp>

namespace glidar {

/// Files of the Point Cloud Library.
Format pcd_format();

}  // namespace glidar
