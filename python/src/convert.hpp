// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bind.hpp"

#include <glidar/core/pose.hpp>

#include <nanobind/ndarray.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace glidar::python {

using Matrix4 = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;
using PoseArray = nb::ndarray<const double, nb::shape<-1, 4, 4>, nb::c_contig, nb::device::cpu>;
template <class T>
using Numbers = nb::ndarray<const T, nb::shape<-1>, nb::c_contig, nb::device::cpu>;
template <class T, int kColumns>
using Table = nb::ndarray<const T, nb::shape<-1, kColumns>, nb::c_contig, nb::device::cpu>;

/// Pose k of an array. A pose that is rigid within float32 precision is made exactly rigid; a pose
/// of double is used unchanged. Throws Error naming the array and the place otherwise.
Pose pose_of(const PoseArray& poses, std::size_t k, const std::string& name);

inline Matrix4 matrix_of(const Pose& pose) {
  return pose.matrix();
}

/// An array that refers to C++ memory, which `owner` keeps alive.
template <class T, class Shape>
nb::ndarray<nb::numpy, T> array_at(T* data, const Shape& shape, nb::handle owner) {
  return nb::ndarray<nb::numpy, T>(data, shape.size(), shape.data(), owner);
}

/// An array of the values of a vector, which moves into it.
template <class T, std::size_t kDimensions>
nb::object array_from(std::vector<T> values, const std::array<std::size_t, kDimensions>& shape) {
  auto kept = std::make_unique<std::vector<T>>(std::move(values));
  T* const data = kept->data();
  const nb::capsule owner(
      kept.release(), [](void* vector) noexcept { delete static_cast<std::vector<T>*>(vector); });
  return nb::cast(array_at(data, shape, owner));
}

/// Enumerators as bytes.
template <class Status>
std::vector<std::uint8_t> status_bytes(const std::vector<Status>& status) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(status.size());
  for (const Status one : status) bytes.push_back(static_cast<std::uint8_t>(one));
  return bytes;
}

/// Copies of the rows of an array as Vectors; empty without an array.
template <class Vector, class Array>
std::vector<Vector> vectors(const std::optional<Array>& given) {
  if (!given) return {};
  std::vector<Vector> result(given->shape(0));
  if (!result.empty())
    std::memcpy(static_cast<void*>(result.data()), given->data(), result.size() * sizeof(Vector));
  return result;
}

/// A copy of rows of kColumns numbers; None when empty.
template <class T, std::size_t kColumns, class Values>
nb::object rows_of(const Values& values) {
  if (values.empty()) return nb::none();
  static_assert(sizeof(values[0]) == kColumns * sizeof(T));
  auto copy = std::make_unique<Values>(values);
  auto* data = reinterpret_cast<T*>(copy->data());
  const std::array<std::size_t, 2> shape = {values.size(), kColumns};
  const nb::capsule owner(copy.release(),
                          [](void* kept) noexcept { delete static_cast<Values*>(kept); });
  return nb::cast(array_at(data, shape, owner));
}

/// An entry of a dict, unless it is missing or None.
template <class T>
std::optional<T> entry(const nb::dict& dict, const char* key) {
  if (!dict.contains(key) || dict[key].is_none()) return std::nullopt;
  return nb::cast<T>(dict[key]);
}

}  // namespace glidar::python
