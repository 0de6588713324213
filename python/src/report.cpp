// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause

#include <glidar/core/error.hpp>
#include <glidar/core/text.hpp>

#include "report.hpp"

#include <nanobind/stl/string.h>

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

namespace {

/// Raises glidar.Error with the four parts.
void raise(const std::exception_ptr& thrown, void* /*payload*/) {
  try {
    std::rethrow_exception(thrown);
  } catch (const Error& error) {
    const ErrorParts& parts = error.parts();
    const nb::object type = nb::module_::import_("glidar._errors").attr("Error");
    const nb::object made = type(text_of(parts.where), text_of(parts.found), text_of(parts.allowed),
                                 text_of(parts.remedy));
    PyErr_SetObject(type.ptr(), made.ptr());
  }
}

std::string error_text(const std::string& where, const std::string& found,
                       const std::string& allowed, const std::string& remedy) {
  return Error({.where = where, .found = found, .allowed = allowed, .remedy = remedy}).what();
}

}  // namespace

void bind_errors(nb::module_& module) {
  nb::register_exception_translator(raise);
  module.def("error_text", error_text, nb::arg("where"), nb::arg("found"), nb::arg("allowed"),
             nb::arg("remedy"), "The sentence that an error reads.");
  module.def(
      "excerpt",
      [](const std::string& text, std::size_t max_bytes) { return excerpt(text, max_bytes); },
      nb::arg("text"), nb::arg("max_bytes"), "A printable line of at most `max_bytes`.");
  module.def(
      "printable_line", [](const std::string& text) { return printable_line(text); },
      nb::arg("text"), "The text without characters that control a terminal.");
}

}  // namespace glidar::python
