// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io: arrays of NumPy.

#include <cstddef>
#include <string>
#include <vector>

namespace glidar {

/// Types of numbers that a reader accepts.
enum class NpyNumbers {
  real,         ///< floats of 16 to 64 bits, integers
  grey_levels,  ///< uint8 and uint16
};

/// The header of an .npy file of real numbers in C order. Source: numpy.lib.format ("Format
/// Version 1.0" and "2.0").
struct NpyHead {
  std::size_t data_at = 0;                          ///< offset of the first number
  std::size_t number_bytes = 0;                     ///< 1 to 8
  double (*number_at)(const char* data) = nullptr;  ///< reads a number of the file's type
  std::vector<std::size_t> shape;                   ///< at most five sizes
};

/// Throws Error, with `where` as its place, for other contents.
NpyHead read_npy_head(const std::string& where, const std::string& bytes,
                      NpyNumbers accepted = NpyNumbers::real);

/// Throws Error when the file has fewer numbers than the shape requires.
void require_npy_numbers(const std::string& where, const NpyHead& head, const std::string& bytes);

}  // namespace glidar
