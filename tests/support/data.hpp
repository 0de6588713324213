// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/model/model.hpp>

#include <gtest/gtest.h>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace glidar::testing {

/// The folder of real data, from GLIDAR_DATA; empty when unset.
inline std::filesystem::path data_folder() {
  const char* folder = std::getenv("GLIDAR_DATA");
  return folder == nullptr ? std::filesystem::path() : std::filesystem::path(folder);
}

#define GLIDAR_NEEDS_DATA()                                                      \
  if (::glidar::testing::data_folder().empty()) {                                \
    GTEST_SKIP() << "GLIDAR_DATA is not set; set it to a folder with real data"; \
  }

/// A model of the data folder with the axes of its file, which the references have, without
/// touching the user's cache.
inline Model load_data_model(const std::string& path) {
  ModelOptions options;
  options.use_cache = false;
  options.up = Axis::z;
  return load_model((data_folder() / path).string(), options, {});
}

/// A scene of one model at the world's origin.
inline Scene scene_of(Model model) {
  Scene scene;
  add_model(scene, std::move(model));
  return scene;
}

/// An array of a little-endian .npy file.
template <class T>
std::vector<T> read_npy(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream whole;
  whole << file.rdbuf();
  const std::string bytes = whole.str();
  if (bytes.size() < 10) throw std::runtime_error("no array in " + path.string());
  const std::size_t header =
      static_cast<unsigned char>(bytes[8]) + 256U * static_cast<unsigned char>(bytes[9]) + 10U;
  std::vector<T> values((bytes.size() - header) / sizeof(T));
  std::copy_n(bytes.data() + header, values.size() * sizeof(T),
              reinterpret_cast<char*>(values.data()));
  return values;
}

}  // namespace glidar::testing
