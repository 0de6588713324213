// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/osi/osi_trace.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/text.hpp>
#include <glidar/io/formats/cloud_layout.hpp>
#include <glidar/math/elementary.hpp>
#include <glidar/motion/kinematics.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <variant>

namespace glidar {
namespace {

/// How the value of a field is encoded.
enum class WireType : std::uint8_t { varint = 0, fixed64 = 1, length_delimited = 2 };

std::uint64_t tag(std::uint32_t field, WireType type) {
  constexpr unsigned kTypeBits = 3;
  return std::uint64_t{field} << kTypeBits | static_cast<std::uint64_t>(type);
}

}  // namespace

void ProtobufMessage::varint(std::uint64_t value) {
  constexpr std::uint64_t kContinues = 0x80;
  constexpr unsigned kBits = 7;
  for (; value >= kContinues; value >>= kBits)
    bytes_ += static_cast<char>((value & (kContinues - 1)) | kContinues);
  bytes_ += static_cast<char>(value);
}

ProtobufMessage& ProtobufMessage::integer(std::uint32_t field, std::uint64_t value) {
  varint(tag(field, WireType::varint));
  varint(value);
  return *this;
}

ProtobufMessage& ProtobufMessage::integer(std::uint32_t field, std::int64_t value) {
  return integer(field, static_cast<std::uint64_t>(value));
}

ProtobufMessage& ProtobufMessage::real(std::uint32_t field, double value) {
  varint(tag(field, WireType::fixed64));
  const auto bits = std::bit_cast<std::uint64_t>(value);
  for (unsigned shift = 0; shift < 64; shift += 8)
    bytes_ += static_cast<char>(bits >> shift & 0xFF);
  return *this;
}

ProtobufMessage& ProtobufMessage::bytes(std::uint32_t field, std::string_view value) {
  varint(tag(field, WireType::length_delimited));
  varint(value.size());
  bytes_ += value;
  return *this;
}

ProtobufMessage& ProtobufMessage::text(std::uint32_t field, std::string_view value) {
  std::string valid;
  while (!value.empty()) {
    const std::size_t size = utf8_size(value);
    valid += size == 0 ? "?" : value.substr(0, size);
    value.remove_prefix(size == 0 ? 1 : size);
  }
  return bytes(field, valid);
}

ProtobufMessage& ProtobufMessage::message(std::uint32_t field, const ProtobufMessage& value) {
  return bytes(field, value.bytes());
}

}  // namespace glidar

namespace glidar::osi {
namespace {

constexpr std::uint64_t kPedestrianType = 3;
constexpr std::uint64_t kAnimalType = 4;

/// A value of an enumeration and the class that selects it.
struct NamedType {
  std::string_view class_name;
  std::uint64_t value;
};

/// MovingObject::Type of what is no vehicle.
constexpr std::array kMovingTypes = {
    NamedType{"pedestrian", kPedestrianType},
    NamedType{"person", kPedestrianType},
    NamedType{"people", kPedestrianType},
    NamedType{"human", kPedestrianType},
    NamedType{"adult", kPedestrianType},
    NamedType{"child", kPedestrianType},
    NamedType{"animal", kAnimalType},
    NamedType{"dog", kAnimalType},
    NamedType{"cat", kAnimalType},
    NamedType{"horse", kAnimalType},
    NamedType{"cow", kAnimalType},
    NamedType{"sheep", kAnimalType},
    NamedType{"deer", kAnimalType},
    NamedType{"bird", kAnimalType},
};

/// MovingObject::VehicleClassification::Type.
constexpr std::array kVehicleTypes = {
    NamedType{"vehicle", kOtherType},
    NamedType{"car", 4},
    NamedType{"small_car", 2},
    NamedType{"compact_car", 3},
    NamedType{"medium_car", 4},
    NamedType{"luxury_car", 5},
    NamedType{"van", 6},
    NamedType{"delivery_van", 6},
    NamedType{"truck", 7},
    NamedType{"heavy_truck", 7},
    NamedType{"lorry", 7},
    NamedType{"semitrailer", 8},
    NamedType{"trailer", 9},
    NamedType{"motorcycle", 10},
    NamedType{"motorbike", 10},
    NamedType{"motorcyclist", 10},
    NamedType{"bicycle", 11},
    NamedType{"bike", 11},
    NamedType{"cyclist", 11},
    NamedType{"bicyclist", 11},
    NamedType{"bus", 12},
    NamedType{"tram", 13},
    NamedType{"train", 14},
    NamedType{"wheelchair", 15},
    NamedType{"semitractor", 16},
    NamedType{"standup_scooter", 17},
    NamedType{"scooter", 17},
    NamedType{"work_machine", 19},
    NamedType{"tractor", 19},
    NamedType{"excavator", 19},
    NamedType{"watercraft", 20},
    NamedType{"boat", 20},
    NamedType{"ship", 20},
    NamedType{"aircraft", 21},
    NamedType{"airplane", 21},
    NamedType{"helicopter", 21},
};

constexpr std::array kStationaryTypes = {
    NamedType{"bridge", 2},  NamedType{"building", 3},    NamedType{"pole", 4},
    NamedType{"pylon", 5},   NamedType{"delineator", 6},  NamedType{"tree", 7},
    NamedType{"barrier", 8}, NamedType{"vegetation", 9},  NamedType{"curbstone", 10},
    NamedType{"wall", 11},   NamedType{"speed_bump", 17},
};

std::string normalised(std::string_view class_name) {
  std::string name = lower_case(class_name);
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == ' ' || c == '-'; }, '_');
  return name;
}

/// The value of a name; 0 if it is not in the table.
template <std::size_t Count>
std::uint64_t value_in(const std::array<NamedType, Count>& types, std::string_view name) {
  const auto found = std::find_if(types.begin(), types.end(), [name](const NamedType& type) {
    return type.class_name == name;
  });
  return found != types.end() ? found->value : 0;
}

}  // namespace

MovingType moving_type(std::string_view class_name) {
  const std::string name = normalised(class_name);
  if (const std::uint64_t vehicle = value_in(kVehicleTypes, name)) return {kVehicleType, vehicle};
  const std::uint64_t type = value_in(kMovingTypes, name);
  return {.type = type != 0 ? type : kOtherType};
}

std::uint64_t stationary_type(std::string_view class_name) {
  const std::uint64_t type = value_in(kStationaryTypes, normalised(class_name));
  return type != 0 ? type : kOtherType;
}

namespace {

/// -pi to pi, the same bits on every machine.
double angle_rad(double y, double x) {
  const double turns = atan2_turns(y, x);
  return 2.0 * std::numbers::pi * (turns > 0.5 ? turns - 1.0 : turns);
}

}  // namespace

ProtobufMessage interface_version() {
  constexpr std::uint64_t kMajor = 3;
  constexpr std::uint64_t kMinor = 8;
  constexpr std::uint64_t kPatch = 0;
  return ProtobufMessage().integer(1, kMajor).integer(2, kMinor).integer(3, kPatch);
}

ProtobufMessage timestamp(std::int64_t t_ns) {
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  const std::int64_t rest_ns = t_ns % kSecond_ns;
  const std::int64_t nanos = rest_ns < 0 ? rest_ns + kSecond_ns : rest_ns;
  const std::int64_t seconds = t_ns / kSecond_ns - (rest_ns < 0 ? 1 : 0);
  return ProtobufMessage().integer(1, seconds).integer(2, nanos);
}

ProtobufMessage identifier(std::uint64_t value) {
  return ProtobufMessage().integer(1, value);
}

ProtobufMessage vector3(const Eigen::Vector3d& value) {
  return ProtobufMessage().real(1, value.x()).real(2, value.y()).real(3, value.z());
}

ProtobufMessage orientation(const Eigen::Matrix3d& rotation) {
  const double cos_pitch =
      std::sqrt(rotation(0, 0) * rotation(0, 0) + rotation(1, 0) * rotation(1, 0));
  const double pitch = angle_rad(-rotation(2, 0), cos_pitch);
  // looking straight up or down, only yaw - roll or yaw + roll is defined: roll is 0 then
  constexpr double kLocked = 1e-12;
  const bool is_locked = cos_pitch < kLocked;
  const double roll = is_locked ? 0.0 : angle_rad(rotation(2, 1), rotation(2, 2));
  const double yaw = is_locked ? angle_rad(-rotation(0, 1), rotation(1, 1))
                               : angle_rad(rotation(1, 0), rotation(0, 0));
  return ProtobufMessage().real(1, roll).real(2, pitch).real(3, yaw);
}

ProtobufMessage mounting_position(const Pose& vehicle_from_sensor) {
  return ProtobufMessage()
      .message(1, vector3(vehicle_from_sensor.translation()))
      .message(2, orientation(vehicle_from_sensor.linear()));
}

ProtobufMessage spherical(const Eigen::Vector3d& point_m) {
  const double level_m = std::sqrt(point_m.x() * point_m.x() + point_m.y() * point_m.y());
  return ProtobufMessage()
      .real(1, std::sqrt(level_m * level_m + point_m.z() * point_m.z()))
      .real(2, angle_rad(point_m.y(), point_m.x()))
      .real(3, angle_rad(point_m.z(), level_m));
}

namespace {

/// The id of the rig as the host vehicle; ids of instances have 32 bits.
constexpr std::uint64_t kHostVehicleId = std::uint64_t{1} << 32U;

const std::string& class_name_of(const Scene& scene, const Instance& instance) {
  return scene.class_names.at(instance.class_id);
}

Eigen::AlignedBox3d scaled_box_m(const Scene& scene, const Instance& instance) {
  const Eigen::AlignedBox3d box = bounds(scene.meshes[instance.mesh]);
  if (box.isEmpty()) return Eigen::AlignedBox3d(Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
  return {instance.scale * box.min(), instance.scale * box.max()};
}

ProtobufMessage dimension(const Eigen::Vector3d& size_m) {
  return vector3(size_m);  // length, width and height have the numbers of x, y and z
}

/// Fields 4 and 5 of BaseMoving: the velocity and acceleration of a point fixed to a body.
void add_derivatives(const Trajectory& trajectory, std::int64_t t_ns,
                     const Eigen::Vector3d& point_m, ProtobufMessage& base) {
  Pose body_from_point = Pose::Identity();
  body_from_point.translation() = point_m;
  const KinematicState state = compose_extrinsic(state_at(trajectory, t_ns), body_from_point);
  base.message(4, vector3(state.velocity_m_s)).message(5, vector3(state.acceleration_m_s2));
}

/// ExternalReference: the object's name and class in the scene file.
ProtobufMessage source_reference(const Scene& scene, const Instance& instance) {
  return ProtobufMessage()
      .text(2, "glidar.scene")
      .text(3, printable_line(instance.name))  // texts of Protocol Buffers are UTF-8
      .text(3, printable_line(class_name_of(scene, instance)));
}

ProtobufMessage vehicle_classification(std::uint64_t type) {
  return ProtobufMessage().integer(1, type);
}

/// What the messages of one frame have in common.
struct FrameContext {
  const OsiSensor& sensor;
  const Frame& frame;
  Pose rig_from_cloud;  ///< of the sensor's axes x forward, y left, z up
  Pose world_from_rig;
};

FrameContext context_of(const OsiSensor& sensor, const Frame& frame, const OutputFrame& target) {
  return {.sensor = sensor,
          .frame = frame,
          .rig_from_cloud = sensor.rig_from_sensor * target.cloud_from_sensor.inverse(),
          .world_from_rig = frame.world_from_sensor * sensor.rig_from_sensor.inverse()};
}

template <class T>
const std::vector<T>& column_of(const PointCloud& cloud, std::string_view name) {
  return std::get<std::vector<T>>(find_column(cloud, name)->values);
}

/// The columns of a frame's detections.
struct Detections {
  const std::vector<double>& xyz_m;
  const std::vector<float>& sigma_m;
  const std::vector<double>& radial_velocities_m_s;
  const std::vector<std::uint32_t>& instances;
  const std::vector<std::uint8_t>& sources;
  const std::vector<std::uint16_t>& rings;
  std::vector<float> intensities;  ///< 0 to 1

  Detections(const PointCloud& cloud, const Sensor& sensor, const Beams& beams)
      : xyz_m(column_of<double>(cloud, "xyz")),
        sigma_m(column_of<float>(cloud, "sigma")),
        radial_velocities_m_s(column_of<double>(cloud, "radial_velocity")),
        instances(column_of<std::uint32_t>(cloud, "instance")),
        sources(column_of<std::uint8_t>(cloud, "return_source")),
        rings(column_of<std::uint16_t>(cloud, "ring")),
        intensities(unit_intensities(cloud, sensor, beams)) {}
};

/// Whether a return comes from the surface of the ground truth.
bool is_of_surface(ReturnSource source) {
  return source == ReturnSource::surface || source == ReturnSource::mixed_pixel;
}

/// LidarDetection
ProtobufMessage detection(const Detections& all, std::size_t i) {
  constexpr std::uint64_t kOther = 1;    // of DetectionClassification
  constexpr std::uint64_t kInvalid = 2;  // no surface at this place
  constexpr std::uint64_t kClutter = 3;  // noise, rain, snow, fog
  constexpr double kPercent = 100.0;
  const auto source = static_cast<ReturnSource>(all.sources[i]);
  const bool is_ghost = source == ReturnSource::ghost;
  const bool has_object = is_of_surface(source) || is_ghost;
  const double sigma_m = double{all.sigma_m[i]};
  ProtobufMessage made;
  made.real(1, 1.0)
      .message(2, identifier(has_object && all.instances[i] != kInvalidId ? all.instances[i]
                                                                          : kNoObject))
      .message(3, spherical(Eigen::Map<const Eigen::Vector3d>(&all.xyz_m[3 * i])));
  if (sigma_m > 0.0) made.message(4, ProtobufMessage().real(1, sigma_m));
  made.real(7, kPercent * double{all.intensities[i]})
      .integer(9, is_ghost                ? kInvalid
                  : is_of_surface(source) ? kOther
                                          : kClutter);
  // OSI's is positive towards the sensor.
  const double approach_m_s = 0.0 - all.radial_velocities_m_s[i];
  if (!std::isnan(approach_m_s)) made.real(12, approach_m_s);
  return made.message(13, identifier(all.rings[i]));
}

/// SensorDetectionHeader
ProtobufMessage detection_header(const FrameContext& context, std::size_t count) {
  constexpr std::uint64_t kAvailable = 2;
  constexpr std::uint64_t kNormalOperation = 2;
  return ProtobufMessage()
      .message(1, timestamp(context.frame.stamp_ns))
      .integer(2, std::uint64_t{context.frame.number})
      .message(3, mounting_position(context.rig_from_cloud))
      .integer(5, kAvailable)
      .integer(6, std::uint64_t{count})
      .message(7, identifier(context.sensor.id))
      .integer(8, kNormalOperation);
}

/// FeatureData
ProtobufMessage feature_data(const FrameContext& context, const PointCloud& cloud,
                             const Beams& beams) {
  const Detections all(cloud, context.sensor.sensor, beams);
  ProtobufMessage lidar;
  lidar.message(1, detection_header(context, cloud.size()));
  for (std::size_t i = 0; i < cloud.size(); ++i) lidar.message(2, detection(all, i));
  return ProtobufMessage().message(1, interface_version()).message(3, lidar);
}

/// SensorView: the ground truth from which the detections were made.
ProtobufMessage sensor_view(const FrameContext& context, const ProtobufMessage& ground_truth) {
  return ProtobufMessage()
      .message(1, interface_version())
      .message(2, timestamp(context.frame.stamp_ns))
      .message(3, identifier(context.sensor.id))
      .message(4, mounting_position(context.rig_from_cloud))
      .message(7, ground_truth)
      .message(8, identifier(kHostVehicleId));
}

ProtobufMessage sensor_data(const FrameContext& context, const ProtobufMessage& view,
                            const ProtobufMessage& features) {
  return ProtobufMessage()
      .message(1, interface_version())
      .message(2, timestamp(context.frame.stamp_ns))
      .message(5, identifier(context.sensor.id))
      .message(6, mounting_position(context.rig_from_cloud))
      .message(8, view)
      .message(9, timestamp(context.frame.stamp_ns))
      .message(26, features);
}

void write_message(const std::string& bytes, AtomicFile& file) {
  constexpr std::size_t kMaxBytes = std::numeric_limits<std::int32_t>::max();
  if (bytes.size() > kMaxBytes) {
    throw Error({file.path().string(), fmt::format("a frame of {} bytes", bytes.size()),
                 fmt::format("messages of up to {} bytes", kMaxBytes),
                 "measure frames with fewer beams"});
  }
  std::array<std::byte, 4> size{};
  for (std::size_t k = 0; k < size.size(); ++k)
    size[k] = static_cast<std::byte>(bytes.size() >> (8 * k) & 0xFFU);
  file.write(size);
  file.write(bytes);
}

}  // namespace

GroundTruthMessages::GroundTruthMessages(const OsiRig& rig) : rig_(rig) {
  for (const Instance& instance : rig.scene.instances)
    boxes_m_.push_back(scaled_box_m(rig.scene, instance));
}

ProtobufMessage GroundTruthMessages::at(const Frame& frame, const Pose& world_from_rig) const {
  ProtobufMessage truth;
  truth.message(1, interface_version())
      .message(2, timestamp(frame.stamp_ns))
      .message(3, identifier(kHostVehicleId));
  for (std::size_t i = 0; i < boxes_m_.size(); ++i) {
    if (!is_moving_object(i)) truth.message(4, stationary_object(i, frame));
  }
  truth.message(5, host_vehicle(frame.stamp_ns, world_from_rig));
  for (std::size_t i = 0; i < boxes_m_.size(); ++i) {
    if (is_moving_object(i)) truth.message(5, moving_object(i, frame));
  }
  return truth;
}

ProtobufMessage GroundTruthMessages::host_vehicle(std::int64_t t_ns,
                                                  const Pose& world_from_rig) const {
  ProtobufMessage base;
  base.message(1, dimension(Eigen::Vector3d::Zero()))
      .message(2, vector3(world_from_rig.translation()))
      .message(3, orientation(world_from_rig.linear()));
  if (rig_.motion)
    add_derivatives(rig_.motion->world_from_rig, t_ns, Eigen::Vector3d::Zero(), base);
  // bbcenter_to_rear: mounting positions are relative to the rear axle, here the rig's origin
  const ProtobufMessage attributes = ProtobufMessage().message(4, vector3(Eigen::Vector3d::Zero()));
  return ProtobufMessage()
      .message(1, identifier(kHostVehicleId))
      .message(2, base)
      .integer(3, kVehicleType)
      .message(5, attributes)
      .message(6, vehicle_classification(kOtherType));
}

bool GroundTruthMessages::is_moving_object(std::size_t instance) const {
  const Instance& object = rig_.scene.instances[instance];
  if (moving_type(class_name_of(rig_.scene, object)).type != kOtherType) return true;
  if (!rig_.motion) return true;  // a client may move it
  return !std::holds_alternative<ConstantPose>(rig_.motion->world_from_instance[instance]);
}

ProtobufMessage GroundTruthMessages::base(std::size_t instance,
                                          const Pose& world_from_object) const {
  const Eigen::AlignedBox3d& box = boxes_m_[instance];
  return ProtobufMessage()
      .message(1, dimension(box.sizes()))
      .message(2, vector3(world_from_object * box.center()))
      .message(3, orientation(world_from_object.linear()));
}

ProtobufMessage GroundTruthMessages::moving_object(std::size_t instance, const Frame& frame) const {
  const Instance& object = rig_.scene.instances[instance];
  ProtobufMessage base_moving = base(instance, frame.world_from_instance[instance]);
  if (rig_.motion) {
    add_derivatives(rig_.motion->world_from_instance[instance], frame.stamp_ns,
                    boxes_m_[instance].center(), base_moving);
  }
  const MovingType type = moving_type(class_name_of(rig_.scene, object));
  ProtobufMessage moving;
  moving.message(1, identifier(object.id)).message(2, base_moving).integer(3, type.type);
  if (type.type == kVehicleType) moving.message(6, vehicle_classification(type.vehicle_type));
  return moving.text(7, rig_.scene.sources[object.mesh].path)
      .message(10, source_reference(rig_.scene, object));
}

ProtobufMessage GroundTruthMessages::stationary_object(std::size_t instance,
                                                       const Frame& frame) const {
  const Instance& object = rig_.scene.instances[instance];
  const std::uint64_t type = stationary_type(class_name_of(rig_.scene, object));
  return ProtobufMessage()
      .message(1, identifier(object.id))
      .message(2, base(instance, frame.world_from_instance[instance]))
      .message(3, ProtobufMessage().integer(1, type))
      .text(4, rig_.scene.sources[object.mesh].path)
      .message(5, source_reference(rig_.scene, object));
}

bool is_osi_trace_name(const std::filesystem::path& path) {
  return lower_case(path.extension().string()) == ".osi";
}

OsiTraceWriter::OsiTraceWriter(const std::filesystem::path& path, OsiRig rig)
    : rig_(std::move(rig)), ground_truth_(rig_), file_(path) {}

const std::vector<std::string>& OsiTraceWriter::columns() {
  static const std::vector<std::string> kOsiColumns = {
      "xyz", "intensity", "range", "sigma", "radial_velocity", "instance", "return_source", "ring"};
  return kOsiColumns;
}

void OsiTraceWriter::write(std::size_t sensor_index, const Frame& frame, const Beams& beams) {
  const OutputFrame target = output_frame("ros", beams, frame.world_from_sensor);
  const FrameContext context = context_of(rig_.sensors[sensor_index], frame, target);
  make_point_cloud(frame, beams, rig_.scene, target, columns(), cloud_);
  remove_invalid_points(cloud_, detected_);
  const ProtobufMessage view =
      sensor_view(context, ground_truth_.at(frame, context.world_from_rig));
  write_message(sensor_data(context, view, feature_data(context, detected_, beams)).bytes(), file_);
}

void OsiTraceWriter::finish() {
  file_.commit();
}

}  // namespace glidar::osi
