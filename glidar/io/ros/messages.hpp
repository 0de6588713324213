// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Messages of ROS as plain structs. The members of each one are listed once, in wire order, by its
// function visit_members(), from which all codecs follow (codec.hpp). Definitions: the packages
// std_msgs, sensor_msgs, geometry_msgs, tf2_msgs, nav_msgs, rosgraph_msgs and visualization_msgs of
// ROS 1 Noetic and ROS 2 (Marker: Humble and later), livox_ros_driver2 (CustomMsg), velodyne_msgs
// (VelodyneScan) and ouster_sensor_msgs.

#include <glidar/core/file_text.hpp>

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace glidar::ros {

/// The large uint8[] of a message. Either its bytes, or a function that writes them into the
/// serialized message, so that a cloud is copied only once.
class Payload {
 public:
  using Writer = std::function<void(std::span<std::byte>)>;

  Payload() = default;
  explicit Payload(std::vector<std::byte> bytes) : bytes_(std::move(bytes)) {}
  /// `write` fills exactly `size` bytes; it may be called several times.
  Payload(std::size_t size, Writer write) : size_(size), write_(std::move(write)) {}

  [[nodiscard]] std::size_t size() const { return write_ ? size_ : bytes_.size(); }
  /// The bytes that it holds; empty when a function writes them.
  [[nodiscard]] std::span<const std::byte> bytes() const { return bytes_; }
  /// Writes size() bytes.
  void write_to(std::span<std::byte> to) const;
  /// A copy of the bytes.
  [[nodiscard]] std::vector<std::byte> to_vector() const;

 private:
  std::vector<std::byte> bytes_;
  std::size_t size_ = 0;
  Writer write_;
};

/// For constraints: Type is Message or const Message.
template <class Type, class Message>
concept Is = std::same_as<std::remove_const_t<Type>, Message>;

/// A member that ROS 2 does not have.
template <class Type>
struct Ros1Only {
  Type& value;
};
template <class Type>
Ros1Only(Type&) -> Ros1Only<Type>;

/// A member that ROS 1 does not have.
template <class Type>
struct Ros2Only {
  Type& value;
};
template <class Type>
Ros2Only(Type&) -> Ros2Only<Type>;

struct Time {
  std::int32_t sec = 0;  ///< unsigned in ROS 1
  std::uint32_t nanosec = 0;
  bool operator==(const Time&) const = default;
};
void visit_members(Is<Time> auto& m, auto&& visit) {
  visit(m.sec, m.nanosec);
}

/// Throws Error outside the range of ROS 2, the years 1901 to 2038.
Time time_from_ns(std::int64_t t_ns);
std::int64_t to_ns(const Time& time);

struct Header {
  std::uint32_t seq = 0;
  Time stamp;
  FileText frame_id;  ///< without a leading slash
};
void visit_members(Is<Header> auto& m, auto&& visit) {
  visit(Ros1Only{m.seq}, m.stamp, m.frame_id);
}

struct PointField {
  /// Values of `datatype`.
  enum Datatype : std::uint8_t {
    int8 = 1,
    uint8 = 2,
    int16 = 3,
    uint16 = 4,
    int32 = 5,
    uint32 = 6,
    float32 = 7,
    float64 = 8,
  };
  FileText name;
  std::uint32_t offset = 0;
  std::uint8_t datatype = 0;
  std::uint32_t count = 1;
};
void visit_members(Is<PointField> auto& m, auto&& visit) {
  visit(m.name, m.offset, m.datatype, m.count);
}

struct PointCloud2 {
  Header header;
  std::uint32_t height = 0;
  std::uint32_t width = 0;
  std::vector<PointField> fields;
  bool is_bigendian = false;
  std::uint32_t point_step = 0;
  std::uint32_t row_step = 0;
  Payload data;
  bool is_dense = false;
};
void visit_members(Is<PointCloud2> auto& m, auto&& visit) {
  visit(m.header, m.height, m.width, m.fields, m.is_bigendian, m.point_step, m.row_step, m.data,
        m.is_dense);
}

struct LaserScan {
  Header header;
  float angle_min = 0.0F;        ///< rad
  float angle_max = 0.0F;        ///< rad
  float angle_increment = 0.0F;  ///< rad
  float time_increment = 0.0F;   ///< s
  float scan_time = 0.0F;        ///< s
  float range_min = 0.0F;        ///< m
  float range_max = 0.0F;        ///< m
  std::vector<float> ranges;     ///< m
  std::vector<float> intensities;
};
void visit_members(Is<LaserScan> auto& m, auto&& visit) {
  visit(m.header, m.angle_min, m.angle_max, m.angle_increment, m.time_increment, m.scan_time,
        m.range_min, m.range_max, m.ranges, m.intensities);
}

struct Image {
  Header header;
  std::uint32_t height = 0;
  std::uint32_t width = 0;
  std::string encoding;
  std::uint8_t is_bigendian = 0;
  std::uint32_t step = 0;
  Payload data;
};
void visit_members(Is<Image> auto& m, auto&& visit) {
  visit(m.header, m.height, m.width, m.encoding, m.is_bigendian, m.step, m.data);
}

struct CompressedImage {
  Header header;
  std::string format;
  Payload data;
};
void visit_members(Is<CompressedImage> auto& m, auto&& visit) {
  visit(m.header, m.format, m.data);
}

struct RegionOfInterest {
  std::uint32_t x_offset = 0;
  std::uint32_t y_offset = 0;
  std::uint32_t height = 0;
  std::uint32_t width = 0;
  bool do_rectify = false;
};
void visit_members(Is<RegionOfInterest> auto& m, auto&& visit) {
  visit(m.x_offset, m.y_offset, m.height, m.width, m.do_rectify);
}

struct CameraInfo {
  Header header;
  std::uint32_t height = 0;
  std::uint32_t width = 0;
  std::string distortion_model;
  std::vector<double> d;
  std::array<double, 9> k{};
  std::array<double, 9> r{};
  std::array<double, 12> p{};
  std::uint32_t binning_x = 0;
  std::uint32_t binning_y = 0;
  RegionOfInterest roi;
};
void visit_members(Is<CameraInfo> auto& m, auto&& visit) {
  visit(m.header, m.height, m.width, m.distortion_model, m.d, m.k, m.r, m.p, m.binning_x,
        m.binning_y, m.roi);
}

struct Vector3 {
  double x = 0.0;
  double y = 0.0;
  double z = 0.0;
};
void visit_members(Is<Vector3> auto& m, auto&& visit) {
  visit(m.x, m.y, m.z);
}

struct Quaternion {
  double x = 0.0;
  double y = 0.0;
  double z = 0.0;
  double w = 1.0;
};
void visit_members(Is<Quaternion> auto& m, auto&& visit) {
  visit(m.x, m.y, m.z, m.w);
}

struct Imu {
  Header header;
  Quaternion orientation;
  std::array<double, 9> orientation_covariance{};
  Vector3 angular_velocity;  ///< rad/s
  std::array<double, 9> angular_velocity_covariance{};
  Vector3 linear_acceleration;  ///< m/s^2
  std::array<double, 9> linear_acceleration_covariance{};
};
void visit_members(Is<Imu> auto& m, auto&& visit) {
  visit(m.header, m.orientation, m.orientation_covariance, m.angular_velocity,
        m.angular_velocity_covariance, m.linear_acceleration, m.linear_acceleration_covariance);
}

struct Transform {
  Vector3 translation;  ///< m
  Quaternion rotation;
};
void visit_members(Is<Transform> auto& m, auto&& visit) {
  visit(m.translation, m.rotation);
}

/// The pose of child_frame_id in header.frame_id.
struct TransformStamped {
  Header header;
  FileText child_frame_id;
  Transform transform;
};
void visit_members(Is<TransformStamped> auto& m, auto&& visit) {
  visit(m.header, m.child_frame_id, m.transform);
}

struct TFMessage {
  std::vector<TransformStamped> transforms;
};
void visit_members(Is<TFMessage> auto& m, auto&& visit) {
  visit(m.transforms);
}

/// geometry_msgs/Pose; the position has the members of Vector3.
struct PoseMessage {
  Vector3 position;  ///< m
  Quaternion orientation;
};
void visit_members(Is<PoseMessage> auto& m, auto&& visit) {
  visit(m.position, m.orientation);
}

struct PoseStamped {
  Header header;
  PoseMessage pose;
};
void visit_members(Is<PoseStamped> auto& m, auto&& visit) {
  visit(m.header, m.pose);
}

struct Clock {
  Time clock;
};
void visit_members(Is<Clock> auto& m, auto&& visit) {
  visit(m.clock);
}

/// geometry_msgs/PoseWithCovariance and TwistWithCovariance in place.
struct Odometry {
  Header header;
  FileText child_frame_id;
  PoseMessage pose;  ///< of child_frame_id in header.frame_id
  std::array<double, 36> pose_covariance{};
  Vector3 linear_velocity;   ///< m/s, in child_frame_id
  Vector3 angular_velocity;  ///< rad/s, in child_frame_id
  std::array<double, 36> twist_covariance{};
};
void visit_members(Is<Odometry> auto& m, auto&& visit) {
  visit(m.header, m.child_frame_id, m.pose, m.pose_covariance, m.linear_velocity,
        m.angular_velocity, m.twist_covariance);
}

struct ColorRGBA {
  float r = 0.0F;  ///< all from 0 to 1
  float g = 0.0F;
  float b = 0.0F;
  float a = 1.0F;
};
void visit_members(Is<ColorRGBA> auto& m, auto&& visit) {
  visit(m.r, m.g, m.b, m.a);
}

struct UVCoordinate {
  float u = 0.0F;
  float v = 0.0F;
};
void visit_members(Is<UVCoordinate> auto& m, auto&& visit) {
  visit(m.u, m.v);
}

struct MeshFile {
  std::string filename;
  Payload data;
};
void visit_members(Is<MeshFile> auto& m, auto&& visit) {
  visit(m.filename, m.data);
}

/// visualization_msgs/Marker.
struct Marker {
  /// A value of `type`.
  static constexpr std::int32_t kCube = 1;
  Header header;
  std::string ns;
  std::int32_t id = 0;  ///< unique in `ns`
  std::int32_t type = 0;
  std::int32_t action = 0;  ///< 0: add or change
  PoseMessage pose;
  Vector3 scale;  ///< m
  ColorRGBA color;
  Time lifetime;  ///< 0: until it is changed
  bool frame_locked = false;
  std::vector<Vector3> points;
  std::vector<ColorRGBA> colors;
  std::string texture_resource;
  CompressedImage texture;
  std::vector<UVCoordinate> uv_coordinates;
  std::string text;
  std::string mesh_resource;
  MeshFile mesh_file;
  bool mesh_use_embedded_materials = false;
};
void visit_members(Is<Marker> auto& m, auto&& visit) {
  visit(m.header, m.ns, m.id, m.type, m.action, m.pose, m.scale, m.color, m.lifetime,
        m.frame_locked, m.points, m.colors, Ros2Only{m.texture_resource}, Ros2Only{m.texture},
        Ros2Only{m.uv_coordinates}, m.text, m.mesh_resource, Ros2Only{m.mesh_file},
        m.mesh_use_embedded_materials);
}

struct MarkerArray {
  std::vector<Marker> markers;
};
void visit_members(Is<MarkerArray> auto& m, auto&& visit) {
  visit(m.markers);
}

struct CustomPoint {
  std::uint32_t offset_time = 0;  ///< ns since CustomMsg::timebase
  float x = 0.0F;                 ///< m
  float y = 0.0F;                 ///< m
  float z = 0.0F;                 ///< m
  std::uint8_t reflectivity = 0;
  std::uint8_t tag = 0;
  std::uint8_t line = 0;
};
void visit_members(Is<CustomPoint> auto& m, auto&& visit) {
  visit(m.offset_time, m.x, m.y, m.z, m.reflectivity, m.tag, m.line);
}

/// livox_ros_driver2/CustomMsg.
struct CustomMsg {
  Header header;
  std::uint64_t timebase = 0;  ///< ns, time of the first point
  std::uint32_t point_num = 0;
  std::uint8_t lidar_id = 0;
  std::array<std::uint8_t, 3> rsvd{};
  std::vector<CustomPoint> points;
};
void visit_members(Is<CustomMsg> auto& m, auto&& visit) {
  visit(m.header, m.timebase, m.point_num, m.lidar_id, m.rsvd, m.points);
}

struct VelodynePacket {
  Time stamp;
  std::array<std::uint8_t, 1206> data{};
};
void visit_members(Is<VelodynePacket> auto& m, auto&& visit) {
  visit(m.stamp, m.data);
}

struct VelodyneScan {
  Header header;
  std::vector<VelodynePacket> packets;
};
void visit_members(Is<VelodyneScan> auto& m, auto&& visit) {
  visit(m.header, m.packets);
}

/// ouster_sensor_msgs/PacketMsg; in ROS 1 ouster_ros/PacketMsg.
struct PacketMsg {
  std::vector<std::uint8_t> buf;
};
void visit_members(Is<PacketMsg> auto& m, auto&& visit) {
  visit(m.buf);
}

/// std_msgs/String.
struct String {
  std::string data;
};
void visit_members(Is<String> auto& m, auto&& visit) {
  visit(m.data);
}

}  // namespace glidar::ros
