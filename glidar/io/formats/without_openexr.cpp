// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Instead of exr_encoder.cpp in builds without OpenEXR.
#include <glidar/core/error.hpp>
#include <glidar/io/formats/exr_encoder.hpp>

namespace glidar {

bool has_openexr() {
  return false;
}

std::string encode_exr(const ExrImage& /*image*/, const std::filesystem::path& path) {
  throw Error({.where = path.string(), .found = "this build does not contain OpenEXR"});
}

}  // namespace glidar
