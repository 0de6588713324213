// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/core: fills the columns of clouds.

#include <glidar/core/point_cloud.hpp>
#include <glidar/math/thread_pool.hpp>

#include <cstddef>

namespace glidar {

/// The inputs of all columns.
struct ColumnSource {
  const Frame& frame;
  const Beams& beams;
  const Scene& scene;
  const Pose cloud_from_sensor;
  bool deskew;
  ThreadPool* thread_pool;
};

/// The column's numbers as vector<T> of `count` entries, reusing memory.
template <class T>
std::vector<T>& sized(Column& column, std::size_t count) {
  if (!std::holds_alternative<std::vector<T>>(column.values))
    column.values.emplace<std::vector<T>>();
  auto& values = std::get<std::vector<T>>(column.values);
  values.resize(count);
  return values;
}

/// Calls body(begin, end) for ranges that cover all points.
template <class Body>
void for_pieces(const ColumnSource& source, const Body& body) {
  constexpr std::size_t kPoints = 16384;  // fewer are not worth a thread
  const std::size_t size = source.beams.size();
  if (source.thread_pool == nullptr) return body(0, size);
  source.thread_pool->parallel_for(size, kPoints, body);
}

/// One number per point, from a function of the beam's index.
template <class T, class Function>
void fill_each(const ColumnSource& source, Column& column, Function value_of) {
  T* const values = sized<T>(column, source.beams.size()).data();
  for_pieces(source, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) values[i] = value_of(i);
  });
}

/// The components of a fixed-size vector per point, from a function of the beam's index.
template <class T, int kSize, class Function>
void fill_vectors(const ColumnSource& source, Column& column, Function vector_of) {
  T* const values = sized<T>(column, source.beams.size() * kSize).data();
  for_pieces(source, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Eigen::Map<Eigen::Matrix<T, kSize, 1>> target(values + i * kSize);
      target = vector_of(i);
    }
  });
}

}  // namespace glidar
