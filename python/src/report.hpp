// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bind.hpp"

#include <glidar/core/report.hpp>

#include <chrono>
#include <thread>

namespace glidar::python {

/// Text from files need not be UTF-8; invalid bytes are escaped as \xE9.
inline nb::object text_of(std::string_view bytes) {
  const auto size = static_cast<Py_ssize_t>(bytes.size());
  return nb::steal(PyUnicode_DecodeUTF8(bytes.data(), size, "backslashreplace"));
}

/// Thrown through GLIDAR when Python was interrupted; Python's error is set.
struct Interrupted {};

/// Checks periodically for Ctrl-C while GLIDAR runs without Python's lock.
/// Progress may be reported by any thread; only the calling thread runs Python's handlers.
class Watch {
 public:
  Watch() : caller_(std::this_thread::get_id()), next_(Clock::now() + kPause) {}

  /// Throws Interrupted when a handler raised an error.
  void look();
  /// Ends the computation with this error if it can be raised; otherwise Python only prints it.
  void give_up(nb::python_error& error) const;
  ProgressCallback progress() {
    return [this](double /*fraction*/) { look(); };
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds kPause{50};
  std::thread::id caller_;
  Clock::time_point next_;
};

/// Calls `work` without Python's lock; Ctrl-C stops it with KeyboardInterrupt.
template <class Work>
auto unlocked(const Work& work) {
  Watch watch;
  try {
    const nb::gil_scoped_release release;
    return work(watch);
  } catch (const Interrupted&) {
    throw nb::python_error();  // uses the error that is set
  }
}

/// Calls Python's function log(severity, message), which may be None.
Report report_to(const nb::object& log, Watch& watch);

}  // namespace glidar::python
