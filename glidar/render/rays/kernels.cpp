// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/rays/kernels.hpp>

#include <glidar/core/error.hpp>

#include <cstdlib>
#include <string>

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

std::vector<const Kernel*> usable_kernels() {
  std::vector<const Kernel*> usable = {&baseline::kKernel};
#ifdef __x86_64__
  const bool has_avx2 = __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0 &&
                        __builtin_cpu_supports("bmi") != 0 && __builtin_cpu_supports("bmi2") != 0;
  if (has_avx2) usable.push_back(&avx2::kKernel);
  const bool has_avx512 =
      __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512vl") != 0 &&
      __builtin_cpu_supports("avx512dq") != 0 && __builtin_cpu_supports("avx512bw") != 0;
  if (has_avx2 && has_avx512) usable.push_back(&avx512::kKernel);
#endif
  return usable;
}

const Kernel& find_kernel(std::string_view name) {
  const std::vector<const Kernel*> usable = usable_kernels();
  if (name.empty()) return *usable.back();
  std::string names;
  for (const Kernel* kernel : usable) {
    if (name == kernel->name) return *kernel;
    names += (names.empty() ? "" : ", ") + std::string(kernel->name);
  }
  throw Error({"environment variable GLIDAR_ISA",
               "this processor has no kernel '" + std::string(name) + "'", names,
               "unset the variable; results do not depend on it"});
}

const Kernel& select_kernel() {
  const char* name = std::getenv("GLIDAR_ISA");
  return find_kernel(name == nullptr ? "" : name);
}

}  // namespace glidar::rays
