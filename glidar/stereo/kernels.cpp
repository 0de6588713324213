// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/stereo/kernels.hpp>

namespace glidar::stereo {

namespace baseline {
extern const Kernel kKernel;
}
#ifdef __x86_64__
namespace avx2 {
extern const Kernel kKernel;
}
namespace avx512 {
extern const Kernel kKernel;
}
#endif

const Kernel& kernel_for(InstructionSet set) {
#ifdef __x86_64__
  if (set == InstructionSet::avx512) return avx512::kKernel;
  if (set == InstructionSet::avx2) return avx2::kKernel;
#endif
  (void)set;  // elsewhere there is one
  return baseline::kKernel;
}

}  // namespace glidar::stereo
