// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/ros/rig_publisher.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/formats/cloud_layout.hpp>
#include <glidar/io/ros/box_message.hpp>
#include <glidar/io/ros/image_message.hpp>
#include <glidar/io/ros/laser_scan.hpp>
#include <glidar/io/ros/pose_message.hpp>

#include <algorithm>
#include <array>
#include <limits>
#include <utility>
#include <variant>

namespace glidar::ros {
namespace {

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
    for (const std::string& name : packet_columns()) add_once(name, columns);
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
  held_.hold(topic, time_ns, message, sink_.wire());
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
