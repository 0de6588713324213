// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bind.hpp"

#include <glidar/core/pose.hpp>

#include <nanobind/ndarray.h>

#include <string>
#include <vector>

namespace glidar::python {

using Matrix4 = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;
using PoseArray = nb::ndarray<const double, nb::shape<-1, 4, 4>, nb::c_contig, nb::device::cpu>;
template <class T>
using Numbers = nb::ndarray<const T, nb::shape<-1>, nb::c_contig, nb::device::cpu>;
template <class T, int kColumns>
using Table = nb::ndarray<const T, nb::shape<-1, kColumns>, nb::c_contig, nb::device::cpu>;

/// Pose k of an array. What is as rigid as float32 can tell is made exactly so; a pose of double is
/// taken as it is. Throws Error naming the array and the place otherwise.
Pose pose_of(const PoseArray& poses, std::size_t k, const std::string& name);

inline Matrix4 matrix_of(const Pose& pose) {
  return pose.matrix();
}

/// An array that refers to C++ memory, which `owner` keeps alive.
template <class T, class Shape>
nb::ndarray<nb::numpy, T> array_at(T* data, const Shape& shape, nb::handle owner) {
  return nb::ndarray<nb::numpy, T>(data, shape.size(), shape.data(), owner);
}

}  // namespace glidar::python
