// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/ros/message_types.hpp>

#include <glidar/io/ros/definitions.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace glidar::ros {
namespace {

constexpr Qos kSensor = {.depth = 5};
constexpr Qos kDefault = {};
constexpr Qos kPackets = {.depth = 100};  // a revolution

/// In the order of Index. The type hashes and MD5 sums are computed from the definitions by
/// independent programs in the tests.
constexpr std::array<MessageType, 17> kMessageTypes = {{
    {"std_msgs/msg/Header", "std_msgs/Header", "2176decaecbce78abc3b96ef049fabed",
     "RIHS01_f49fb3ae2cf070f793645ff749683ac6b06203e41c891e17701b1cb597ce6a01", kDefault},
    {"sensor_msgs/msg/PointField", "sensor_msgs/PointField", "268eacb2962780ceac86cbd17e328150",
     "RIHS01_5c6a4750728c2bcfbbf7037225b20b02d4429634732146b742dee1726637ef01", kDefault},
    {"sensor_msgs/msg/PointCloud2", "sensor_msgs/PointCloud2", "1158d486dd51d683ce2f1be655c3c181",
     "RIHS01_9198cabf7da3796ae6fe19c4cb3bdd3525492988c70522628af5daa124bae2b5", kSensor},
    {"sensor_msgs/msg/LaserScan", "sensor_msgs/LaserScan", "90c7ef2dc6895d81024acba2ac42f369",
     "RIHS01_64c191398013af96509d518dac71d5164f9382553fce5c1f8cca5be7924bd828", kSensor},
    {"sensor_msgs/msg/Image", "sensor_msgs/Image", "060021388200f6f0f447d0fcd9c64743",
     "RIHS01_d31d41a9a4c4bc8eae9be757b0beed306564f7526c88ea6a4588fb9582527d47", kSensor},
    {"sensor_msgs/msg/CompressedImage", "sensor_msgs/CompressedImage",
     "8f7a12909da2c9d3332d540a0977563f",
     "RIHS01_15640771531571185e2efc8a100baf923961a4d15d5569652e6cb6691e8e371a", kSensor},
    {"sensor_msgs/msg/CameraInfo", "sensor_msgs/CameraInfo", "c9a58c1b0b154e0e6da7578cb991d214",
     "RIHS01_b3dfd68ff46c9d56c80fd3bd4ed22c7a4ddce8c8348f2f59c299e73118e7e275", kSensor},
    {"sensor_msgs/msg/Imu",
     "sensor_msgs/Imu",
     "6a62c6daae103f4ff57a132d6f95cec2",
     "RIHS01_7d9a00ff131080897a5ec7e26e315954b8eae3353c3f995c55faf71574000b5b",
     {.depth = 200}},
    {"tf2_msgs/msg/TFMessage",
     "tf2_msgs/TFMessage",
     "94810edda583a504dfda3829e70d7eec",
     "RIHS01_e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087",
     {.depth = 100}},
    {"geometry_msgs/msg/PoseStamped", "geometry_msgs/PoseStamped",
     "d3812c3cbc69362b77dc0b19b345f8f5",
     "RIHS01_10f3786d7d40fd2b54367835614bff85d4ad3b5dab62bf8bca0cc232d73b4cd8", kDefault},
    {"rosgraph_msgs/msg/Clock",
     "rosgraph_msgs/Clock",
     "a9c97c1d230cfc112e270351a944ee47",
     "RIHS01_692f7a66e93a3c83e71765d033b60349ba68023a8c689a79e48078bcb5c58564",
     {.depth = 1}},
    {"nav_msgs/msg/Odometry", "nav_msgs/Odometry", "cd5e73d190d741a2f92e81eda573aca7",
     "RIHS01_3cc97dc7fb7502f8714462c526d369e35b603cfc34d946e3f2eda2766dfec6e0", kDefault},
    {"livox_ros_driver2/msg/CustomMsg", "livox_ros_driver2/CustomMsg",
     "e4d6829bdfe657cb6c21a746c86b21a6",
     "RIHS01_2eb17e5e35bf5a2d6cd079f3c57f33abf95e5bf7d71b42cddc05daace73d815a", kSensor},
    {"velodyne_msgs/msg/VelodyneScan", "velodyne_msgs/VelodyneScan",
     "50804fc9533a0e579e6322c04ae70566",
     "RIHS01_4e4edd7152e8bd604311d8b2e68e4c1b0771c8ce72700de79f6d1418aa242b3c", kDefault},
    {"ouster_sensor_msgs/msg/PacketMsg", "ouster_ros/PacketMsg", "4f7b5949e76f86d01e96b0e33ba9b5e3",
     "RIHS01_c21822af66817068b0850f02afb1a8bba77ec79cd412a2a3aaecddc108022032", kPackets},
    {"std_msgs/msg/String", "std_msgs/String", "992ce8a1687cec8c8bd883ec73ca41d1",
     "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18", kDefault},
    {"visualization_msgs/msg/MarkerArray", "visualization_msgs/MarkerArray",
     "d155b9ce5188fbaf89745847fd5882d7",
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

std::string definition_text(const MessageType& type, Wire wire) {
  const std::string separator(80, '=');
  std::vector<std::string> names = {std::string(type.ros1_name)};
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) text += fmt::format("{}\nMSG: {}\n", separator, names[i]);
    text += fields_of(names[i], wire);
    for (std::string& name : parts_of(names[i], wire)) {
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
