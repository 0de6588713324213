// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io: the keys of a sensor file that describe a family of sensors. `variants` are
// sensors of their own, `modes` settings of one sensor. Both are maps of overrides, which are
// merged over the rest of the document: first the variant, then the mode.

#include <glidar/io/config/sensor_file.hpp>
#include <glidar/io/config/yaml_reader.hpp>

#include <string>
#include <vector>

namespace glidar {

/// One sensor of a file.
struct FamilyMember {
  YamlField document;   ///< with the overrides, without the keys of the family
  std::string variant;  ///< empty: the file has no variants
  std::string mode;     ///< empty: the sensor has no modes, or none was chosen and none is default
  std::vector<std::string> aliases;
  std::vector<std::string> modes;  ///< in the order of the file
  std::string default_mode;        ///< empty: none
};

/// The names of the variants of a file, in its order; empty: the file is one sensor.
std::vector<std::string> variants_of(const YamlField& root);

/// The sensor of a file by its variant and mode; the mode is the default one if empty. Throws Error
/// listing the names that exist: a variant is missing or unknown, or the mode is unknown.
FamilyMember select_sensor(const YamlField& root, const std::string& variant,
                           const std::string& mode);

/// Runs `read` and adds the variant and mode to the place of its errors.
template <class Read>
auto with_member_name(const FamilyMember& member, const Read& read) -> decltype(read()) {
  if (member.variant.empty() && member.mode.empty()) return read();
  try {
    return read();
  } catch (const Error& error) {
    ErrorParts parts = error.parts();
    const std::string variant = member.variant.empty() ? "" : "variant " + member.variant;
    const std::string mode = member.mode.empty() ? "" : "mode " + member.mode;
    parts.where += " (" + variant + (variant.empty() || mode.empty() ? "" : ", ") + mode + ")";
    throw Error(parts);
  }
}

}  // namespace glidar
