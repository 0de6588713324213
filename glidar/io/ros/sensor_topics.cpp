// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/ros/sensor_topics.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/formats/cloud_layout.hpp>
#include <glidar/io/packets/velodyne.hpp>
#include <glidar/io/ros/pose_message.hpp>

#include <algorithm>
#include <cstring>
#include <iterator>
#include <limits>
#include <span>
#include <utility>
#include <variant>

namespace glidar::ros {
namespace {

constexpr std::int64_t kAlways_ns = std::numeric_limits<std::int64_t>::max();

}  // namespace

bool FrameArrivals::add(std::size_t sensor, std::int64_t start_ns, std::int64_t duration_ns) {
  const bool is_in_order = !last_start_ns_ || start_ns >= *last_start_ns_;
  if (!is_in_order) std::fill(sensors_.begin(), sensors_.end(), SensorFrames{});
  last_start_ns_ = start_ns;
  sensors_[sensor] = {.start_ns = start_ns,
                      .next_start_ns = start_ns + duration_ns,
                      .next_end_ns = start_ns + 2 * duration_ns};
  return is_in_order;
}

std::int64_t FrameArrivals::complete_ns() const {
  if (!last_start_ns_) return std::numeric_limits<std::int64_t>::min();
  std::int64_t complete_ns = kAlways_ns;
  for (const SensorFrames& frames : sensors_) {
    const bool is_complete = is_periodic_ ? frames.start_ns.has_value()  //
                                          : frames.start_ns == last_start_ns_;
    if (!is_complete) return *last_start_ns_;
    if (is_periodic_) complete_ns = std::min(complete_ns, frames.next_start_ns);
  }
  return std::max(complete_ns, *last_start_ns_);
}

std::optional<std::int64_t> FrameArrivals::next_end_ns() const {
  std::optional<std::int64_t> end_ns;
  for (const SensorFrames& frames : sensors_) {
    if (!frames.start_ns) continue;
    end_ns = std::min(end_ns.value_or(kAlways_ns), frames.next_end_ns);
  }
  return end_ns;
}

void HeldMessages::hold(Held message) {
  const auto is_earlier = [](std::int64_t time_ns, const Held& held) {
    return time_ns < held.time_ns;
  };
  const auto place = std::upper_bound(held_.begin(), held_.end(), message.time_ns, is_earlier);
  held_.insert(place, std::move(message));
}

std::optional<HeldMessages::Held> HeldMessages::release(std::int64_t until_ns) {
  if (held_.empty() || held_.front().time_ns > until_ns) return std::nullopt;
  Held message = std::move(held_.front());
  held_.pop_front();
  return message;
}

namespace {

const PublishedPackets& packets_of(const PublishedSensor& sensor) {
  if (sensor.packets && has_packet_messages(sensor.sensor)) return *sensor.packets;
  throw Error({"packets of " + sensor.sensor.name, "no ROS driver's messages are known for them",
               "presets of Ouster and Velodyne sensors", "publish clouds only"});
}

constexpr ImageStream kViewerRange = {ImageContent::range_32fc1, "/%/range/image_raw", "%"};
constexpr ImageStream kViewerIntensity = {ImageContent::intensity_32fc1, "/%/intensity/image_raw",
                                          "%"};

bool is_scanner(const Sensor& sensor) {
  return std::holds_alternative<Spinning>(sensor.optics) ||
         std::holds_alternative<LineScan>(sensor.optics);
}

bool is_infrared(ImageContent content) {
  return content == ImageContent::infrared_left || content == ImageContent::infrared_right;
}

bool is_own(const Driver& driver) {
  return driver.name.empty();
}

std::string with_name(std::string_view text, const std::string& name) {
  std::string result(text);
  const std::size_t place = result.find('%');
  if (place != std::string::npos) result.replace(place, 1, name);
  return result;
}

std::string topic_name(const SensorTopics& topics, std::string_view name) {
  return (topics.prefix.empty() ? "" : "/" + topics.prefix) + with_name(name, topics.name);
}

std::string frame_name(const SensorTopics& topics, std::string_view name,
                       const TransformOptions& options) {
  return options.prefix + (topics.prefix.empty() ? "" : topics.prefix + "_") +
         with_name(name, topics.name);
}

/// Gives the sensors of a choice its driver.
void choose_driver(const PublishedRig& rig, const DriverChoice& choice,
                   std::vector<SensorTopics>& topics) {
  bool is_used = false;
  for (std::size_t i = 0; i < topics.size(); ++i) {
    const PublishedSensor& sensor = rig.sensors[i];
    const bool is_named = choice.sensor_name.empty() || choice.sensor_name == sensor.name;
    if (!is_named || !suits(*choice.driver, sensor.sensor, sensor.beams)) continue;
    topics[i].driver = choice.driver;
    is_used = true;
  }
  if (is_used) return;
  const bool is_any = choice.sensor_name.empty();
  throw Error({"--as " + std::string(choice.driver->name),
               is_any ? "no sensor that this driver can publish"
                      : "no such sensor '" + choice.sensor_name + "'",
               driver_sensors_text(*choice.driver), "choose another driver or sensor"});
}

std::vector<SensorTopics> named_topics(const PublishedRig& rig,
                                       const RigPublisherOptions& options) {
  std::vector<SensorTopics> all;
  for (const PublishedSensor& sensor : rig.sensors) {
    SensorTopics& topics = all.emplace_back();
    topics.driver = &own_driver(sensor.sensor);
    topics.name = sensor.name;
    if (sensor.name.empty()) topics.name = is_camera(sensor.sensor) ? "camera" : "lidar";
  }
  if (options.for_viewers) return all;
  for (const DriverChoice& choice : options.drivers) choose_driver(rig, choice, all);
  for (SensorTopics& topics : all) {
    const auto has_same = [&](const SensorTopics& other) { return other.driver == topics.driver; };
    const bool is_shared = std::count_if(all.begin(), all.end(), has_same) > 1;
    if (is_shared && !is_own(*topics.driver)) topics.prefix = topics.name;
  }
  return all;
}

/// Adds the topics of one sensor.
class TopicAdder {
 public:
  TopicAdder(MessageSink& sink, const RigPublisherOptions& options, const PublishedSensor& sensor,
             SensorTopics& topics)
      : sink_(sink), options_(options), sensor_(sensor), topics_(topics), driver_(*topics.driver) {}

  void add_all(bool has_boxes) {
    set_cloud_options();
    add_clouds();
    if (options_.for_viewers)
      add_viewer_images();
    else
      add_images();
    if (has_boxes)
      topics_.boxes = sink_.add_topic(make_topic<MarkerArray>("/" + topics_.name + "/boxes"));
    add_packets();
  }

 private:
  std::size_t add(Topic topic) {
    if (!is_own(driver_)) topic.qos = driver_.qos;
    return sink_.add_topic(topic);
  }

  void set_cloud_options() {
    const bool has_beam_frame =
        is_own(driver_) && sensor_.name.empty() && !is_camera(sensor_.sensor);
    topics_.frame_id = has_beam_frame ? options_.transforms.prefix + sensor_.beams.frame_id
                                      : frame_name(topics_, driver_.frame, options_.transforms);
    CloudMessageOptions& cloud = topics_.cloud_options;
    cloud = driver_.cloud;
    cloud.frame_id = topics_.frame_id;
    if (!options_.layout.empty()) {
      cloud.layout = options_.layout;
      cloud.offsets.clear();
    }
    const int turns = driver_.quarter_turns + layout_turns(cloud.layout);
    topics_.rig_from_published = sensor_.rig_from_sensor * quarter_turned(turns).inverse();
  }

  void add_clouds() {
    if (!driver_.cloud_topic.empty()) {
      topics_.cloud_name = topic_name(topics_, driver_.cloud_topic);
      topics_.cloud = add(topics_.cloud_options.layout == kCustomMsgLayout
                              ? make_topic<CustomMsg>(topics_.cloud_name)
                              : make_topic<PointCloud2>(topics_.cloud_name));
    }
    const bool has_ring = is_scanner(sensor_.sensor) && has_one_row();
    if (driver_.scan != ScanKind::none && (driver_.scan != ScanKind::ring || has_ring))
      topics_.scan = add(make_topic<LaserScan>(topic_name(topics_, driver_.scan_topic)));
  }

  [[nodiscard]] bool has_one_row() const { return sensor_.beams.rows == sensor_.beams.returns; }

  void add_images() {
    for (const ImageStream& stream : driver_.images) {
      if (is_infrared(stream.content) && !has_infrared(sensor_.sensor)) continue;
      if (is_colour(stream.content) && !options_.has_colour) continue;
      add_image(stream);
    }
  }

  /// Depth and intensity of cameras, range and intensity of scanners with rows.
  void add_viewer_images() {
    const bool has_pixels = is_camera(sensor_.sensor);
    const bool has_rows = is_scanner(sensor_.sensor) && !has_one_row();
    if (has_pixels) add_image(driver_.images.front());
    if (has_rows) add_image(kViewerRange);
    if (has_rows || has_pixels) add_image(kViewerIntensity);
  }

  void add_image(const ImageStream& stream) {
    const std::string name = topic_name(topics_, stream.topic);
    const TransformOptions& transforms = options_.transforms;
    ImageTopic image{.stream = &stream};
    image.frame_id =
        stream.frame == "%" ? topics_.frame_id : frame_name(topics_, stream.frame, transforms);
    image.info_frame_id = stream.info_frame.empty()
                              ? image.frame_id
                              : frame_name(topics_, stream.info_frame, transforms);
    const bool shows_depth = is_depth(stream.content);
    const bool has_png = shows_depth || stream.content == ImageContent::intensity_mono8 ||
                         stream.content == ImageContent::colour_rgb8;
    if (options_.images != ImageTransport::compressed || !has_png)
      image.raw = add(make_topic<Image>(name));
    if (options_.images != ImageTransport::raw && has_png) {
      image.compressed = add(
          make_topic<CompressedImage>(name + (shows_depth ? "/compressedDepth" : "/compressed")));
    }
    if (!stream.info_topic.empty())
      image.info = add(make_topic<CameraInfo>(topic_name(topics_, stream.info_topic)));
    topics_.images.push_back(std::move(image));
  }

  void add_packets() {
    const bool has_metadata = is_ouster(sensor_.sensor);
    std::string base = topic_name(topics_, driver_.packet_topic);
    if (is_own(driver_) && !sensor_.name.empty()) base = "/" + sensor_.name;
    if (is_own(driver_) && sensor_.name.empty() && has_metadata) base = "/ouster";
    if (sensor_.packets)
      topics_.packets = std::make_unique<PacketTopics>(sink_, sensor_, base, topics_.frame_id);
    if (!has_metadata || (!sensor_.packets && driver_.scan != ScanKind::ouster)) return;
    Topic metadata = make_topic<String>(base + "/metadata");
    metadata.qos = kStaticTransformQos;
    topics_.metadata = sink_.add_topic(metadata);
    const OusterOptions options =
        sensor_.packets ? sensor_.packets->options.ouster : OusterOptions();
    topics_.metadata_text = {ouster_metadata(sensor_.sensor, options)};
  }

  MessageSink& sink_;
  const RigPublisherOptions& options_;
  const PublishedSensor& sensor_;
  SensorTopics& topics_;
  const Driver& driver_;
};

/// The frame of a driver that is fixed to the rig, and the pose of its points in it.
struct DriverRoot {
  std::string_view frame;
  Pose root_from_points = Pose::Identity();
};

DriverRoot root_of(const Driver& driver, const Sensor& sensor) {
  DriverRoot root{driver.frame, Pose::Identity()};
  const auto parent = [&] {
    return std::find_if(driver.frames.begin(), driver.frames.end(),
                        [&](const StaticFrame& frame) { return frame.child == root.frame; });
  };
  for (auto frame = parent(); frame != driver.frames.end(); frame = parent())
    root = {frame->parent, frame->parent_from_child(sensor) * root.root_from_points};
  return root;
}

/// The transforms of a sensor, and of the IMU that its driver publishes, if any.
void append_transforms(const PublishedSensor& sensor, const SensorTopics& topics,
                       const PublishedImu* imu, const TransformOptions& options,
                       TFMessage& message) {
  const Driver& driver = *topics.driver;
  const bool is_hidden = options.mode == TransformMode::none;
  if (is_hidden && is_own(driver)) return;
  const auto add = [&](const Pose& pose, std::string parent, std::string child) {
    message.transforms.push_back(to_transform(pose, {std::move(parent), std::move(child)}, 0));
  };
  const auto named = [&](std::string_view frame) { return frame_name(topics, frame, options); };
  const DriverRoot root = root_of(driver, sensor.sensor);
  const std::string root_frame = root.frame == driver.frame ? topics.frame_id : named(root.frame);
  const Pose rig_from_root = topics.rig_from_published * root.root_from_points.inverse();
  if (!is_hidden) add(rig_from_root, options.prefix + kRigFrame, root_frame);
  for (const StaticFrame& frame : driver.frames) {
    if (frame.of_right_camera && !has_infrared(sensor.sensor)) continue;
    if (imu != nullptr && frame.child == driver.imu->frame) continue;
    add(frame.parent_from_child(sensor.sensor), named(frame.parent), named(frame.child));
  }
  if (imu == nullptr || driver.imu->frame == driver.frame) return;
  if (is_hidden && driver.frames.empty()) return;
  const Pose imu_from_published =
      driver.imu->has_optical_axes ? optical_from_body().inverse() : Pose::Identity();
  add(rig_from_root.inverse() * imu->rig_from_imu * imu_from_published, root_frame,
      named(driver.imu->frame));
}

/// The axes in which a driver publishes an IMU: its own ones, or those of the points if it has no
/// coordinate frame of its own.
Eigen::Matrix3d published_from_imu(const SensorTopics& topics, const PublishedImu& imu) {
  if (topics.driver->imu->has_optical_axes) return optical_from_body().linear();
  if (topics.driver->imu->frame != topics.driver->frame) return Eigen::Matrix3d::Identity();
  return topics.rig_from_published.linear().transpose() * imu.rig_from_imu.linear();
}

}  // namespace

PacketTopics::PacketTopics(MessageSink& sink, const PublishedSensor& sensor,
                           const std::string& base, std::string frame_id)
    : sink_(sink),
      frame_id_(std::move(frame_id)),
      packets_(sensor.sensor, packets_of(sensor).options, packets_of(sensor).imu_samples),
      is_from_ouster_(is_ouster(sensor.sensor)),
      imu_port_(sensor.packets->options.ouster.identity.imu_port) {
  if (!is_from_ouster_) {
    packets_topic_ = sink_.add_topic(make_topic<VelodyneScan>(base + "/velodyne_packets"));
    return;
  }
  packets_topic_ = sink_.add_topic(make_topic<PacketMsg>(base + "/lidar_packets"));
  imu_topic_ = sink_.add_topic(make_topic<PacketMsg>(base + "/imu_packets"));
}

void PacketTopics::hold(const Frame& frame, const Beams& beams, HeldMessages& held) {
  packets_.encode(frame, beams, made_);
  hold_packets(held);
}

void PacketTopics::finish(HeldMessages& held) {
  packets_.finish(made_);
  hold_packets(held);
}

void PacketTopics::hold_packets(HeldMessages& held) {
  if (!is_from_ouster_) return hold_scan(held);
  for (const UdpPacket& packet : made_) {
    const std::size_t topic = packet.port == imu_port_ ? imu_topic_ : packets_topic_;
    if (!sink_.is_wanted(topic)) continue;
    PacketMsg message;
    message.buf.resize(packet.payload.size());
    std::memcpy(message.buf.data(), packet.payload.data(), packet.payload.size());
    held.hold(topic, packet.stamp_ns, message);
  }
  made_.clear();
}

/// The stamp is that of the last packet: ros-drivers/velodyne, velodyne_driver.
void PacketTopics::hold_scan(HeldMessages& held) {
  VelodyneScan scan;
  scan.header.frame_id = frame_id_;
  std::int64_t last_ns = 0;
  for (const UdpPacket& packet : made_) {
    if (packet.port != kVelodynePort) continue;
    VelodynePacket stored;
    stored.stamp = time_from_ns(packet.stamp_ns);
    const std::size_t size = std::min(stored.data.size(), packet.payload.size());
    std::memcpy(stored.data.data(), packet.payload.data(), size);
    scan.packets.push_back(stored);
    last_ns = packet.stamp_ns;
  }
  made_.clear();
  if (scan.packets.empty() || !sink_.is_wanted(packets_topic_)) return;
  scan.header.stamp = time_from_ns(last_ns);
  held.hold(packets_topic_, last_ns, scan);
}

bool is_camera(const Sensor& sensor) {
  return std::holds_alternative<Pinhole>(sensor.optics);
}

bool is_depth(ImageContent content) {
  return content == ImageContent::depth_16uc1 || content == ImageContent::depth_32fc1;
}

bool is_colour(ImageContent content) {
  return content == ImageContent::colour_rgb8 || content == ImageContent::colour_bgra8;
}

std::vector<SensorTopics> add_sensor_topics(MessageSink& sink, const PublishedRig& rig,
                                            const RigPublisherOptions& options) {
  std::vector<SensorTopics> all = named_topics(rig, options);
  for (std::size_t i = 0; i < all.size(); ++i)
    TopicAdder(sink, options, rig.sensors[i], all[i]).add_all(has_classes(rig.scene));
  return all;
}

std::vector<ImuTopicChoice> imu_topics(const PublishedRig& rig,
                                       const std::vector<SensorTopics>& topics,
                                       const TransformOptions& options) {
  std::vector<ImuTopicChoice> choices;
  for (const PublishedImu& imu : rig.imus)
    choices.push_back({"/" + imu.name + "/data", options.prefix + imu.name});
  const auto publisher = std::find_if(topics.begin(), topics.end(), [](const auto& sensor) {
    return sensor.driver->imu.has_value();
  });
  if (choices.empty() || publisher == topics.end()) return choices;
  const ImuFormat& format = *publisher->driver->imu;
  choices.front() = {topic_name(*publisher, format.topic),
                     frame_name(*publisher, format.frame, options), &format,
                     static_cast<std::size_t>(std::distance(topics.begin(), publisher)),
                     published_from_imu(*publisher, rig.imus.front())};
  return choices;
}

TFMessage static_transforms(const PublishedRig& rig, const std::vector<SensorTopics>& topics,
                            const std::vector<ImuTopicChoice>& imus,
                            const TransformOptions& options) {
  TFMessage message;
  for (std::size_t i = 0; i < topics.size(); ++i) {
    const bool has_imu = !imus.empty() && imus.front().sensor == i;
    append_transforms(rig.sensors[i], topics[i], has_imu ? &rig.imus.front() : nullptr, options,
                      message);
  }
  if (options.mode == TransformMode::none) return message;
  for (std::size_t i = 0; i < imus.size(); ++i) {
    if (imus[i].sensor) continue;
    message.transforms.push_back(
        to_transform(rig.imus[i].rig_from_imu, {options.prefix + kRigFrame, imus[i].frame_id}, 0));
  }
  return message;
}

}  // namespace glidar::ros
