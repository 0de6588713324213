// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/formats/file_sink.hpp>
#include <glidar/math/constants.hpp>
#include <support/test_folder.hpp>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace glidar {

/// A cloud whose numbers are formulas of the point's index; readers_test.py has the same formulas.
/// Every third beam misses.
struct CloudFixture {
  std::uint32_t rows = 4;
  std::uint32_t cols = 5;
  Scene scene;
  Sensor sensor;
  Beams beams;
  Frame frame;
  PointCloud cloud;

  [[nodiscard]] SidecarContext context() const { return {scene, sensor, beams, "rays"}; }
};

inline bool is_miss(std::size_t i) {
  return i % 3 == 2;
}

namespace fixture {

template <class T, class Function>
void add_column(PointCloud& cloud, std::string name, std::vector<std::string> components,
                Function value_of) {
  std::vector<T> values;
  for (std::size_t i = 0; i < cloud.size(); ++i)
    for (std::size_t c = 0; c < components.size(); ++c) values.push_back(value_of(i, c));
  cloud.columns.push_back({std::move(name), std::move(components), std::move(values)});
}

inline void add_columns(PointCloud& cloud) {
  add_column<double>(cloud, "xyz", {"x", "y", "z"}, [](std::size_t i, std::size_t c) {
    const double at = static_cast<double>(i);
    const double xyz[3] = {at * 0.125 + 1.0 / 3.0, -at / 7.0, 2.0 + at * 0.01};
    return is_miss(i) ? kNaN : xyz[c];
  });
  add_column<float>(cloud, "intensity", {"intensity"}, [](std::size_t i, std::size_t) {
    return is_miss(i) ? 0.0F : static_cast<float>(i) / 20.0F;
  });
  add_column<double>(cloud, "depth", {"depth"}, [](std::size_t i, std::size_t) {
    return is_miss(i) ? kNaN : 1.0 + static_cast<double>(i % 100) / 3.0;
  });
  add_column<float>(cloud, "normal", {"normal_x", "normal_y", "normal_z"},
                    [](std::size_t i, std::size_t c) {
                      const float normal[3] = {0.6F, -0.8F, 0.0F};
                      return is_miss(i) ? kNaNf : normal[c];
                    });
  add_column<float>(cloud, "colour", {"red", "green", "blue"}, [](std::size_t i, std::size_t c) {
    const float at = static_cast<float>(i) / 20.0F;
    const float rgb[3] = {at, 1.0F - at, 0.5F};
    return is_miss(i) ? 0.0F : rgb[c];
  });
  add_column<std::uint32_t>(cloud, "instance", {"instance"}, [](std::size_t i, std::size_t) {
    return is_miss(i) ? kInvalidId : static_cast<std::uint32_t>(i + 7);
  });
  add_column<std::uint16_t>(cloud, "ring", {"ring"}, [](std::size_t i, std::size_t) {
    return static_cast<std::uint16_t>(i * 1000);
  });
  add_column<std::uint8_t>(cloud, "status", {"status"}, [](std::size_t i, std::size_t) {
    return static_cast<std::uint8_t>(is_miss(i) ? Status::miss : Status::hit);
  });
}

/// Additional columns of ground truth images.
inline void add_image_columns(PointCloud& cloud) {
  add_column<float>(cloud, "incidence", {"incidence"}, [](std::size_t i, std::size_t) {
    return is_miss(i) ? kNaNf : 0.01F * static_cast<float>(i % 150);
  });
  add_column<double>(cloud, "range", {"range"}, [](std::size_t i, std::size_t) {
    return is_miss(i) ? kNaN : 1.0 + static_cast<double>(i);
  });
  add_column<std::uint32_t>(cloud, "class", {"class"}, [](std::size_t i, std::size_t) {
    return is_miss(i) ? kInvalidId : static_cast<std::uint32_t>(i % 3);
  });
  add_column<double>(cloud, "radial_velocity", {"radial_velocity"},
                     [](std::size_t, std::size_t) { return kNaN; });
}

/// Additional columns of scanners, which layouts need.
inline void add_scan_columns(PointCloud& cloud) {
  const auto add_angle = [&](const char* name, double first_rad, double step_rad) {
    add_column<double>(cloud, name, {name}, [=](std::size_t i, std::size_t) {
      return first_rad + step_rad * static_cast<double>(i % 24);
    });
  };
  add_angle("azimuth", -3.0, 0.25);
  add_angle("elevation", -0.25, 0.0125);
  add_column<double>(cloud, "range", {"range"}, [=](std::size_t i, std::size_t) {
    return is_miss(i) ? kNaN : 1.0 + static_cast<double>(i) * 0.001234;
  });
  add_column<std::uint32_t>(cloud, "time", {"time"}, [](std::size_t i, std::size_t) {
    return static_cast<std::uint32_t>(i * 55296);
  });
  add_column<std::uint8_t>(cloud, "return", {"return"},
                           [](std::size_t, std::size_t) { return std::uint8_t{0}; });
  add_column<std::int64_t>(cloud, "stamp", {"stamp"}, [](std::size_t i, std::size_t) {
    return 1700000000123456789 + static_cast<std::int64_t>(i) * 55296;
  });
}

inline void set_frame(CloudFixture& made) {
  Frame& frame = made.frame;
  const std::size_t count = std::size_t{made.rows} * made.cols;
  frame.rows = made.rows;
  frame.cols = made.cols;
  frame.frame_id = "camera";
  frame.stamp_ns = -1234567890123456789;
  frame.seed = 18446744073709551615U;
  frame.world_from_sensor = make_pose({1.0, 2.0, 3.0}, Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5));
  frame.world_from_instance = {make_pose({10.0, 0.0, 0.0}, Eigen::Quaterniond(0.0, 0.0, 0.0, 1.0)),
                               Pose::Identity()};
  for (std::size_t i = 0; i < count; ++i)
    frame.status.push_back(is_miss(i) ? Status::miss : Status::hit);
  for (std::size_t i = 0; i < count; ++i)
    frame.range_m.push_back(is_miss(i) ? kNaN : 1.0 + static_cast<double>(i));
  frame.framebuffer = {
      .rows = made.rows, .cols = made.cols, .near_m = 1.25, .far_m = 3.1, .rgba = {}};
  for (std::size_t k = 0; k < 4 * count; ++k)
    frame.framebuffer.rgba.push_back(static_cast<std::uint8_t>(k * 37));
  for (const char* name : {"ir_left", "ir_right", "ir_reference", "pattern_00", "pattern_01"}) {
    RawImage& image = frame.raw_images.emplace_back();
    image.name = name;
    image.grey = {.width = made.cols, .height = made.rows};
    for (std::size_t i = 0; i < count; ++i) {
      image.grey.level.push_back(
          static_cast<std::uint16_t>((i * 31 + frame.raw_images.size()) % 256));
    }
  }
  frame.tof_images = {
      .width = made.cols, .height = made.rows, .frequencies = 1, .taps = 4, .level = {}};
  for (std::size_t i = 0; i < 4 * count; ++i)
    frame.tof_images.level.push_back(static_cast<float>(i % 50) - 25.0F);
  frame.tof_amplitude.assign(count, 12.5F);
}

}  // namespace fixture

inline CloudFixture make_fixture(std::uint32_t rows = 4, std::uint32_t cols = 5) {
  CloudFixture made;
  made.rows = rows;
  made.cols = cols;
  made.scene.meshes.resize(1);
  made.scene.sources = {{"rock.ply", "0123abcd"}};
  made.scene.instances.resize(2);
  made.scene.instances[0].name = "rock";
  made.scene.instances[0].id = 7;
  made.scene.instances[0].scale = 2.5;
  made.scene.instances[1].name = "other rock";
  fixture::set_frame(made);
  made.cloud.rows = rows;
  made.cloud.cols = cols;
  made.cloud.frame_id = "map";
  made.cloud.world_from_cloud =
      make_pose({0.0, 0.0, -1.0}, Eigen::Quaterniond(std::sqrt(0.5), 0.0, 0.0, std::sqrt(0.5)));
  fixture::add_columns(made.cloud);
  return made;
}

inline void write_cloud(const CloudFixture& made, const std::filesystem::path& path,
                        const FileSinkOptions& options = {}) {
  const SidecarContext context = made.context();
  make_file_sink(path, options, context)->write(made.cloud, made.frame);
}

inline void drop_column(PointCloud& cloud, std::string_view name) {
  std::erase_if(cloud.columns, [&](const Column& column) { return column.name == name; });
}

inline std::string file_bytes(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

}  // namespace glidar
