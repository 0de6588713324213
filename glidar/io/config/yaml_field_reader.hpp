// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io.

#include <glidar/core/field_visitor.hpp>
#include <glidar/io/config/yaml_reader.hpp>

namespace glidar {

/// Sets what a map has of the keys that `describe` names. Throws Error with the place in the file:
/// unknown and missing keys, wrong types, numbers out of range.
void read_fields(const YamlField& map, FieldVisitor::Describe describe);

/// Reads a struct with a function describe(struct, visitor).
template <class Struct>
void read_struct(const YamlField& map, Struct& value) {
  const auto body = [&](FieldVisitor& visitor) { describe(value, visitor); };
  read_fields(map, FieldVisitor::Describe(body));
}

}  // namespace glidar
