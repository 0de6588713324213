// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/math/constants.hpp>

#include <limits>

namespace glidar {

/// A unit of files: its name, and its size in the library's unit.
struct FieldUnit {
  const char* name = "";
  double size = 1.0;
};

inline constexpr FieldUnit kNoUnit = {};
inline constexpr FieldUnit kUnitMetre = {"m"};
inline constexpr FieldUnit kUnitMillimetre = {"mm", kMillimetre_m};
inline constexpr FieldUnit kUnitNanometre = {"nm", 1e-9};
inline constexpr FieldUnit kUnitDegree = {"degrees", kDegree};
inline constexpr FieldUnit kUnitMilliradian = {"mrad", 1e-3};
inline constexpr FieldUnit kUnitSecond = {"s"};
inline constexpr FieldUnit kUnitNanosecond = {"ns", 1e-9};  ///< of a time in seconds
inline constexpr FieldUnit kUnitMicrosecond_ns = {"us",
                                                  kMicrosecond_ns};  ///< of one in nanoseconds
inline constexpr FieldUnit kUnitHertz = {"Hz"};
inline constexpr FieldUnit kUnitPixel = {"pixels"};

/// A key of a file.
struct FieldInfo {
  const char* key;
  const char* text;  ///< one line of documentation, in Markdown
  FieldUnit unit = kNoUnit;
  bool is_required = false;
  /// Documents a default that depends on other keys; null: the value of the default struct.
  const char* default_text = nullptr;
};

inline constexpr bool kRequired = true;

/// The name that selects one alternative of a variant in files. Each alternative has it as `kType`.
struct TypeInfo {
  const char* name;
  const char* text = "";    ///< one line of documentation, in Markdown
  const char* source = "";  ///< of the model
};

/// The numbers that a key accepts, in the file's unit, and the same in words for errors.
struct NumberRule {
  double min = -std::numeric_limits<double>::max();
  double max = std::numeric_limits<double>::max();
  bool is_open = false;  ///< min and max themselves are not allowed
  const char* allowed = "a finite number";
};

inline constexpr NumberRule kFinite = {};
inline constexpr NumberRule kAboveZero = {0.0, std::numeric_limits<double>::max(), true,
                                          "a finite number above 0"};
inline constexpr NumberRule kFromZero = {0.0, std::numeric_limits<double>::max(), false,
                                         "a finite number from 0"};
inline constexpr NumberRule kZeroToOne = {0.0, 1.0, false, "a number from 0 to 1"};

/// Whether a number is finite and within the bounds.
constexpr bool accepts(const NumberRule& rule, double value) {
  if (rule.is_open) return value > rule.min && value < rule.max;
  return value >= rule.min && value <= rule.max;
}

}  // namespace glidar
