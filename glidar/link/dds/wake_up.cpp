// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/dds/wake_up.hpp>

#include <glidar/core/error.hpp>

#include <sys/eventfd.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace glidar::dds {

WakeUp::WakeUp() : descriptor_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (descriptor_ >= 0) return;
  throw Error({.where = "eventfd",
               .found = std::strerror(errno),
               .remedy = "close files, or raise the limit of open files (ulimit -n)"});
}

WakeUp::~WakeUp() {
  close(descriptor_);
}

void WakeUp::signal() const {
  eventfd_write(descriptor_, 1);
}

bool WakeUp::clear() const {
  eventfd_t count = 0;
  return eventfd_read(descriptor_, &count) == 0;
}

}  // namespace glidar::dds
