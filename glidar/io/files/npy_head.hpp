// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io: arrays of NumPy.

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace glidar {

/// A type of numbers: its text in headers, and its size.
struct NpyType {
  const char* text;
  std::size_t bytes;
};

/// Types that a reader accepts, and the same in words for errors.
struct NpyTypes {
  std::array<NpyType, 2> types;
  const char* allowed;
  const char* remedy;
};

inline constexpr NpyTypes kNpyFloats = {
    {{{"'<f4'", 4}, {"'<f8'", 8}}},
    "float32 or float64, row by row",
    "numpy.save(file, numpy.ascontiguousarray(array, dtype='<f8'))"};
inline constexpr NpyTypes kNpyGreyLevels = {
    {{{"'|u1'", 1}, {"'<u2'", 2}}},
    "uint8 or uint16, row by row",
    "numpy.save(file, numpy.ascontiguousarray(array, dtype='<u2'))"};

/// The header of an .npy file of numbers in C order. Source: numpy.lib.format ("Format
/// Version 1.0" and "2.0").
struct NpyHead {
  std::size_t data_at = 0;         ///< offset of the first number
  std::size_t number_bytes = 0;    ///< of the type
  std::vector<std::size_t> shape;  ///< at most five sizes
};

/// Throws Error, with `where` as its place, for other contents.
NpyHead read_npy_head(const std::string& where, const std::string& bytes,
                      const NpyTypes& types = kNpyFloats);

/// Throws Error when the file has fewer numbers than the shape requires.
void require_npy_numbers(const std::string& where, const NpyHead& head, const std::string& bytes);

/// The float or double at `data`, of 4 or 8 bytes.
double npy_number(const char* data, std::size_t bytes);

}  // namespace glidar
