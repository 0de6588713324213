// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/block_kernels.hpp>

#include <glidar/render/rays/kernels.hpp>

#include <string_view>

namespace glidar {

namespace rays::baseline {
extern const BlockKernel kBlockKernel;
}
#ifdef __x86_64__
namespace rays::avx2 {
extern const BlockKernel kBlockKernel;
}
namespace rays::avx512 {
extern const BlockKernel kBlockKernel;
}
#endif

const BlockKernel& select_block_kernel() {
#ifdef __x86_64__
  const std::string_view name = rays::select_kernel().name;
  if (name == rays::avx512::kBlockKernel.name) return rays::avx512::kBlockKernel;
  if (name == rays::avx2::kBlockKernel.name) return rays::avx2::kBlockKernel;
#endif
  return rays::baseline::kBlockKernel;
}

}  // namespace glidar
