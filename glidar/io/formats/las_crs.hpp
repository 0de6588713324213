// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace glidar {

/// A coordinate reference system in well-known text (OGC 01-009, which LAS 1.4 requires), from
/// "EPSG:CODE", from such text, or from the name of a file that contains it. The codes are those of
/// UTM zones of WGS 84, ETRS89 and NAD83; their parameters are from the EPSG registry. Throws Error
/// for another code, for text of another kind or with another unit than metres, and for a file that
/// cannot be read.
std::string crs_text(const std::string& crs);

}  // namespace glidar
