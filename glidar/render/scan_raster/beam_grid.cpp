// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/scan_raster/beam_grid.hpp>

#include <atomic>
#include <cstring>

namespace glidar::scan_raster {
namespace {

template <class T>
bool are_same_bytes(const std::vector<T>& a, const std::vector<T>& b, ThreadPool& thread_pool) {
  if (a.size() != b.size()) return false;
  constexpr std::size_t kRowGrain = 4096;
  std::atomic<bool> same = true;
  thread_pool.parallel_for(a.size(), kRowGrain, [&](std::size_t begin, std::size_t end) {
    if (std::memcmp(a[begin].data(), b[begin].data(), (end - begin) * sizeof(T)) != 0) same = false;
  });
  return same;
}

}  // namespace

bool may_form_grid(const Beams& beams) {
  return looks_along_z(beams) ? may_form_image(beams) : may_form_scan(beams);
}

bool BeamGrid::has_measured(const Beams& beams, ThreadPool& thread_pool) const {
  return beams.rows == measured_.rows && beams.cols == measured_.cols &&
         beams.returns == measured_.returns && looks_along_z(beams) == looks_along_z(measured_) &&
         are_same_bytes(beams.directions, measured_.directions, thread_pool) &&
         are_same_bytes(beams.origins_m, measured_.origins_m, thread_pool);
}

void BeamGrid::measure(const Beams& beams, ThreadPool& thread_pool) {
  measured_.rows = beams.rows;
  measured_.cols = beams.cols;
  measured_.returns = beams.returns;
  measured_.boresight = beams.boresight;
  measured_.directions = beams.directions;
  measured_.origins_m = beams.origins_m;
  if (is_camera()) {
    camera_.measure(beams, thread_pool);
  } else {
    scanner_.measure(beams, thread_pool);
  }
}

}  // namespace glidar::scan_raster
