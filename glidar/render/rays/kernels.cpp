// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/rays/kernels.hpp>

#include <glidar/core/instruction_set.hpp>

namespace glidar::rays {

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

namespace {

const Kernel& kernel_for(InstructionSet set) {
#ifdef __x86_64__
  if (set == InstructionSet::avx512) return avx512::kKernel;
  if (set == InstructionSet::avx2) return avx2::kKernel;
#endif
  (void)set;  // elsewhere there is one
  return baseline::kKernel;
}

}  // namespace

std::vector<const Kernel*> usable_kernels() {
  std::vector<const Kernel*> usable;
  for (const InstructionSet set : usable_instruction_sets()) usable.push_back(&kernel_for(set));
  return usable;
}

const Kernel& find_kernel(std::string_view name) {
  return kernel_for(find_instruction_set(name));
}

const Kernel& select_kernel() {
  return kernel_for(select_instruction_set());
}

}  // namespace glidar::rays
