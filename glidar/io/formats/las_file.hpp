// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/formats/format.hpp>

namespace glidar {

/// LAS 1.4 (ASPRS, LAS Specification 1.4 R15) with point record format 6. Points without a return
/// are omitted, as the format has no coordinates for them.
Format las_format();

}  // namespace glidar
