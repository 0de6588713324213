// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <thread>

/// Waiting for conditions; the only place in the C++ tests that sleeps.
namespace glidar::testing {

/// Long, because machines may be very busy; a passing test never waits this long. Half of CTest's
/// limit for a test program, so that the message of a wait appears before it.
constexpr std::chrono::minutes kMaxWait{5};

/// Repeats an action until it returns true; false when that takes longer than kMaxWait.
template <class Action>
bool soon(const Action& action) {
  constexpr std::chrono::milliseconds kPause{2};
  const auto end = std::chrono::steady_clock::now() + kMaxWait;
  while (!action()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(kPause);
  }
  return true;
}

}  // namespace glidar::testing
