// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/ros/rig_publisher.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/frame.hpp>
#include <glidar/core/scene.hpp>
#include <glidar/core/text.hpp>
#include <glidar/io/config/json_numbers.hpp>
#include <glidar/io/formats/box_json.hpp>
#include <glidar/io/formats/cloud_layout.hpp>
#include <glidar/io/pictures/picture.hpp>
#include <glidar/io/ros/messages.hpp>
#include <glidar/io/ros/pose_message.hpp>
#include <glidar/io/ros/sensor_topics.hpp>
#include <glidar/motion/kinematics.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <variant>

namespace glidar::ros {
namespace {

/// From one pose of the rig to the next in /tf, /odom and /clock: 100 Hz.
constexpr std::int64_t kPosePeriod_ns = 10'000'000;

/// Longer times between frames have no poses and samples.
constexpr std::int64_t kMaxGap_ns = 1'000'000'000'000;

/// Of an orientation without error, rad^2: all zeros would mean that it is not known.
constexpr double kExactVariance = 1e-9;

std::array<double, 9> same_variances(double variance) {
  return {variance, 0.0, 0.0, 0.0, variance, 0.0, 0.0, 0.0, variance};
}

/// Of the white noise of samples: N^2 times the rate (kalibr, "IMU Noise Model").
double white_variance(const InertialTriad& triad, const glidar::Imu& imu) {
  return triad.noise_density * triad.noise_density * imu.rate_hz;
}

/// The same position and heading, with z up.
Pose level_pose(const Pose& pose) {
  Pose level = Pose::Identity();
  level.translation() = pose.translation();
  const double x = pose.linear()(0, 0);
  const double y = pose.linear()(1, 0);
  const double length = std::sqrt(x * x + y * y);
  constexpr double kUpright = 1e-9;  // x points up or down: no heading
  if (length > kUpright)
    level.linear().topLeftCorner<2, 2>() << x / length, -y / length, y / length, x / length;
  return level;
}

Vector3 vector_message(const Eigen::Vector3d& v) {
  return {.x = v.x(), .y = v.y(), .z = v.z()};
}

/// The colour of a class, transparent so that points inside are visible.
ColorRGBA colour_of(std::uint32_t class_id) {
  constexpr float kFull = 255.0F;
  constexpr float kOpacity = 0.3F;
  const Colour colour = category_colour(class_id);
  return {static_cast<float>(colour.r) / kFull, static_cast<float>(colour.g) / kFull,
          static_cast<float>(colour.b) / kFull, kOpacity};
}

std::string text_of(const Scene& scene, const ObjectBox& box) {
  nlohmann::ordered_json json = box_json(scene, box, Pose::Identity());
  remove_negative_zeros(json);
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

Marker cube_of(const Scene& scene, const ObjectBox& box) {
  const Instance& instance = scene.instances.at(box.instance);
  const PoseVector pose = to_xyz_wxyz(box.sensor_from_box);
  Marker cube;
  cube.ns = printable_line(scene.class_names.at(instance.class_id));
  cube.id = static_cast<std::int32_t>(instance.id);  // ids from 2^31 become negative
  cube.type = Marker::kCube;
  cube.pose = {{pose[0], pose[1], pose[2]}, {pose[4], pose[5], pose[6], pose[3]}};
  cube.scale = {box.size_m.x(), box.size_m.y(), box.size_m.z()};
  cube.color = colour_of(instance.class_id);
  cube.text = text_of(scene, box);
  return cube;
}

/// The boxes of a frame's objects as cubes that viewers draw, in the sensor's frame. The name space
/// of a cube is the object's class, its number the object's id, and its text all that is known of
/// the box, as JSON. Throws Error for a time that ROS cannot represent.
MarkerArray box_markers(const Scene& scene, const Frame& frame, const std::string& frame_id) {
  const Header header{.stamp = time_from_ns(frame.stamp_ns), .frame_id = frame_id};
  MarkerArray markers;
  for (const ObjectBox& box : frame.boxes) {
    markers.markers.push_back(cube_of(scene, box));
    markers.markers.back().header = header;
  }
  return markers;
}

constexpr std::int64_t kForever_ns = std::numeric_limits<std::int64_t>::max();

void add_once(const std::string& name, std::vector<std::string>& columns) {
  if (std::find(columns.begin(), columns.end(), name) == columns.end()) columns.emplace_back(name);
}

Image make_image(ImageContent content, bool in_mm, const CloudSource& source,
                 const std::string& frame_id) {
  switch (content) {
    case ImageContent::depth_16uc1:
      return depth_image(source, DepthEncoding::millimetres_16uc1, frame_id);
    case ImageContent::depth_32fc1:
      return depth_image(
          source, in_mm ? DepthEncoding::millimetres_16uc1 : DepthEncoding::metres_32fc1, frame_id);
    case ImageContent::intensity_mono8:
      return intensity_image(source, IntensityEncoding::mono8, frame_id);
    case ImageContent::intensity_mono16:
      return intensity_image(source, IntensityEncoding::mono16, frame_id);
    case ImageContent::intensity_32fc1:
      return intensity_image(source, IntensityEncoding::f32c1, frame_id);
    case ImageContent::range_32fc1:
      return range_image(source, frame_id);
    case ImageContent::colour_rgb8:
      return colour_image(source, ColourEncoding::rgb8, frame_id);
    case ImageContent::colour_bgra8:
      return colour_image(source, ColourEncoding::bgra8, frame_id);
    case ImageContent::infrared_left:
      return raw_image(source, "ir_left", frame_id);
    case ImageContent::infrared_right:
      return raw_image(source, "ir_right", frame_id);
    case ImageContent::ouster_range:
      return ouster_image(source, OusterChannel::range, frame_id);
    case ImageContent::ouster_signal:
      return ouster_image(source, OusterChannel::signal, frame_id);
    case ImageContent::ouster_reflectivity:
      return ouster_image(source, OusterChannel::reflectivity, frame_id);
    case ImageContent::ouster_near_infrared:
      break;
  }
  return ouster_image(source, OusterChannel::near_infrared, frame_id);
}

}  // namespace

RigMotionPublisher::RigMotionPublisher(MessageSink& sink, const PublishedRig& rig,
                                       TransformOptions options,
                                       const std::vector<ImuTopicChoice>& imus,
                                       bool has_imu_orientation)
    : sink_(sink),
      rig_(rig),
      options_(std::move(options)),
      has_imu_orientation_(has_imu_orientation) {
  if (options_.mode != TransformMode::none) {
    const bool is_own = options_.mode == TransformMode::ground_truth;
    tf_ = sink_.add_topic(make_topic<TFMessage>("/tf"));
    odometry_ = sink_.add_topic(make_topic<Odometry>(is_own ? "/ground_truth/odom" : "/odom"));
  }
  clock_ = sink_.add_topic(make_topic<Clock>("/clock"));
  for (const ImuTopicChoice& choice : imus) {
    Topic topic = make_topic<Imu>(choice.topic);
    if (choice.format != nullptr) topic.qos = choice.format->qos;
    imus_.push_back({.topic = sink_.add_topic(topic),
                     .frame_id = choice.frame_id,
                     .format = choice.format,
                     .published_from_imu = choice.published_from_imu});
  }
}

template <class Message>
void RigMotionPublisher::write(std::size_t topic, std::int64_t time_ns, const Message& message) {
  serialize_to(message, bytes_);
  sink_.write(topic, time_ns, bytes_);
}

void RigMotionPublisher::advance(std::int64_t until_ns) {
  if (last_pose_ns_ && until_ns < reached_ns_) return write_passed_pose(until_ns);
  skip_gap(until_ns);
  write_until(until_ns);
  if (last_pose_ns_ != until_ns) write_motion_pose(until_ns);
}

void RigMotionPublisher::advance_between(std::int64_t until_ns) {
  if (last_pose_ns_ && until_ns > reached_ns_ && until_ns - reached_ns_ <= kMaxGap_ns)
    write_until(until_ns);
}

void RigMotionPublisher::write_until(std::int64_t until_ns) {
  compute_imu_samples(until_ns + 1);
  for (; next_pose_ns_ <= until_ns; next_pose_ns_ += kPosePeriod_ns) {
    write_imu_samples(next_pose_ns_);
    if (last_pose_ns_ != next_pose_ns_) write_motion_pose(next_pose_ns_);
  }
  write_imu_samples(until_ns + 1);
  reached_ns_ = until_ns;
}

/// Begins at the first frame, and again after a gap in time, such as of an edited recording.
void RigMotionPublisher::skip_gap(std::int64_t until_ns) {
  if (last_pose_ns_ && until_ns - reached_ns_ <= kMaxGap_ns) return;
  next_pose_ns_ = until_ns - (until_ns - start_ns_) % kPosePeriod_ns;
  for (ImuTopic& imu : imus_) {
    imu.computed_ns = next_pose_ns_;
    imu.samples = {};
    imu.next = 0;
  }
}

/// The pose at a time that the clock has passed. Receivers of transforms sort them by their stamps.
void RigMotionPublisher::write_passed_pose(std::int64_t t_ns) {
  const bool is_known =
      std::find(pose_times_ns_.begin(), pose_times_ns_.end(), t_ns) != pose_times_ns_.end();
  if (!is_known && reached_ns_ - t_ns <= kMaxGap_ns) write_motion_pose(t_ns);
}

void RigMotionPublisher::write_motion_pose(std::int64_t t_ns) {
  const KinematicState state = state_at(*rig_.world_from_rig, t_ns);
  const Eigen::Matrix3d rig_from_world = state.pose.linear().transpose();
  write_transform(state.pose,
                  BodyTwist{.linear_m_s = rig_from_world * state.velocity_m_s,
                            .angular_rad_s = state.angular_velocity_rad_s},
                  t_ns);
  write_clock(t_ns);
}

void RigMotionPublisher::write_frame_pose(std::size_t sensor, const Frame& frame) {
  const std::int64_t t_ns = frame.stamp_ns;
  if (last_frame_pose_ && last_frame_pose_->t_ns == t_ns && last_pose_ns_ == t_ns) return;
  const Pose pose = frame.world_from_sensor * rig_.sensors[sensor].rig_from_sensor.inverse();
  std::optional<BodyTwist> twist;
  if (last_frame_pose_ && last_frame_pose_->t_ns < t_ns) {
    constexpr double kNanosecond_s = 1e-9;
    const double seconds = kNanosecond_s * static_cast<double>(t_ns - last_frame_pose_->t_ns);
    twist = mean_twist(last_frame_pose_->world_from_rig, pose, seconds);
  }
  last_frame_pose_ = RigPose{t_ns, pose};
  last_pose_ns_.reset();  // recordings may step back
  write_transform(pose, twist, t_ns);
  write_clock(t_ns);
}

void RigMotionPublisher::write_transform(const Pose& world_from_rig,
                                         const std::optional<BodyTwist>& twist, std::int64_t t_ns) {
  if (!world_from_start_) world_from_start_ = level_pose(world_from_rig);
  if (options_.mode == TransformMode::none) return;
  const bool is_truth = options_.mode == TransformMode::ground_truth;
  const bool is_odom = options_.mode == TransformMode::odom;
  const std::string rig = options_.prefix + kRigFrame;
  const std::string fixed = is_truth  ? options_.prefix + kGroundTruthFrame
                            : is_odom ? options_.prefix + kOdometryFrame
                                      : kMapFrame;
  const Pose pose = is_odom ? Pose(world_from_start_->inverse() * world_from_rig) : world_from_rig;
  const TransformStamped transform = is_truth ? to_transform(pose.inverse(), {rig, fixed}, t_ns)
                                              : to_transform(pose, {fixed, rig}, t_ns);
  const std::int64_t time_ns = last_pose_ns_ ? std::max(t_ns, reached_ns_) : t_ns;
  write(tf_, time_ns, TFMessage{{transform}});
  write(odometry_, time_ns, to_odometry(pose, twist, {fixed, rig}, t_ns));
}

/// Remembers the pose of this time. The clock never steps back.
void RigMotionPublisher::write_clock(std::int64_t t_ns) {
  constexpr std::size_t kRemembered = 1000;
  pose_times_ns_.push_back(t_ns);
  if (pose_times_ns_.size() > kRemembered) pose_times_ns_.pop_front();
  if (last_pose_ns_ && t_ns < *last_pose_ns_) return;
  write(clock_, t_ns, to_clock(t_ns));
  last_pose_ns_ = t_ns;
}

void RigMotionPublisher::compute_imu_samples(std::int64_t until_ns) {
  for (std::size_t i = 0; i < imus_.size(); ++i) {
    ImuTopic& imu = imus_[i];
    if (until_ns <= imu.computed_ns) continue;
    imu.samples = rig_.imu_samples(i, imu.computed_ns, until_ns);
    imu.computed_ns = until_ns;
    imu.next = 0;
  }
}

/// Those of all IMUs, in the order of time.
void RigMotionPublisher::write_imu_samples(std::int64_t until_ns) {
  for (;;) {
    std::optional<std::size_t> first;
    std::int64_t first_ns = until_ns;
    for (std::size_t i = 0; i < imus_.size(); ++i) {
      const ImuTopic& imu = imus_[i];
      if (imu.next == imu.samples.t_ns.size() || imu.samples.t_ns[imu.next] >= first_ns) continue;
      first = i;
      first_ns = imu.samples.t_ns[imu.next];
    }
    if (!first) return;
    write_imu_sample(*first);
  }
}

void RigMotionPublisher::write_imu_sample(std::size_t index) {
  ImuTopic& imu = imus_[index];
  const std::size_t sample = imu.next++;
  const std::int64_t t_ns = imu.samples.t_ns[sample];
  static const ImuFormat kOwn;
  const ImuFormat& format = imu.format == nullptr ? kOwn : *imu.format;
  const glidar::Imu& errors = rig_.imus[index].imu;
  const Eigen::Matrix3d& axes = imu.published_from_imu;
  Imu message;
  message.header = {.stamp = time_from_ns(t_ns), .frame_id = imu.frame_id};
  const std::array<double, 4>& q = format.orientation_xyzw;
  message.orientation = {q[0], q[1], q[2], q[3]};
  message.orientation_covariance = format.orientation_covariance;
  if (has_imu_orientation_) {
    Pose world_from_published = imu.samples.ground_truth.world_from_imu[sample];
    world_from_published.linear() *= axes.transpose();
    const PoseVector pose = to_xyz_wxyz(world_from_published);
    message.orientation = {pose[4], pose[5], pose[6], pose[3]};
    message.orientation_covariance = same_variances(kExactVariance);
  }
  message.angular_velocity =
      vector_message(axes * imu.samples.angular_velocity_rad_s[sample] / format.rate_unit_rad_s);
  message.angular_velocity_covariance =
      same_variances(format.rate_variance.value_or(white_variance(errors.gyroscope, errors)));
  message.linear_acceleration = vector_message(axes * imu.samples.specific_force_m_s2[sample] /
                                               format.acceleration_unit_m_s2);
  message.linear_acceleration_covariance = same_variances(
      format.acceleration_variance.value_or(white_variance(errors.accelerometer, errors)));
  write(imu.topic, t_ns, message);
}

RigPublisher::RigPublisher(MessageSink& sink, PublishedRig rig, RigPublisherOptions options)
    : sink_(sink),
      rig_(std::move(rig)),
      options_(std::move(options)),
      arrivals_(rig_.sensors.size(), rig_.world_from_rig.has_value()) {
  place_camera_without_rig();
  topics_ = add_sensor_topics(sink_, rig_, options_);
  if (!rig_.world_from_rig) rig_.imus.clear();
  const std::vector<ImuTopicChoice> imus = imu_topics(rig_, topics_, options_.transforms);
  motion_.emplace(sink_, rig_, options_.transforms, imus, options_.has_imu_orientation);
  static_transforms_ = static_transforms(rig_, topics_, imus, options_.transforms);
  if (static_transforms_.transforms.empty()) return;
  Topic topic = make_topic<TFMessage>("/tf_static");
  topic.qos = kStaticTransformQos;
  static_topic_ = sink_.add_topic(topic);
}

void RigPublisher::begin(std::int64_t start_ns) {
  for (TransformStamped& transform : static_transforms_.transforms)
    transform.header.stamp = time_from_ns(start_ns);
  if (static_topic_) write_message(sink_, *static_topic_, start_ns, static_transforms_);
  for (const SensorTopics& topics : topics_) {
    if (topics.metadata) write_message(sink_, *topics.metadata, start_ns, topics.metadata_text);
  }
  motion_->begin(start_ns);
}

/// Without a rig, base_link has the axes of bodies (x forward, z up) at the camera.
void RigPublisher::place_camera_without_rig() {
  const bool is_alone = rig_.sensors.size() == 1 && rig_.sensors.front().name.empty();
  if (!is_alone || !looks_along_z(rig_.sensors.front().beams)) return;
  const Pose body_from_optical = optical_from_body().inverse();
  rig_.sensors.front().rig_from_sensor = body_from_optical;
  if (rig_.world_from_rig)
    rig_.world_from_rig = compose_extrinsic(*rig_.world_from_rig, optical_from_body());
  for (PublishedImu& imu : rig_.imus) imu.rig_from_imu = body_from_optical * imu.rig_from_imu;
}

/// Writes the messages up to a time, and the poses and samples before them.
void RigPublisher::release(std::int64_t until_ns) {
  while (std::optional<HeldMessages::Held> message = held_.release(until_ns)) {
    if (!message->topic) {
      if (rig_.world_from_rig) motion_->advance(message->time_ns);
      continue;
    }
    if (rig_.world_from_rig) motion_->advance_between(message->time_ns);
    sink_.take(*message->topic, message->time_ns, message->bytes);
    held_.give_back(std::move(message->bytes));
  }
}

bool RigPublisher::is_wanted(const std::optional<std::size_t>& topic) const {
  return topic && sink_.is_wanted(*topic);
}

std::vector<std::string> RigPublisher::cloud_columns(std::size_t sensor) const {
  const SensorTopics& topics = topics_[sensor];
  if (!topics.cloud) return {"xyz"};
  if (!topics.cloud_options.layout.empty()) {
    std::vector<std::string> columns = find_layout(topics.cloud_options.layout).columns;
    add_once("time", columns);
    return columns;
  }
  if (!topics.driver->columns.empty()) return topics.driver->columns;
  if (!options_.columns.empty()) {
    std::vector<std::string> columns = options_.columns;
    add_once("xyz", columns);
    return columns;
  }
  std::vector<std::string> columns = {"xyz", "intensity"};
  const bool is_at_once = is_camera(rig_.sensors[sensor].sensor);
  if (!is_at_once) columns.insert(columns.end(), {"ring", "time"});
  if (!is_at_once || options_.for_viewers) columns.emplace_back("range");
  if (options_.for_viewers) columns.emplace_back("true_range");
  if (rig_.sensors[sensor].sensor.doppler) columns.emplace_back("radial_velocity");
  columns.insert(columns.end(), {"instance", "class"});
  return columns;
}

std::vector<std::string> RigPublisher::columns(std::size_t sensor) const {
  std::vector<std::string> columns = cloud_columns(sensor);
  for (const ImageTopic& image : topics_[sensor].images) {
    if (is_depth(image.stream->content)) add_once("depth", columns);
    if (is_colour(image.stream->content)) add_once("colour", columns);
  }
  if (topics_[sensor].packets) {
    for (const std::string& name : packet_columns(rig_.sensors[sensor].packets->options))
      add_once(name, columns);
  }
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

const CloudMessageOptions& RigPublisher::cloud_options(std::size_t sensor) const {
  return topics_[sensor].cloud_options;
}

void RigPublisher::publish(std::size_t sensor, const Frame& frame, const Beams& beams) {
  const SensorTopics& topics = topics_[sensor];
  const CloudSource source{frame, rig_.sensors[sensor].sensor, beams};
  const FrameInterval interval = frame_interval(source.sensor, frame.number);
  const std::int64_t end_ns = frame.stamp_ns + (interval.end_ns - interval.start_ns);
  if (!end_ns_) begin(frame.stamp_ns);
  if (!arrivals_.add(sensor, frame.stamp_ns, end_ns - frame.stamp_ns)) release(kForever_ns);
  release(frame.stamp_ns);
  if (!rig_.world_from_rig) motion_->write_frame_pose(sensor, frame);
  hold_cloud(sensor, source, end_ns);
  hold_scan(topics, source, end_ns);
  hold_images(topics, source, end_ns);
  if (is_wanted(topics.boxes)) {
    hold(*topics.boxes, frame.stamp_ns, delivery_ns(frame.stamp_ns, beams, end_ns),
         box_markers(rig_.scene, frame, topics.frame_id));
  }
  if (topics.packets) topics.packets->hold(frame, beams, held_);
  release(arrivals_.complete_ns());
  end_ns_ = std::max(end_ns_.value_or(end_ns), end_ns);
}

/// When receivers get a message: when the last point of a scan is measured.
std::int64_t RigPublisher::delivery_ns(std::int64_t stamp_ns, const Beams& beams,
                                       std::int64_t end_ns) const {
  const bool is_late = options_.has_latency && rig_.world_from_rig && !beams.times_ns.empty();
  return is_late ? std::max(stamp_ns, end_ns) : stamp_ns;
}

/// Holds a message, and before it the pose at its stamp.
template <class Message>
void RigPublisher::hold(std::size_t topic, std::int64_t stamp_ns, std::int64_t time_ns,
                        const Message& message) {
  held_.hold({.time_ns = stamp_ns, .topic = std::nullopt, .bytes = {}});
  held_.hold(topic, time_ns, message);
}

void RigPublisher::hold_cloud(std::size_t sensor, const CloudSource& source, std::int64_t end_ns) {
  const SensorTopics& topics = topics_[sensor];
  const CloudMessageOptions& options = topics.cloud_options;
  const std::int64_t stamp_ns = cloud_stamp_ns(source, options);
  // poses and IMU samples start with the frame, even when the stamp of the cloud is its end
  if (options.stamp == StampRule::last_packet)
    held_.hold({.time_ns = source.frame.stamp_ns, .topic = std::nullopt, .bytes = {}});
  held_.hold({.time_ns = stamp_ns, .topic = std::nullopt, .bytes = {}});
  if (!is_wanted(topics.cloud)) return;
  OutputFrame axes = output_frame("sensor", source.beams, source.frame.world_from_sensor);
  axes.cloud_from_sensor = quarter_turned(topics.driver->quarter_turns);
  axes.deskew = options_.deskew;
  make_point_cloud(source.frame, source.beams, rig_.scene, axes, cloud_columns(sensor), cloud_);
  const std::int64_t time_ns = delivery_ns(stamp_ns, source.beams, end_ns);
  if (options.layout == kCustomMsgLayout)
    hold(*topics.cloud, stamp_ns, time_ns, to_custom_msg(cloud_, source, options));
  else
    hold(*topics.cloud, stamp_ns, time_ns, to_point_cloud2(cloud_, source, options));
}

void RigPublisher::hold_scan(const SensorTopics& topics, const CloudSource& source,
                             std::int64_t end_ns) {
  if (!is_wanted(topics.scan)) return;
  const std::int64_t stamp_ns = cloud_stamp_ns(source, topics.cloud_options);
  const std::int64_t first_ns = first_firing_ns(source.frame, source.beams);
  const std::string& frame_id = topics.frame_id;
  LaserScan scan;
  if (topics.driver->scan == ScanKind::velodyne) {
    scan = velodyne_scan(source, stamp_ns, frame_id);
  } else if (topics.driver->scan == ScanKind::ouster) {
    scan = ouster_scan(source, first_ns, frame_id);
  } else if (topics.driver->scan == ScanKind::rplidar) {
    scan = rplidar_scan(source, first_ns, frame_id);
  } else {
    scan = laser_scan(source, ring_of(source.beams, 0), frame_id,
                      layout_turns(topics.cloud_options.layout));
  }
  const std::int64_t scan_ns = to_ns(scan.header.stamp);
  hold(*topics.scan, scan_ns, delivery_ns(scan_ns, source.beams, end_ns), scan);
}

void RigPublisher::hold_images(const SensorTopics& topics, const CloudSource& source,
                               std::int64_t end_ns) {
  const std::int64_t stamp_ns = first_firing_ns(source.frame, source.beams);
  const std::int64_t time_ns = delivery_ns(stamp_ns, source.beams, end_ns);
  for (const ImageTopic& image : topics.images) {
    const ImageContent content = image.stream->content;
    if (is_wanted(image.raw)) {
      hold(*image.raw, stamp_ns, time_ns,
           make_image(content, options_.depth_in_mm, source, image.frame_id));
    }
    if (is_wanted(image.compressed)) {
      const Image whole = make_image(content, true, source, image.frame_id);
      hold(*image.compressed, stamp_ns, time_ns,
           is_depth(content) ? compressed_depth_image(whole) : png_image(whole));
    }
    if (!is_wanted(image.info)) continue;
    const bool is_right = content == ImageContent::infrared_right;
    hold(*image.info, stamp_ns, time_ns,
         ros::camera_info(source, image.info_frame_id,
                          is_right ? stereo_baseline_m(source.sensor) : 0.0));
  }
}

void RigPublisher::advance(std::int64_t now_ns) {
  const std::optional<std::int64_t> limit_ns = arrivals_.next_end_ns();
  if (!limit_ns || !rig_.world_from_rig) return;
  const std::int64_t until_ns = std::min(now_ns, *limit_ns);
  release(until_ns);
  motion_->advance_between(until_ns);
}

void RigPublisher::finish() {
  for (const SensorTopics& topics : topics_) {
    if (topics.packets) topics.packets->finish(held_);
  }
  release(kForever_ns);
  if (rig_.world_from_rig && motion_->has_begun() && end_ns_) motion_->advance(*end_ns_);
}

}  // namespace glidar::ros
