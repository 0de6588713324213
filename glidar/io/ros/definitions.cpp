// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/ros/definitions.hpp>

#include <array>

namespace glidar::ros {
namespace {

/// From common_interfaces, rcl_interfaces and geometry2 of ROS 2, livox_ros_driver2,
/// velodyne_msgs and ouster_sensor_msgs, without comments and default values.
struct Definition {
  std::string_view type;
  std::string_view fields;
  std::string_view ros1_fields = {};  ///< where they differ
};

constexpr std::array<Definition, 35> kDefinitions = {{
    {"builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n"},
    {"std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id\n",
     "uint32 seq\ntime stamp\nstring frame_id\n"},
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
     "uint32 binning_y\nsensor_msgs/RegionOfInterest roi\n",
     "std_msgs/Header header\nuint32 height\nuint32 width\nstring distortion_model\n"
     "float64[] D\nfloat64[9] K\nfloat64[9] R\nfloat64[12] P\nuint32 binning_x\n"
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
    {"rosgraph_msgs/Clock", "builtin_interfaces/Time clock\n", "time clock\n"},
    {"nav_msgs/Odometry",
     "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n"
     "geometry_msgs/TwistWithCovariance twist\n"},
    {"livox_ros_driver2/CustomPoint",
     "uint32 offset_time\nfloat32 x\nfloat32 y\nfloat32 z\nuint8 reflectivity\nuint8 tag\n"
     "uint8 line\n"},
    {"livox_ros_driver2/CustomMsg",
     "std_msgs/Header header\nuint64 timebase\nuint32 point_num\nuint8 lidar_id\nuint8[3] rsvd\n"
     "livox_ros_driver2/CustomPoint[] points\n"},
    {"velodyne_msgs/VelodynePacket", "builtin_interfaces/Time stamp\nuint8[1206] data\n",
     "time stamp\nuint8[1206] data\n"},
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
     "bool mesh_use_embedded_materials\n",
     "uint8 ARROW=0\n"
     "uint8 CUBE=1\n"
     "uint8 SPHERE=2\n"
     "uint8 CYLINDER=3\n"
     "uint8 LINE_STRIP=4\n"
     "uint8 LINE_LIST=5\n"
     "uint8 CUBE_LIST=6\n"
     "uint8 SPHERE_LIST=7\n"
     "uint8 POINTS=8\n"
     "uint8 TEXT_VIEW_FACING=9\n"
     "uint8 MESH_RESOURCE=10\n"
     "uint8 TRIANGLE_LIST=11\n"
     "uint8 ADD=0\n"
     "uint8 MODIFY=0\n"
     "uint8 DELETE=2\n"
     "uint8 DELETEALL=3\n"
     "std_msgs/Header header\nstring ns\nint32 id\nint32 type\nint32 action\n"
     "geometry_msgs/Pose pose\ngeometry_msgs/Vector3 scale\nstd_msgs/ColorRGBA color\n"
     "duration lifetime\nbool frame_locked\n"
     "geometry_msgs/Point[] points\nstd_msgs/ColorRGBA[] colors\n"
     "string text\nstring mesh_resource\nbool mesh_use_embedded_materials\n"},
    {"visualization_msgs/MarkerArray", "visualization_msgs/Marker[] markers\n"},
}};

}  // namespace

std::string fields_of(std::string_view type, Wire wire) {
  for (const Definition& definition : kDefinitions) {
    if (definition.type != type) continue;
    const bool differs = wire == Wire::ros1 && !definition.ros1_fields.empty();
    return std::string(differs ? definition.ros1_fields : definition.fields);
  }
  return {};
}

std::vector<std::string> parts_of(std::string_view type, Wire wire) {
  const std::string fields = fields_of(type, wire);
  std::vector<std::string> parts;
  for (std::size_t line = 0; line < fields.size(); line = fields.find('\n', line) + 1) {
    const std::string name = fields.substr(line, fields.find_first_of(" [", line) - line);
    if (name.find('/') != std::string::npos) parts.push_back(name);
  }
  return parts;
}

}  // namespace glidar::ros
