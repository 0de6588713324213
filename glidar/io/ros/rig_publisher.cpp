// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/ros/rig_publisher.hpp>

#include <glidar/io/formats/cloud_layout.hpp>
#include <glidar/io/ros/box_message.hpp>
#include <glidar/io/ros/image_message.hpp>
#include <glidar/io/ros/laser_scan.hpp>
#include <glidar/io/ros/pose_message.hpp>
#include <glidar/motion/kinematics.hpp>

#include <algorithm>
#include <utility>
#include <variant>

namespace glidar::ros {
namespace {

/// Names of coordinate frames: REP-105.
constexpr const char* kMapFrame = "map";
constexpr const char* kRigFrame = "base_link";

/// From one pose of the rig to the next in /tf, /odom and /clock: 100 Hz.
constexpr std::int64_t kPosePeriod_ns = 10'000'000;

/// Longer times between frames have no poses and samples.
constexpr std::int64_t kMaxGap_ns = 1'000'000'000'000;

bool is_camera(const PublishedSensor& published) {
  return std::holds_alternative<Pinhole>(published.sensor.optics);
}

bool is_scanner(const PublishedSensor& published) {
  return std::holds_alternative<Spinning>(published.sensor.optics) ||
         std::holds_alternative<LineScan>(published.sensor.optics);
}

bool has_one_row(const PublishedSensor& published) {
  return published.beams.rows == published.beams.returns;
}

Vector3 vector_message(const Eigen::Vector3d& v) {
  return {.x = v.x(), .y = v.y(), .z = v.z()};
}

void add_once(const char* name, std::vector<std::string>& columns) {
  if (std::find(columns.begin(), columns.end(), name) == columns.end()) columns.emplace_back(name);
}

}  // namespace

RigPublisher::RigPublisher(MessageSink& sink, PublishedRig rig, RigPublisherOptions options)
    : sink_(sink), rig_(std::move(rig)), options_(std::move(options)) {
  for (const PublishedSensor& sensor : rig_.sensors) topics_.push_back(add_topics(sensor));
  tf_ = sink_.add_topic(make_topic<TFMessage>("/tf"));
  odometry_ = sink_.add_topic(make_topic<Odometry>("/odom"));
  clock_ = sink_.add_topic(make_topic<Clock>("/clock"));
  if (!rig_.world_from_rig) rig_.imus.clear();
  for (const PublishedImu& imu : rig_.imus) {
    imus_.push_back({.topic = sink_.add_topic(make_topic<Imu>("/" + imu.name + "/data"))});
  }
  write_static_transforms();
}

RigPublisher::SensorTopics RigPublisher::add_topics(const PublishedSensor& sensor) {
  const std::string name =
      sensor.name.empty() ? (is_camera(sensor) ? "camera" : "lidar") : sensor.name;
  const std::string base = "/" + name;
  SensorTopics topics{.frame_id = sensor.name.empty() ? sensor.beams.frame_id : name,
                      .cloud_name = base + "/points"};
  topics.cloud = sink_.add_topic(has_custom_msg() ? make_topic<CustomMsg>(topics.cloud_name)
                                                  : make_topic<PointCloud2>(topics.cloud_name));
  const auto add_image = [&](const char* image) {
    return sink_.add_topic(make_topic<Image>(base + image));
  };
  const bool has_rows = is_camera(sensor) || (is_scanner(sensor) && !has_one_row(sensor));
  if (is_scanner(sensor) && has_one_row(sensor)) {
    topics.scan = sink_.add_topic(make_topic<LaserScan>(base + "/scan"));
  }
  if (is_camera(sensor)) {
    topics.depth = add_image("/depth/image_raw");
    topics.camera_info = sink_.add_topic(make_topic<CameraInfo>(base + "/depth/camera_info"));
  }
  if (options_.for_viewers && is_scanner(sensor) && has_rows) {
    topics.range = add_image("/range/image_raw");
  }
  if (options_.for_viewers && has_rows) topics.intensity = add_image("/intensity/image_raw");
  if (has_classes(rig_.scene))
    topics.boxes = sink_.add_topic(make_topic<MarkerArray>(base + "/boxes"));
  return topics;
}

void RigPublisher::write_static_transforms() {
  Topic topic = make_topic<TFMessage>("/tf_static");
  topic.qos = kStaticTransformQos;
  TFMessage message;
  for (std::size_t i = 0; i < topics_.size(); ++i) {
    message.transforms.push_back(
        to_transform(rig_.sensors[i].rig_from_sensor, {kRigFrame, topics_[i].frame_id}, 0));
  }
  for (const PublishedImu& imu : rig_.imus) {
    message.transforms.push_back(to_transform(imu.rig_from_imu, {kRigFrame, imu.name}, 0));
  }
  write(sink_.add_topic(topic), 0, message);
}

template <class Message>
void RigPublisher::write(std::size_t topic, std::int64_t time_ns, const Message& message) {
  serialize_to(message, sink_.wire(), bytes_);
  sink_.write(topic, time_ns, bytes_);
}

bool RigPublisher::is_wanted(const std::optional<std::size_t>& topic) const {
  return topic && sink_.is_wanted(*topic);
}

std::vector<std::string> RigPublisher::cloud_columns(std::size_t sensor) const {
  if (!options_.layout.empty()) {
    std::vector<std::string> columns = find_layout(options_.layout).columns;
    add_once("time", columns);
    return columns;
  }
  if (!options_.columns.empty()) {
    std::vector<std::string> columns = options_.columns;
    add_once("xyz", columns);
    return columns;
  }
  std::vector<std::string> columns = {"xyz", "intensity"};
  const bool is_at_once = is_camera(rig_.sensors[sensor]);
  if (!is_at_once) columns.insert(columns.end(), {"ring", "time"});
  if (!is_at_once || options_.for_viewers) columns.emplace_back("range");
  if (options_.for_viewers) columns.emplace_back("true_range");
  columns.insert(columns.end(), {"instance", "class"});
  return columns;
}

std::vector<std::string> RigPublisher::columns(std::size_t sensor) const {
  std::vector<std::string> columns = cloud_columns(sensor);
  if (topics_[sensor].depth) add_once("depth", columns);
  return columns;
}

HitColumnMask RigPublisher::hit_columns(std::size_t sensor) const {
  HitColumnMask hit_columns = hit_columns_for(columns(sensor));
  hit_columns.boxes = topics_[sensor].boxes.has_value();
  return hit_columns;
}

const std::string& RigPublisher::cloud_topic(std::size_t sensor) const {
  return topics_[sensor].cloud_name;
}

CloudMessageOptions RigPublisher::cloud_options(std::size_t sensor) const {
  return {.layout = options_.layout, .frame_id = topics_[sensor].frame_id};
}

void RigPublisher::publish(std::size_t sensor, const Frame& frame, const Beams& beams) {
  const std::int64_t stamp_ns = first_firing_ns(frame, beams);
  if (rig_.world_from_rig) {
    advance(stamp_ns);
  } else {
    write_frame_pose(sensor, frame);
  }
  const CloudSource source{frame, rig_.sensors[sensor].sensor, beams};
  const SensorTopics& topics = topics_[sensor];
  if (is_wanted(topics.cloud)) write_cloud(sensor, source, stamp_ns);
  if (is_wanted(topics.scan)) {
    write(*topics.scan, stamp_ns, laser_scan(source, ring_of(beams, 0), topics.frame_id));
  }
  write_images(topics, source, stamp_ns);
  if (is_wanted(topics.boxes)) {
    write(*topics.boxes, stamp_ns, box_markers(rig_.scene, frame, topics.frame_id));
  }
  const FrameInterval interval = frame_interval(source.sensor, frame.number);
  end_ns_ = std::max(end_ns_, frame.stamp_ns + (interval.end_ns - interval.start_ns));
}

void RigPublisher::write_cloud(std::size_t sensor, const CloudSource& source,
                               std::int64_t stamp_ns) {
  OutputFrame axes = output_frame("sensor", source.beams, source.frame.world_from_sensor);
  axes.deskew = options_.deskew;
  make_point_cloud(source.frame, source.beams, rig_.scene, axes, cloud_columns(sensor), cloud_);
  const std::size_t topic = topics_[sensor].cloud;
  if (has_custom_msg()) {
    write(topic, stamp_ns, to_custom_msg(cloud_, source, cloud_options(sensor)));
  } else {
    write(topic, stamp_ns, to_point_cloud2(cloud_, source, cloud_options(sensor)));
  }
}

void RigPublisher::write_images(const SensorTopics& topics, const CloudSource& source,
                                std::int64_t stamp_ns) {
  const std::string& frame_id = topics.frame_id;
  if (is_wanted(topics.depth)) {
    write(*topics.depth, stamp_ns, depth_image(source, DepthEncoding::metres_32fc1, frame_id));
  }
  if (is_wanted(topics.camera_info)) {
    write(*topics.camera_info, stamp_ns, ros::camera_info(source, frame_id));
  }
  if (is_wanted(topics.range)) write(*topics.range, stamp_ns, range_image(source, frame_id));
  if (is_wanted(topics.intensity)) {
    write(*topics.intensity, stamp_ns, intensity_image(source, IntensityEncoding::f32c1, frame_id));
  }
}

void RigPublisher::finish() {
  if (rig_.world_from_rig && last_pose_ns_) advance(end_ns_);
}

/// Writes the ground truth of the rig and the samples of IMUs up to a time, and the pose at it.
void RigPublisher::advance(std::int64_t until_ns) {
  if (last_pose_ns_ && until_ns <= *last_pose_ns_) return;
  skip_gap(until_ns);
  compute_imu_samples(until_ns + 1);
  for (; next_pose_ns_ <= until_ns; next_pose_ns_ += kPosePeriod_ns) {
    for (std::size_t i = 0; i < imus_.size(); ++i) write_imu_samples(i, next_pose_ns_);
    write_motion_pose(next_pose_ns_);
  }
  for (std::size_t i = 0; i < imus_.size(); ++i) write_imu_samples(i, until_ns + 1);
  if (last_pose_ns_ != until_ns) write_motion_pose(until_ns);
}

/// Begins at the first frame, and again after a gap in time, such as of an edited recording.
void RigPublisher::skip_gap(std::int64_t until_ns) {
  if (last_pose_ns_ && until_ns - *last_pose_ns_ <= kMaxGap_ns) return;
  next_pose_ns_ = until_ns - until_ns % kPosePeriod_ns;
  for (ImuTopic& imu : imus_) {
    imu.computed_ns = next_pose_ns_;
    imu.samples = {};
    imu.next = 0;
  }
}

void RigPublisher::write_motion_pose(std::int64_t t_ns) {
  const KinematicState state = state_at(*rig_.world_from_rig, t_ns);
  const Eigen::Matrix3d rig_from_world = state.pose.linear().transpose();
  const FramePair frames{kMapFrame, kRigFrame};
  write_pose(t_ns, {.transforms = {to_transform(state.pose, frames, t_ns)}},
             to_odometry(state.pose,
                         {.linear_m_s = rig_from_world * state.velocity_m_s,
                          .angular_rad_s = state.angular_velocity_rad_s},
                         frames, t_ns));
}

/// The pose that a simulator or a client gave, with the mean velocity since the last one.
void RigPublisher::write_frame_pose(std::size_t sensor, const Frame& frame) {
  const std::int64_t t_ns = frame.stamp_ns;
  if (last_frame_pose_ && last_frame_pose_->t_ns == t_ns && last_pose_ns_ == t_ns) return;
  const Pose pose = frame.world_from_sensor * rig_.sensors[sensor].rig_from_sensor.inverse();
  BodyTwist twist;
  if (last_frame_pose_ && last_frame_pose_->t_ns < t_ns) {
    constexpr double kNanosecond_s = 1e-9;
    const double seconds = kNanosecond_s * static_cast<double>(t_ns - last_frame_pose_->t_ns);
    twist = mean_twist(last_frame_pose_->world_from_rig, pose, seconds);
  }
  last_frame_pose_ = RigPose{t_ns, pose};
  const FramePair frames{kMapFrame, kRigFrame};
  write_pose(t_ns, {.transforms = {to_transform(pose, frames, t_ns)}},
             to_odometry(pose, twist, frames, t_ns));
}

void RigPublisher::write_pose(std::int64_t t_ns, const TFMessage& transforms,
                              const Odometry& odometry) {
  write(tf_, t_ns, transforms);
  write(odometry_, t_ns, odometry);
  write(clock_, t_ns, to_clock(t_ns));
  last_pose_ns_ = t_ns;
}

void RigPublisher::compute_imu_samples(std::int64_t until_ns) {
  for (std::size_t i = 0; i < imus_.size(); ++i) {
    ImuTopic& imu = imus_[i];
    if (until_ns <= imu.computed_ns) continue;
    imu.samples = rig_.imu_samples(i, imu.computed_ns, until_ns);
    imu.computed_ns = until_ns;
    imu.next = 0;
  }
}

void RigPublisher::write_imu_samples(std::size_t index, std::int64_t until_ns) {
  ImuTopic& imu = imus_[index];
  const ImuSamples& samples = imu.samples;
  Imu message;
  message.header.frame_id = rig_.imus[index].name;
  message.orientation_covariance[0] = -1.0;  // no orientation: sensor_msgs/Imu
  for (; imu.next < samples.t_ns.size() && samples.t_ns[imu.next] < until_ns; ++imu.next) {
    const std::int64_t t_ns = samples.t_ns[imu.next];
    message.header.stamp = time_from_ns(t_ns);
    message.angular_velocity = vector_message(samples.angular_velocity_rad_s[imu.next]);
    message.linear_acceleration = vector_message(samples.specific_force_m_s2[imu.next]);
    write(imu.topic, t_ns, message);
  }
}

}  // namespace glidar::ros
