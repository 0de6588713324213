// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/tof: checks of numbers that do not come from files.

#include <glidar/core/field.hpp>

#include <initializer_list>
#include <string>

namespace glidar::tof {

/// A number with the rule that it must follow.
struct CheckedNumber {
  const char* key;
  const NumberRule& rule;
  double value;
};

/// Throws Error naming `place` and the key of the first number that its rule does not accept.
void require_numbers(const std::string& place, std::initializer_list<CheckedNumber> numbers);

}  // namespace glidar::tof
