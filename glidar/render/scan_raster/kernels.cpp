// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/scan_raster/kernels.hpp>

#include <glidar/core/error.hpp>

#include <string>

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
  const Kernel* const kernels[] = {
      &rays::baseline::kScanKernel,
#ifdef __x86_64__
      &rays::avx2::kScanKernel,
      &rays::avx512::kScanKernel,
#endif
  };
  std::string names;
  for (const Kernel* kernel : kernels) {
    if (name == kernel->name) return *kernel;
    names += (names.empty() ? "" : ", ") + std::string(kernel->name);
  }
  throw Error({.where = "scanner raster",
               .found = "no kernel '" + std::string(name) + "'",
               .allowed = names,
               .remedy = ""});
}

}  // namespace scan_raster
}  // namespace glidar
