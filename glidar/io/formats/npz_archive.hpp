// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io: archives of NumPy arrays.

#include <glidar/io/files/atomic_file.hpp>
#include <glidar/io/formats/npy_file.hpp>

#include <cstddef>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace glidar {

/// One array of an archive; `bytes` must stay valid until the archive is written.
struct NpzArray {
  std::string name;
  std::string head;
  std::span<const std::byte> bytes;
};

/// NumPy's name of a type, little-endian: "<f8".
template <class T>
std::string numpy_type() {
  const char kind = std::is_floating_point_v<T> ? 'f' : std::is_signed_v<T> ? 'i' : 'u';
  return std::string(1, sizeof(T) == 1 ? '|' : '<') + kind + std::to_string(sizeof(T));
}

template <class T>
NpzArray npz_array(std::string name, const std::vector<std::size_t>& shape,
                   std::span<const T> values) {
  return {std::move(name), npy_header(numpy_type<T>(), shape), std::as_bytes(values)};
}

/// Writes an uncompressed archive; its bytes do not depend on the time.
void write_npz_archive(const std::vector<NpzArray>& arrays, AtomicFile& file);

}  // namespace glidar
