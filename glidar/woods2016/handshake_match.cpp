// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/woods2016/handshake_match.hpp>

namespace glidar::woods2016 {

void HandshakeMatch::add_handshake() {
  if (early_ > 0) {
    --early_;
    ++matched_;
  } else {
    ++pending_;
  }
}

void HandshakeMatch::set_subscribers(std::uint64_t count) {
  for (; subscribers_ < count; ++subscribers_) {
    if (pending_ > 0) {
      --pending_;
      ++matched_;
    } else if (absent_ > 0) {
      --absent_;  // a returning peer does not shake hands again
    } else {
      ++early_;
    }
  }
  // It is unknown which one left. It is assumed to be one without a handshake, which may cause an
  // unnecessary wait.
  for (; subscribers_ > count; --subscribers_) {
    if (early_ > 0) {
      --early_;
    } else {
      ++absent_;
    }
  }
}

void HandshakeMatch::stop_waiting() {
  absent_ += pending_;
  pending_ = 0;
}

}  // namespace glidar::woods2016
