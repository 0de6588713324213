// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/ros/messages.hpp>

#include <cstdint>
#include <numeric>
#include <string>
#include <vector>

namespace glidar::ros {

/// Messages with a different number in each member; bag_readers_test.py expects the same.
inline Header sample_header(std::uint32_t seq) {
  return {seq, {1'700'000'000 + static_cast<std::int32_t>(seq), 123'456'789}, "lidar_frame"};
}

inline Payload sample_bytes(std::size_t count) {
  std::vector<std::byte> bytes(count);
  for (std::size_t i = 0; i < count; ++i) bytes[i] = static_cast<std::byte>(i * 7);
  return Payload(std::move(bytes));
}

template <class Array>
Array counted(double first) {
  Array values;
  std::iota(values.begin(), values.end(), first);
  return values;
}

template <class Message>
Message sample(std::uint32_t seq);

template <>
inline Header sample(std::uint32_t seq) {
  return sample_header(seq);
}
template <>
inline PointField sample(std::uint32_t seq) {
  return {"intensity", 12 + seq, PointField::float32, 1};
}
template <>
inline PointCloud2 sample(std::uint32_t seq) {
  PointCloud2 m;
  m.header = sample_header(seq);
  m.height = 1;
  m.width = 3;
  m.fields = {{"x", 0, PointField::float32, 1},
              {"y", 4, PointField::float32, 1},
              {"z", 8, PointField::float32, 1},
              {"ring", 12, PointField::uint16, 1}};
  m.point_step = 14;
  m.row_step = 42;
  m.data = sample_bytes(42);
  m.is_dense = true;
  return m;
}
template <>
inline LaserScan sample(std::uint32_t seq) {
  return {sample_header(seq),   -1.5F, 1.5F, 0.5F, 1e-4F, 0.1F, 0.2F, 30.0F, {1.0F, 2.0F, 3.0F},
          {10.0F, 20.0F, 30.0F}};
}
template <>
inline Image sample(std::uint32_t seq) {
  return {sample_header(seq), 2, 3, "16UC1", 0, 6, sample_bytes(12)};
}
template <>
inline CompressedImage sample(std::uint32_t seq) {
  return {sample_header(seq), "mono8; png compressed ", sample_bytes(11)};
}
template <>
inline CameraInfo sample(std::uint32_t seq) {
  return {sample_header(seq),
          480,
          640,
          "plumb_bob",
          {0.1, 0.2, 0.3, 0.4, 0.5},
          counted<std::array<double, 9>>(1.0),
          counted<std::array<double, 9>>(11.0),
          counted<std::array<double, 12>>(21.0),
          1,
          2,
          {3, 4, 5, 6, true}};
}
template <>
inline Imu sample(std::uint32_t seq) {
  return {sample_header(seq),
          {0.1, 0.2, 0.3, 0.9},
          counted<std::array<double, 9>>(1.0),
          {1.5, 2.5, 3.5},
          counted<std::array<double, 9>>(11.0),
          {4.5, 5.5, 9.81},
          counted<std::array<double, 9>>(21.0)};
}
template <>
inline TFMessage sample(std::uint32_t seq) {
  const double at = seq;
  return {{{sample_header(seq), "base", {{at, 2.0 * at, 0.5}, {0.0, 0.0, 0.0, 1.0}}},
           {sample_header(seq), "lidar", {{0.1, 0.2, 0.3}, {0.0, 0.0, 0.6, 0.8}}}}};
}
template <>
inline PoseStamped sample(std::uint32_t seq) {
  return {sample_header(seq), {{1.0, 2.0, 3.0}, {0.0, 0.6, 0.0, 0.8}}};
}
template <>
inline Clock sample(std::uint32_t seq) {
  return {{1'700'000'000 + static_cast<std::int32_t>(seq), 123'456'789}};
}
template <>
inline Odometry sample(std::uint32_t seq) {
  Odometry m;
  m.header = sample_header(seq);
  m.child_frame_id = "base";
  m.pose = {{seq * 1.0, 2.0, 3.0}, {0.6, 0.0, 0.0, 0.8}};
  m.pose_covariance = counted<std::array<double, 36>>(1.0);
  m.linear_velocity = {0.1, 0.2, 0.3};
  m.angular_velocity = {0.4, 0.5, 0.6};
  m.twist_covariance = counted<std::array<double, 36>>(101.0);
  return m;
}
template <>
inline CustomMsg sample(std::uint32_t seq) {
  return {sample_header(seq),
          1'700'000'000'123'456'789U,
          2,
          7,
          {1, 2, 3},
          {{100, 1.0F, 2.0F, 3.0F, 150, 16, 3}, {200, 4.0F, 5.0F, 6.0F, 20, 0, 2}}};
}
template <>
inline VelodyneScan sample(std::uint32_t seq) {
  VelodyneScan m;
  m.header = sample_header(seq);
  m.packets.resize(2);
  m.packets[1].stamp = {5, 6};
  for (std::size_t i = 0; i < m.packets[1].data.size(); ++i)
    m.packets[1].data[i] = static_cast<std::uint8_t>(i);
  return m;
}

template <>
inline PacketMsg sample(std::uint32_t seq) {
  return {{static_cast<std::uint8_t>(seq), 2, 3, 4, 5}};
}
template <>
inline String sample(std::uint32_t seq) {
  return {"{\"seq\": " + std::to_string(seq) + "}"};
}

template <>
inline MarkerArray sample(std::uint32_t seq) {
  Marker marker;
  marker.header = sample_header(seq);
  marker.ns = "car";
  marker.id = 7;
  marker.type = Marker::kCube;
  marker.pose = {{1.0, 2.0, 3.0}, {0.0, 0.6, 0.0, 0.8}};
  marker.scale = {4.0, 1.8, 1.5};
  marker.color = {0.25F, 0.5F, 0.75F, 0.3F};
  marker.lifetime = {1, 2};
  marker.points = {{5.0, 6.0, 7.0}};
  marker.colors = {{1.0F, 0.0F, 0.5F, 1.0F}};
  marker.texture_resource = "texture";
  marker.texture = {sample_header(seq), "png", sample_bytes(5)};
  marker.uv_coordinates = {{0.25F, 0.75F}};
  marker.text = "a car";
  marker.mesh_resource = "mesh";
  marker.mesh_file = {"car.obj", sample_bytes(3)};
  marker.mesh_use_embedded_materials = true;
  return {{marker, Marker{}}};
}

/// Calls `body` with a sample of each message.
void for_all_messages(std::uint32_t seq, const auto& body) {
  body(sample<Header>(seq));
  body(sample<PointField>(seq));
  body(sample<PointCloud2>(seq));
  body(sample<LaserScan>(seq));
  body(sample<Image>(seq));
  body(sample<CompressedImage>(seq));
  body(sample<CameraInfo>(seq));
  body(sample<Imu>(seq));
  body(sample<TFMessage>(seq));
  body(sample<PoseStamped>(seq));
  body(sample<Clock>(seq));
  body(sample<Odometry>(seq));
  body(sample<CustomMsg>(seq));
  body(sample<VelodyneScan>(seq));
  body(sample<PacketMsg>(seq));
  body(sample<String>(seq));
  body(sample<MarkerArray>(seq));
}

}  // namespace glidar::ros
