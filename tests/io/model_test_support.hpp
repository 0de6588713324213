// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "support/data.hpp"

#include <glidar/core/error.hpp>
#include <glidar/io/model/model.hpp>
#include <support/error_text.hpp>
#include <support/test_folder.hpp>

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace glidar::testing {

inline std::string read_file(const std::filesystem::path& path) {
  std::ostringstream content;
  content << std::ifstream(path, std::ios::binary).rdbuf();
  return content.str();
}

/// With the unit and the up axis that the file declares.
inline ModelOptions as_declared() {
  ModelOptions options;
  options.use_cache = false;
  options.time_limit_s = 30.0;
  return options;
}

/// With the numbers and axes of the file.
inline ModelOptions without_cache() {
  ModelOptions options = as_declared();
  options.metres_per_unit = 1.0;
  options.up = Axis::z;
  return options;
}

inline Model load(const std::filesystem::path& path,
                  const ModelOptions& options = without_cache()) {
  return load_model(path.string(), options, {});
}

/// The text of the Error that loading gives; "no error" when it loads.
inline std::string load_error(const std::string& source,
                              const ModelOptions& options = without_cache()) {
  return error_text([&] { load_model(source, options, {}); });
}

/// A picture that stb_image reads: binary PPM of one colour.
inline std::string ppm(int width, int height, const std::string& rgb) {
  std::string image = "P6 " + std::to_string(width) + " " + std::to_string(height) + " 255\n";
  for (int i = 0; i < width * height; ++i) image += rgb;
  return image;
}

/// A 24- or 32-bit TGA of one colour, for pictures with alpha; `bgra` holds 3 or 4 bytes.
inline std::string tga(int width, int height, const std::string& bgra) {
  std::string image(18, '\0');
  image[2] = 2;
  image[12] = static_cast<char>(width);
  image[14] = static_cast<char>(height);
  image[16] = static_cast<char>(bgra.size() * 8);
  image[17] = static_cast<char>(0x20 | (bgra.size() == 4 ? 8 : 0));  // rows from the top
  for (int i = 0; i < width * height; ++i) image += bgra;
  return image;
}

/// Two triangles with uvs and a material.
inline std::string quad_obj(const std::string& mtllib) {
  return "mtllib " + mtllib +
         "\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
         "usemtl paint\nf 1/1 2/2 3/3 4/4\n";
}

/// A glTF of one triangle in the xy plane with the given nodes and material parts.
inline std::string gltf(const std::string& nodes, const std::string& materials = "{}",
                        const std::string& more = "") {
  // Three float3 corners, three float2 uvs: (0,0,0) (1,0,0) (0,1,0); (0,0) (1,0) (0,1).
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":)" + nodes +
         R"(,"meshes":[{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":1},"material":0}]}],
"materials":[)" +
         materials + R"(],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},
{"bufferView":1,"componentType":5126,"count":3,"type":"VEC2"}],
"bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":24}],
"buffers":[{"byteLength":60,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/AAAAAAAAAAAAAIA/"}])" +
         more + "}";
}

}  // namespace glidar::testing

/// The sanitizers' own memory and signal handling hide what a test is about.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define GLIDAR_SKIP_SANITIZED() GTEST_SKIP() << "not under a sanitizer; run it by ./dev test"
#else
#define GLIDAR_SKIP_SANITIZED() static_cast<void>(0)
#endif
