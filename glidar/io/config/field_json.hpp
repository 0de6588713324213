// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io.

#include <glidar/core/field_visitor.hpp>

#include <nlohmann/json.hpp>

namespace glidar {

/// The keys that `describe` names, with their values, in that order. Mode::report: as sidecar files
/// have them, with null for what is absent. Mode::document: so that a reader gets the same bits;
/// leaves out what no file can spell (infinity, 0 that means "unset", an empty list),
/// because only a default is. Throws Error where no number in the file's unit gives those bits.
nlohmann::ordered_json write_fields(FieldVisitor::Mode mode, FieldVisitor::Describe describe);

/// A struct with a function describe(struct, visitor).
template <class Struct>
nlohmann::ordered_json write_struct(FieldVisitor::Mode mode, const Struct& value) {
  Struct copy = value;
  const auto body = [&](FieldVisitor& visitor) { describe(copy, visitor); };
  return write_fields(mode, FieldVisitor::Describe(body));
}

}  // namespace glidar
