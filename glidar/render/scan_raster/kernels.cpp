// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/scan_raster/kernels.hpp>

namespace glidar {

namespace rays::baseline {
extern const scan_raster::Kernel kScanKernel;
}
#ifdef __x86_64__
namespace rays::avx2 {
extern const scan_raster::Kernel kScanKernel;
}
namespace rays::avx512 {
extern const scan_raster::Kernel kScanKernel;
}
#endif

namespace scan_raster {

const Kernel& find_kernel(std::string_view name) {
#ifdef __x86_64__
  for (const Kernel* kernel : {&rays::avx2::kScanKernel, &rays::avx512::kScanKernel}) {
    if (name == kernel->name) return *kernel;
  }
#endif
  static_cast<void>(name);
  return rays::baseline::kScanKernel;
}

}  // namespace scan_raster
}  // namespace glidar
