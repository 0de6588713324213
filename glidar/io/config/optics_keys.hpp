// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io: optics as sensor files name them.

#include <glidar/sensor/sensor.hpp>

#include <string>
#include <utility>
#include <variant>

namespace glidar {

/// Rays from a file.
struct RayTableKeys {
  static constexpr TypeInfo kType = RayTable::kType;
  std::string file;
  RayTable table;            ///< once read
  bool has_times = false;    ///< for reports, which have no table
  bool has_origins = false;  ///< the same for origins
};

/// A spinning sensor from the metadata that Ouster sensors provide.
struct OusterKeys {
  static constexpr TypeInfo kType = {"ouster", "an Ouster LiDAR, from its metadata file"};
  std::string file;
  Spinning spinning;
};

/// The form of an alternative of Optics in files.
template <class Struct>
struct FileForm {
  using type = Struct;
};
template <>
struct FileForm<RayTable> {
  using type = RayTableKeys;
};
template <class... Types>
std::variant<typename FileForm<Types>::type..., OusterKeys> file_form(std::variant<Types...>);

using OpticsKeys = decltype(file_form(std::declval<Optics>()));

/// The keys of optics, of a table only its size.
OpticsKeys optics_keys(const Optics& optics);

Optics optics_of(OpticsKeys keys);

/// The file that the optics were read from; empty: none.
std::string file_of(const OpticsKeys& keys);

void describe(OpticsKeys& keys, FieldVisitor& visitor);
void describe(RayTableKeys& keys, FieldVisitor& visitor);
void describe(OusterKeys& keys, FieldVisitor& visitor);

}  // namespace glidar
