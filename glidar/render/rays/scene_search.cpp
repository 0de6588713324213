// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/rays/scene_search.hpp>

namespace glidar::rays {

void SceneSearch::prepare(const CastRequest& request) {
  trees_.place(request, resolver_, thread_pool_);
  beams_.emplace(CastView{trees_, resolver_, request}, kernel_);
}

}  // namespace glidar::rays
