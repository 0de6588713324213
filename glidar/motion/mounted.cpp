// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/motion/mounted.hpp>

namespace glidar {

Pose pose_at(const Mounted& mounted, std::int64_t t_ns) {
  const auto at = [t_ns](const auto& carrier) { return carrier.pose_at(t_ns); };
  return std::visit(at, mounted.carrier) * mounted.carrier_from_body;
}

}  // namespace glidar
