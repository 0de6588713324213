// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/ros/rig_publisher.hpp>

#include <glidar/io/formats/cloud_layout.hpp>
#include <glidar/io/ros/box_message.hpp>
#include <glidar/io/ros/image_message.hpp>
#include <glidar/io/ros/laser_scan.hpp>
#include <glidar/io/ros/pose_message.hpp>

#include <algorithm>
#include <limits>
#include <utility>
#include <variant>

namespace glidar::ros {
namespace {

constexpr std::int64_t kForever_ns = std::numeric_limits<std::int64_t>::max();

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

void add_once(const std::string& name, std::vector<std::string>& columns) {
  if (std::find(columns.begin(), columns.end(), name) == columns.end()) columns.emplace_back(name);
}

}  // namespace

RigPublisher::RigPublisher(MessageSink& sink, PublishedRig rig, RigPublisherOptions options)
    : sink_(sink),
      rig_(std::move(rig)),
      options_(std::move(options)),
      arrivals_(rig_.sensors.size(), rig_.world_from_rig.has_value()) {
  for (const PublishedSensor& sensor : rig_.sensors) topics_.push_back(add_topics(sensor));
  if (!rig_.world_from_rig) rig_.imus.clear();
  motion_.emplace(sink_, rig_);
  Topic transforms = make_topic<TFMessage>("/tf_static");
  transforms.qos = kStaticTransformQos;
  static_topic_ = sink_.add_topic(transforms);
}

RigPublisher::SensorTopics RigPublisher::add_topics(const PublishedSensor& sensor) {
  const std::string name =
      sensor.name.empty() ? (is_camera(sensor) ? "camera" : "lidar") : sensor.name;
  const std::string base = "/" + name;
  SensorTopics topics{.frame_id = sensor.name.empty() ? sensor.beams.frame_id : name,
                      .cloud_name = base + "/points"};
  topics.cloud = sink_.add_topic(has_custom_msg() ? make_topic<CustomMsg>(topics.cloud_name)
                                                  : make_topic<PointCloud2>(topics.cloud_name));
  if (is_scanner(sensor) && has_one_row(sensor)) {
    topics.scan = sink_.add_topic(make_topic<LaserScan>(base + "/scan"));
  }
  add_image_topics(sensor, base, topics);
  if (sensor.packets)
    topics.packets = std::make_unique<PacketTopics>(sink_, sensor, topics.frame_id);
  return topics;
}

void RigPublisher::add_image_topics(const PublishedSensor& sensor, const std::string& base,
                                    SensorTopics& topics) {
  const auto add_image = [&](const char* image) {
    return sink_.add_topic(make_topic<Image>(base + image));
  };
  const auto add_compressed = [&](const char* image) {
    return sink_.add_topic(make_topic<CompressedImage>(base + image));
  };
  const bool has_rows = is_camera(sensor) || (is_scanner(sensor) && !has_one_row(sensor));
  if (is_camera(sensor)) {
    if (options_.images != ImageTransport::compressed) topics.depth = add_image("/depth/image_raw");
    topics.camera_info = sink_.add_topic(make_topic<CameraInfo>(base + "/depth/camera_info"));
    if (options_.images != ImageTransport::raw) {
      topics.compressed_depth = add_compressed("/depth/image_raw/compressedDepth");
      topics.compressed_intensity = add_compressed("/intensity/image_raw/compressed");
    }
  }
  if (options_.for_viewers && is_scanner(sensor) && has_rows) {
    topics.range = add_image("/range/image_raw");
  }
  if (options_.for_viewers && has_rows) topics.intensity = add_image("/intensity/image_raw");
  if (has_classes(rig_.scene))
    topics.boxes = sink_.add_topic(make_topic<MarkerArray>(base + "/boxes"));
}

void RigPublisher::begin(std::int64_t start_ns) {
  write_static_transforms(start_ns);
  for (const SensorTopics& topics : topics_) {
    if (topics.packets) topics.packets->write_metadata(start_ns);
  }
  motion_->begin(start_ns);
}

void RigPublisher::write_static_transforms(std::int64_t t_ns) {
  TFMessage message;
  for (std::size_t i = 0; i < topics_.size(); ++i) {
    message.transforms.push_back(
        to_transform(rig_.sensors[i].rig_from_sensor, {kRigFrame, topics_[i].frame_id}, t_ns));
  }
  for (const PublishedImu& imu : rig_.imus) {
    message.transforms.push_back(to_transform(imu.rig_from_imu, {kRigFrame, imu.name}, t_ns));
  }
  write_message(sink_, static_topic_, t_ns, message);
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
  if (rig_.sensors[sensor].sensor.doppler) columns.emplace_back("radial_velocity");
  columns.insert(columns.end(), {"instance", "class"});
  return columns;
}

std::vector<std::string> RigPublisher::columns(std::size_t sensor) const {
  std::vector<std::string> columns = cloud_columns(sensor);
  if (topics_[sensor].depth || topics_[sensor].compressed_depth) add_once("depth", columns);
  if (topics_[sensor].compressed_intensity) add_once("intensity", columns);
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

CloudMessageOptions RigPublisher::cloud_options(std::size_t sensor) const {
  return {.layout = options_.layout, .frame_id = topics_[sensor].frame_id};
}

void RigPublisher::publish(std::size_t sensor, const Frame& frame, const Beams& beams) {
  const CloudSource source{frame, rig_.sensors[sensor].sensor, beams};
  const std::int64_t stamp_ns = first_firing_ns(frame, beams);
  const FrameInterval interval = frame_interval(source.sensor, frame.number);
  const std::int64_t duration_ns = interval.end_ns - interval.start_ns;
  if (!end_ns_) begin(frame.stamp_ns);
  if (!arrivals_.add(sensor, frame.stamp_ns, duration_ns, stamp_ns + duration_ns)) {
    release(kForever_ns);
  }
  release(frame.stamp_ns);
  if (!rig_.world_from_rig) motion_->write_frame_pose(sensor, frame);
  held_.hold({.time_ns = stamp_ns, .topic = std::nullopt, .bytes = {}});  // a pose
  hold_cloud(sensor, source, stamp_ns);
  hold_images(topics_[sensor], source, stamp_ns);
  hold_compressed_images(topics_[sensor], source, stamp_ns);
  if (is_wanted(topics_[sensor].boxes)) {
    held_.hold(*topics_[sensor].boxes, stamp_ns,
               box_markers(rig_.scene, frame, topics_[sensor].frame_id), sink_.wire());
  }
  if (topics_[sensor].packets) topics_[sensor].packets->hold(frame, beams, held_);
  release(arrivals_.complete_ns());
  end_ns_ = std::max(end_ns_.value_or(frame.stamp_ns), frame.stamp_ns + duration_ns);
}

void RigPublisher::hold_cloud(std::size_t sensor, const CloudSource& source,
                              std::int64_t stamp_ns) {
  const SensorTopics& topics = topics_[sensor];
  if (is_wanted(topics.scan)) {
    held_.hold(*topics.scan, stamp_ns,
               laser_scan(source, ring_of(source.beams, 0), topics.frame_id), sink_.wire());
  }
  if (!is_wanted(topics.cloud)) return;
  OutputFrame axes = output_frame("sensor", source.beams, source.frame.world_from_sensor);
  axes.deskew = options_.deskew;
  make_point_cloud(source.frame, source.beams, rig_.scene, axes, cloud_columns(sensor), cloud_);
  if (has_custom_msg()) {
    held_.hold(topics.cloud, stamp_ns, to_custom_msg(cloud_, source, cloud_options(sensor)),
               sink_.wire());
  } else {
    held_.hold(topics.cloud, stamp_ns, to_point_cloud2(cloud_, source, cloud_options(sensor)),
               sink_.wire());
  }
}

void RigPublisher::hold_images(const SensorTopics& topics, const CloudSource& source,
                               std::int64_t stamp_ns) {
  const std::string& frame_id = topics.frame_id;
  if (is_wanted(topics.depth)) {
    held_.hold(*topics.depth, stamp_ns, depth_image(source, DepthEncoding::metres_32fc1, frame_id),
               sink_.wire());
  }
  if (is_wanted(topics.camera_info)) {
    held_.hold(*topics.camera_info, stamp_ns, ros::camera_info(source, frame_id), sink_.wire());
  }
  if (is_wanted(topics.range))
    held_.hold(*topics.range, stamp_ns, range_image(source, frame_id), sink_.wire());
  if (is_wanted(topics.intensity)) {
    held_.hold(*topics.intensity, stamp_ns,
               intensity_image(source, IntensityEncoding::f32c1, frame_id), sink_.wire());
  }
}

void RigPublisher::hold_compressed_images(const SensorTopics& topics, const CloudSource& source,
                                          std::int64_t stamp_ns) {
  if (is_wanted(topics.compressed_depth)) {
    const Image depth = depth_image(source, DepthEncoding::millimetres_16uc1, topics.frame_id);
    held_.hold(*topics.compressed_depth, stamp_ns, compressed_depth_image(depth), sink_.wire());
  }
  if (is_wanted(topics.compressed_intensity)) {
    const Image intensity = intensity_image(source, IntensityEncoding::mono8, topics.frame_id);
    held_.hold(*topics.compressed_intensity, stamp_ns, png_image(intensity), sink_.wire());
  }
}

void RigPublisher::advance(std::int64_t now_ns) {
  const std::optional<std::int64_t> limit_ns = arrivals_.next_end_ns();
  if (!limit_ns || !rig_.world_from_rig) return;
  const std::int64_t until_ns = std::min(now_ns, *limit_ns);
  for (const std::int64_t firing_ns : arrivals_.next_firings_ns()) {
    if (firing_ns <= until_ns) motion_->advance(firing_ns);
  }
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
