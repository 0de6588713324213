// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/ros/codec.hpp>

#include <glidar/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace glidar::ros {
namespace {

static_assert(std::endian::native == std::endian::little, "messages are copied in memory order");

/// CDR_LE: OMG DDSI-RTPS 2.5, 10.5, representation identifier {0, 1}, options {0, 0}.
constexpr std::array<std::byte, 4> kCdrLittleEndian = {std::byte{0}, std::byte{1}, std::byte{0},
                                                       std::byte{0}};
constexpr std::size_t kMaxMessage = std::numeric_limits<std::uint32_t>::max();

std::size_t first_byte(Wire wire) {
  return wire == Wire::cdr ? kCdrLittleEndian.size() : 0;
}

/// Bytes before the next number of this size.
std::size_t padding(Wire wire, std::size_t position, std::size_t size) {
  return wire == Wire::cdr ? (size - (position - first_byte(wire)) % size) % size : 0;
}

/// Writes members of a serialized message over the bytes of an earlier one, which are not set to
/// zero before.
class MemberWriter {
 public:
  explicit MemberWriter(std::vector<std::byte>& to) : to_(to) {
    std::copy(kCdrLittleEndian.begin(), kCdrLittleEndian.end(), grow(kCdrLittleEndian.size(), 1));
  }

  /// Removes what is left of the earlier message.
  void finish() { to_.resize(size_); }

  template <class... Members>
  void operator()(Members&&... members) {
    (write(members), ...);
  }

 private:
  template <class Number>
  requires std::is_arithmetic_v<Number>
  void write(const Number& number) {
    std::memcpy(grow(sizeof number, sizeof number), &number, sizeof number);
  }

  void write(const std::string& text) {
    const std::size_t size = text.size() + 1;  // with a zero byte
    write_size(size);
    std::memcpy(grow(size, 1), text.c_str(), size);
  }

  void write(const FileText& text) { write(text.bytes()); }

  void write(const Payload& payload) {
    write_size(payload.size());
    std::byte* place = grow(payload.size(), 1);
    payload.write_to({place, payload.size()});
  }

  template <class Element>
  void write(const std::vector<Element>& elements) {
    write_size(elements.size());
    write_elements(std::span<const Element>(elements));
  }

  template <class Element, std::size_t kCount>
  void write(const std::array<Element, kCount>& elements) {
    write_elements(std::span<const Element>(elements));
  }

  template <class Member>
  void write(const Ros1Only<Member>& /*member*/) {}

  template <class Member>
  void write(const Ros2Only<Member>& member) {
    write(member.value);
  }

  template <class Member>
  requires std::is_class_v<Member>
  void write(const Member& member) { visit_members(member, *this); }

  template <class Element>
  void write_elements(std::span<const Element> elements) {
    if (elements.empty()) return;
    if constexpr (std::is_arithmetic_v<Element>) {
      std::memcpy(grow(elements.size_bytes(), sizeof(Element)), elements.data(),
                  elements.size_bytes());
    } else {
      for (const Element& element : elements) write(element);
    }
  }

  void write_size(std::size_t size) {
    if (size > kMaxMessage - size_) {
      throw Error({"ROS message", fmt::format("{} bytes in one array", size), "less than 4 GiB",
                   "use fewer points"});
    }
    write(static_cast<std::uint32_t>(size));
  }

  /// Space for `size` bytes behind the padding to `alignment`, which is zero.
  std::byte* grow(std::size_t size, std::size_t alignment) {
    const std::size_t at = size_ + (size_ == 0 ? 0 : padding(Wire::cdr, size_, alignment));
    if (at + size > to_.size()) to_.resize(at + size);
    std::fill(to_.data() + size_, to_.data() + at, std::byte{0});
    size_ = at + size;
    return to_.data() + at;
  }

  std::vector<std::byte>& to_;
  std::size_t size_ = 0;  ///< of what was written
};

/// Reads members from a serialized message; trusts no size.
class MemberReader {
 public:
  MemberReader(Wire wire, std::span<const std::byte> bytes, std::string_view type)
      : wire_(wire), bytes_(bytes), type_(type) {
    if (wire_ == Wire::ros1) return;
    const auto head = bytes_.first(std::min(bytes_.size(), kCdrLittleEndian.size()));
    if (head.size() < kCdrLittleEndian.size() || head[0] != kCdrLittleEndian[0] ||
        head[1] != kCdrLittleEndian[1]) {
      reject("an encapsulation header other than 00 01",
             "CDR, little-endian (00 01), as ROS 2 writes it");
    }
    position_ = kCdrLittleEndian.size();
  }

  template <class... Members>
  void operator()(Members&&... members) {
    (read(members), ...);
  }

  /// DDS may pad a message to a multiple of 4.
  void require_end() const {
    const std::size_t left = bytes_.size() - position_;
    if (left <= (wire_ == Wire::cdr ? 3U : 0U)) return;
    reject(fmt::format("{} bytes behind the last member", left), "a message of this type");
  }

 private:
  template <class Number>
  requires std::is_arithmetic_v<Number>
  void read(Number& number) {
    const std::byte* from = take(sizeof number, sizeof number);
    if constexpr (std::is_same_v<Number, bool>) {
      number = *from != std::byte{0};
    } else {
      std::memcpy(&number, from, sizeof number);
    }
  }

  void read(std::string& text) {
    const std::size_t size = read_size(1);
    const auto* from = reinterpret_cast<const char*>(take(size, 1));
    text.assign(from, size);
    if (wire_ == Wire::ros1 || size == 0) return;
    if (text.back() != '\0') reject("a text without a zero byte at its end", "a CDR string");
    text.pop_back();
  }

  void read(FileText& text) {
    std::string bytes;
    read(bytes);
    text = std::move(bytes);
  }

  void read(Payload& payload) {
    const std::size_t size = read_size(1);
    const std::byte* from = take(size, 1);
    payload = Payload(std::vector<std::byte>(from, from + size));
  }

  template <class Element>
  void read(std::vector<Element>& elements) {
    const std::size_t count = read_size(std::is_arithmetic_v<Element> ? sizeof(Element) : 1);
    elements.clear();
    if constexpr (std::is_arithmetic_v<Element>) {
      elements.resize(count);
      read_elements(std::span(elements));
    } else {
      // No more memory than for what the bytes contain.
      for (std::size_t i = 0; i < count; ++i) read(elements.emplace_back());
    }
  }

  template <class Element, std::size_t kCount>
  void read(std::array<Element, kCount>& elements) {
    read_elements(std::span<Element>(elements));
  }

  template <class Member>
  void read(Ros1Only<Member>& member) {
    if (wire_ == Wire::ros1) read(member.value);
  }

  template <class Member>
  void read(Ros2Only<Member>& member) {
    if (wire_ == Wire::cdr) read(member.value);
  }

  template <class Member>
  requires std::is_class_v<Member>
  void read(Member& member) { visit_members(member, *this); }

  template <class Number>
  void read_elements(std::span<Number> elements) {
    if (elements.empty()) return;
    std::memcpy(elements.data(), take(elements.size_bytes(), sizeof(Number)),
                elements.size_bytes());
  }

  /// A count of elements that take at least `element_bytes` each.
  std::size_t read_size(std::size_t element_bytes) {
    std::uint32_t size = 0;
    read(size);
    if (size > (bytes_.size() - position_) / element_bytes) {
      reject(fmt::format("an array of {} elements with {} bytes left", size,
                         bytes_.size() - position_),
             "arrays that end within the message");
    }
    return size;
  }

  const std::byte* take(std::size_t size, std::size_t alignment) {
    const std::size_t skipped = padding(wire_, position_, alignment);
    const std::size_t left = bytes_.size() - position_;
    if (skipped > left || size > left - skipped) {
      reject(fmt::format("{} bytes, which end within a member", bytes_.size()), "a whole message");
    }
    position_ += skipped + size;
    return bytes_.data() + position_ - size;
  }

  [[noreturn]] void reject(const std::string& found, const char* allowed) const {
    throw Error({fmt::format("message {}, byte {}", type_, position_), found, allowed,
                 "it is damaged, or of another type"});
  }

  Wire wire_;
  std::span<const std::byte> bytes_;
  std::string_view type_;
  std::size_t position_ = 0;
};

/// Bytes of the large array of a message, so that its memory is allocated once.
template <class Message>
std::size_t payload_size(const Message& message) {
  if constexpr (requires { message.data.size(); }) return message.data.size();
  if constexpr (requires { message.buf.size(); }) return message.buf.size();
  return 0;
}

}  // namespace

template <class Message>
void serialize_to(const Message& message, std::vector<std::byte>& to) {
  constexpr std::size_t kOthers = 1024;
  to.reserve(payload_size(message) + kOthers);
  MemberWriter writer(to);
  visit_members(message, writer);
  writer.finish();
}

template <class Message>
std::vector<std::byte> serialize(const Message& message) {
  std::vector<std::byte> bytes;
  serialize_to(message, bytes);
  return bytes;
}

template <class Message>
Message deserialize(std::span<const std::byte> bytes, Wire wire) {
  Message message;
  MemberReader reader(wire, bytes, message_type<Message>().name);
  visit_members(message, reader);
  reader.require_end();
  return message;
}

#define GLIDAR_ROS_CODEC(Message)                                      \
  template void serialize_to(const Message&, std::vector<std::byte>&); \
  template std::vector<std::byte> serialize(const Message&);           \
  template Message deserialize<Message>(std::span<const std::byte>, Wire);

GLIDAR_ROS_CODEC(Header)
GLIDAR_ROS_CODEC(PointField)
GLIDAR_ROS_CODEC(PointCloud2)
GLIDAR_ROS_CODEC(LaserScan)
GLIDAR_ROS_CODEC(Image)
GLIDAR_ROS_CODEC(CompressedImage)
GLIDAR_ROS_CODEC(CameraInfo)
GLIDAR_ROS_CODEC(Imu)
GLIDAR_ROS_CODEC(TFMessage)
GLIDAR_ROS_CODEC(PoseStamped)
GLIDAR_ROS_CODEC(Clock)
GLIDAR_ROS_CODEC(Odometry)
GLIDAR_ROS_CODEC(CustomMsg)
GLIDAR_ROS_CODEC(VelodyneScan)
GLIDAR_ROS_CODEC(PacketMsg)
GLIDAR_ROS_CODEC(String)
GLIDAR_ROS_CODEC(MarkerArray)

#undef GLIDAR_ROS_CODEC

namespace {

/// From common_interfaces, rcl_interfaces and geometry2 of ROS 2, livox_ros_driver2,
/// velodyne_msgs and ouster_sensor_msgs, without comments and default values.
struct Definition {
  std::string_view type;
  std::string_view fields;
};

constexpr std::array<Definition, 35> kDefinitions = {{
    {"builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n"},
    {"std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id\n"},
    {"sensor_msgs/PointField",
     "uint8 INT8=1\nuint8 UINT8=2\nuint8 INT16=3\nuint8 UINT16=4\nuint8 INT32=5\n"
     "uint8 UINT32=6\nuint8 FLOAT32=7\nuint8 FLOAT64=8\n"
     "string name\nuint32 offset\nuint8 datatype\nuint32 count\n"},
    {"sensor_msgs/PointCloud2",
     "std_msgs/Header header\nuint32 height\nuint32 width\nsensor_msgs/PointField[] fields\n"
     "bool is_bigendian\nuint32 point_step\nuint32 row_step\nuint8[] data\nbool is_dense\n"},
    {"sensor_msgs/LaserScan",
     "std_msgs/Header header\nfloat32 angle_min\nfloat32 angle_max\nfloat32 angle_increment\n"
     "float32 time_increment\nfloat32 scan_time\nfloat32 range_min\nfloat32 range_max\n"
     "float32[] ranges\nfloat32[] intensities\n"},
    {"sensor_msgs/Image",
     "std_msgs/Header header\nuint32 height\nuint32 width\nstring encoding\nuint8 is_bigendian\n"
     "uint32 step\nuint8[] data\n"},
    {"sensor_msgs/CompressedImage", "std_msgs/Header header\nstring format\nuint8[] data\n"},
    {"sensor_msgs/RegionOfInterest",
     "uint32 x_offset\nuint32 y_offset\nuint32 height\nuint32 width\nbool do_rectify\n"},
    {"sensor_msgs/CameraInfo",
     "std_msgs/Header header\nuint32 height\nuint32 width\nstring distortion_model\n"
     "float64[] d\nfloat64[9] k\nfloat64[9] r\nfloat64[12] p\nuint32 binning_x\n"
     "uint32 binning_y\nsensor_msgs/RegionOfInterest roi\n"},
    {"sensor_msgs/Imu",
     "std_msgs/Header header\ngeometry_msgs/Quaternion orientation\n"
     "float64[9] orientation_covariance\ngeometry_msgs/Vector3 angular_velocity\n"
     "float64[9] angular_velocity_covariance\ngeometry_msgs/Vector3 linear_acceleration\n"
     "float64[9] linear_acceleration_covariance\n"},
    {"geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n"},
    {"geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z\n"},
    {"geometry_msgs/Quaternion", "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n"},
    {"geometry_msgs/Transform",
     "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n"},
    {"geometry_msgs/TransformStamped",
     "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform\n"},
    {"tf2_msgs/TFMessage", "geometry_msgs/TransformStamped[] transforms\n"},
    {"geometry_msgs/Pose", "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n"},
    {"geometry_msgs/PoseStamped", "std_msgs/Header header\ngeometry_msgs/Pose pose\n"},
    {"geometry_msgs/PoseWithCovariance", "geometry_msgs/Pose pose\nfloat64[36] covariance\n"},
    {"geometry_msgs/Twist", "geometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n"},
    {"geometry_msgs/TwistWithCovariance", "geometry_msgs/Twist twist\nfloat64[36] covariance\n"},
    {"rosgraph_msgs/Clock", "builtin_interfaces/Time clock\n"},
    {"nav_msgs/Odometry",
     "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n"
     "geometry_msgs/TwistWithCovariance twist\n"},
    {"livox_ros_driver2/CustomPoint",
     "uint32 offset_time\nfloat32 x\nfloat32 y\nfloat32 z\nuint8 reflectivity\nuint8 tag\n"
     "uint8 line\n"},
    {"livox_ros_driver2/CustomMsg",
     "std_msgs/Header header\nuint64 timebase\nuint32 point_num\nuint8 lidar_id\nuint8[3] rsvd\n"
     "livox_ros_driver2/CustomPoint[] points\n"},
    {"velodyne_msgs/VelodynePacket", "builtin_interfaces/Time stamp\nuint8[1206] data\n"},
    {"velodyne_msgs/VelodyneScan",
     "std_msgs/Header header\nvelodyne_msgs/VelodynePacket[] packets\n"},
    {"ouster_ros/PacketMsg", "uint8[] buf\n"},
    {"std_msgs/String", "string data\n"},
    {"builtin_interfaces/Duration", "int32 sec\nuint32 nanosec\n"},
    {"std_msgs/ColorRGBA", "float32 r\nfloat32 g\nfloat32 b\nfloat32 a\n"},
    {"visualization_msgs/UVCoordinate", "float32 u\nfloat32 v\n"},
    {"visualization_msgs/MeshFile", "string filename\nuint8[] data\n"},
    {"visualization_msgs/Marker",
     "int32 ARROW=0\n"
     "int32 CUBE=1\n"
     "int32 SPHERE=2\n"
     "int32 CYLINDER=3\n"
     "int32 LINE_STRIP=4\n"
     "int32 LINE_LIST=5\n"
     "int32 CUBE_LIST=6\n"
     "int32 SPHERE_LIST=7\n"
     "int32 POINTS=8\n"
     "int32 TEXT_VIEW_FACING=9\n"
     "int32 MESH_RESOURCE=10\n"
     "int32 TRIANGLE_LIST=11\n"
     "int32 ADD=0\n"
     "int32 MODIFY=0\n"
     "int32 DELETE=2\n"
     "int32 DELETEALL=3\n"
     "std_msgs/Header header\nstring ns\nint32 id\nint32 type\nint32 action\n"
     "geometry_msgs/Pose pose\ngeometry_msgs/Vector3 scale\nstd_msgs/ColorRGBA color\n"
     "builtin_interfaces/Duration lifetime\nbool frame_locked\n"
     "geometry_msgs/Point[] points\nstd_msgs/ColorRGBA[] colors\nstring texture_resource\n"
     "sensor_msgs/CompressedImage texture\nvisualization_msgs/UVCoordinate[] uv_coordinates\n"
     "string text\nstring mesh_resource\nvisualization_msgs/MeshFile mesh_file\n"
     "bool mesh_use_embedded_materials\n"},
    {"visualization_msgs/MarkerArray", "visualization_msgs/Marker[] markers\n"},
}};

/// The fields of a type, a line each, e.g. of "std_msgs/Header".
std::string fields_of(std::string_view type) {
  for (const Definition& definition : kDefinitions) {
    if (definition.type == type) return std::string(definition.fields);
  }
  return {};
}

/// The types of these fields that are no numbers and texts.
std::vector<std::string> parts_of(std::string_view type) {
  const std::string fields = fields_of(type);
  std::vector<std::string> parts;
  for (std::size_t line = 0; line < fields.size(); line = fields.find('\n', line) + 1) {
    const std::string name = fields.substr(line, fields.find_first_of(" [", line) - line);
    if (name.find('/') != std::string::npos) parts.push_back(name);
  }
  return parts;
}

constexpr Qos kSensor = {.depth = 5};
constexpr Qos kDefault = {};
constexpr Qos kPackets = {.depth = 100};  // a revolution

/// In the order of Index. Independent programs compute the type hashes from the definitions
/// in the tests.
constexpr std::array<MessageType, 17> kMessageTypes = {{
    {"std_msgs/msg/Header", "std_msgs/Header",
     "RIHS01_f49fb3ae2cf070f793645ff749683ac6b06203e41c891e17701b1cb597ce6a01", kDefault},
    {"sensor_msgs/msg/PointField", "sensor_msgs/PointField",
     "RIHS01_5c6a4750728c2bcfbbf7037225b20b02d4429634732146b742dee1726637ef01", kDefault},
    {"sensor_msgs/msg/PointCloud2", "sensor_msgs/PointCloud2",
     "RIHS01_9198cabf7da3796ae6fe19c4cb3bdd3525492988c70522628af5daa124bae2b5", kSensor},
    {"sensor_msgs/msg/LaserScan", "sensor_msgs/LaserScan",
     "RIHS01_64c191398013af96509d518dac71d5164f9382553fce5c1f8cca5be7924bd828", kSensor},
    {"sensor_msgs/msg/Image", "sensor_msgs/Image",
     "RIHS01_d31d41a9a4c4bc8eae9be757b0beed306564f7526c88ea6a4588fb9582527d47", kSensor},
    {"sensor_msgs/msg/CompressedImage", "sensor_msgs/CompressedImage",
     "RIHS01_15640771531571185e2efc8a100baf923961a4d15d5569652e6cb6691e8e371a", kSensor},
    {"sensor_msgs/msg/CameraInfo", "sensor_msgs/CameraInfo",
     "RIHS01_b3dfd68ff46c9d56c80fd3bd4ed22c7a4ddce8c8348f2f59c299e73118e7e275", kSensor},
    {"sensor_msgs/msg/Imu",
     "sensor_msgs/Imu",
     "RIHS01_7d9a00ff131080897a5ec7e26e315954b8eae3353c3f995c55faf71574000b5b",
     {.depth = 200}},
    {"tf2_msgs/msg/TFMessage",
     "tf2_msgs/TFMessage",
     "RIHS01_e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087",
     {.depth = 100}},
    {"geometry_msgs/msg/PoseStamped", "geometry_msgs/PoseStamped",
     "RIHS01_10f3786d7d40fd2b54367835614bff85d4ad3b5dab62bf8bca0cc232d73b4cd8", kDefault},
    {"rosgraph_msgs/msg/Clock",
     "rosgraph_msgs/Clock",
     "RIHS01_692f7a66e93a3c83e71765d033b60349ba68023a8c689a79e48078bcb5c58564",
     {.depth = 1}},
    {"nav_msgs/msg/Odometry", "nav_msgs/Odometry",
     "RIHS01_3cc97dc7fb7502f8714462c526d369e35b603cfc34d946e3f2eda2766dfec6e0", kDefault},
    {"livox_ros_driver2/msg/CustomMsg", "livox_ros_driver2/CustomMsg",
     "RIHS01_2eb17e5e35bf5a2d6cd079f3c57f33abf95e5bf7d71b42cddc05daace73d815a", kSensor},
    {"velodyne_msgs/msg/VelodyneScan", "velodyne_msgs/VelodyneScan",
     "RIHS01_4e4edd7152e8bd604311d8b2e68e4c1b0771c8ce72700de79f6d1418aa242b3c", kDefault},
    {"ouster_sensor_msgs/msg/PacketMsg", "ouster_ros/PacketMsg",
     "RIHS01_c21822af66817068b0850f02afb1a8bba77ec79cd412a2a3aaecddc108022032", kPackets},
    {"std_msgs/msg/String", "std_msgs/String",
     "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18", kDefault},
    {"visualization_msgs/msg/MarkerArray", "visualization_msgs/MarkerArray",
     "RIHS01_86cb8800b6fb05b5eff1abd7a56f62a5641d3ae9a1c29e78e67e704f1d067dcf", kDefault},
}};

/// The package and the name of a type of ROS 2 as ROS 1 spells it: without "msg/".
bool is_name_of(const MessageType& type, std::string_view name) {
  return name == type.name || name == type.ros1_name;
}

}  // namespace

std::span<const MessageType> message_types() {
  return kMessageTypes;
}

#define GLIDAR_ROS_TYPE(Message, index)        \
  template <>                                  \
  const MessageType& message_type<Message>() { \
    return kMessageTypes[index];               \
  }

GLIDAR_ROS_TYPE(Header, 0)
GLIDAR_ROS_TYPE(PointField, 1)
GLIDAR_ROS_TYPE(PointCloud2, 2)
GLIDAR_ROS_TYPE(LaserScan, 3)
GLIDAR_ROS_TYPE(Image, 4)
GLIDAR_ROS_TYPE(CompressedImage, 5)
GLIDAR_ROS_TYPE(CameraInfo, 6)
GLIDAR_ROS_TYPE(Imu, 7)
GLIDAR_ROS_TYPE(TFMessage, 8)
GLIDAR_ROS_TYPE(PoseStamped, 9)
GLIDAR_ROS_TYPE(Clock, 10)
GLIDAR_ROS_TYPE(Odometry, 11)
GLIDAR_ROS_TYPE(CustomMsg, 12)
GLIDAR_ROS_TYPE(VelodyneScan, 13)
GLIDAR_ROS_TYPE(PacketMsg, 14)
GLIDAR_ROS_TYPE(String, 15)
GLIDAR_ROS_TYPE(MarkerArray, 16)

#undef GLIDAR_ROS_TYPE

const MessageType* find_message_type(std::string_view name) {
  if (name == "livox_ros_driver/CustomMsg" || name == "livox_ros_driver/msg/CustomMsg")
    return &message_type<CustomMsg>();
  if (name == "ouster_ros/msg/PacketMsg") return &message_type<PacketMsg>();  // of older drivers
  if (name == "tf/tfMessage") return &message_type<TFMessage>();  // of ROS 1 before Hydro
  const auto found = std::find_if(kMessageTypes.begin(), kMessageTypes.end(),
                                  [&](const MessageType& type) { return is_name_of(type, name); });
  return found == kMessageTypes.end() ? nullptr : &*found;
}

std::string definition_text(const MessageType& type) {
  const std::string separator(80, '=');
  std::vector<std::string> names = {std::string(type.ros1_name)};
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) text += fmt::format("{}\nMSG: {}\n", separator, names[i]);
    text += fields_of(names[i]);
    for (std::string& name : parts_of(names[i])) {
      if (std::find(names.begin(), names.end(), name) == names.end())
        names.push_back(std::move(name));
    }
  }
  return text;
}

std::string dds_type_name(const MessageType& type) {
  return fmt::format("{}::msg::dds_::{}_", type.name.substr(0, type.name.find('/')),
                     type.name.substr(type.name.rfind('/') + 1));
}

std::string qos_yaml(const Qos& qos) {
  // The numbers of rmw_qos_*_policy_t (rmw/types.h); the durations mean infinite.
  const auto duration = [](std::string_view name) {
    return fmt::format("  {}:\n    sec: 9223372036\n    nsec: 854775807\n", name);
  };
  return fmt::format("- history: 1\n  depth: {}\n  reliability: {}\n  durability: {}\n", qos.depth,
                     qos.reliable ? 1 : 2, qos.transient_local ? 1 : 2) +
         duration("deadline") + duration("lifespan") + "  liveliness: 1\n" +
         duration("liveliness_lease_duration") + "  avoid_ros_namespace_conventions: false";
}

}  // namespace glidar::ros
