// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/tof/number_checks.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/field_visitor.hpp>

namespace glidar::tof {

void require_numbers(const std::string& place, std::initializer_list<CheckedNumber> numbers) {
  for (const auto& [key, rule, value] : numbers) {
    if (!accepts(rule, value)) {
      throw Error({place + key, "is " + number_text(value), rule.allowed, ""});
    }
  }
}

}  // namespace glidar::tof
