// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/formats/format.hpp>

namespace glidar {

// Pictures of a cloud: from above, and in perspective.
Format bird_eye_format();
Format perspective_format();

}  // namespace glidar
