// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/field_visitor.hpp>

namespace glidar {

void FieldVisitor::reject(const char* key, const std::string& found, const std::string& allowed,
                          const std::string& remedy) const {
  throw error_at({.where = key, .found = found, .allowed = allowed, .remedy = remedy});
}

Error FieldVisitor::error_at(const ErrorParts& parts) const {
  return Error(parts);
}

}  // namespace glidar
