// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "report.hpp"

namespace glidar::python {

void Watch::look() {
  if (std::this_thread::get_id() != caller_ || Clock::now() < next_) return;
  next_ = Clock::now() + kPause;
  const nb::gil_scoped_acquire acquire;
  if (PyErr_CheckSignals() != 0) throw Interrupted{};
}

void Watch::give_up(nb::python_error& error) const {
  if (std::this_thread::get_id() != caller_) return error.discard_as_unraisable("glidar");
  error.restore();
  throw Interrupted{};
}

Report report_to(const nb::object& log, Watch& watch) {
  Report report;
  report.progress = [&watch](std::string_view /*task*/, double /*fraction*/) { watch.look(); };
  if (log.is_none()) return report;
  report.log = [&log, &watch](Severity severity, std::string_view message) {
    const nb::gil_scoped_acquire acquire;
    try {
      log(severity == Severity::warning ? "warning" : "info", text_of(message));
    } catch (nb::python_error& error) {
      watch.give_up(error);
    }
  };
  return report;
}

}  // namespace glidar::python
