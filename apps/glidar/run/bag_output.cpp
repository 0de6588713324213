// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/bag_output.hpp>

#include <apps/glidar/run/imu_outputs.hpp>
#include <glidar/io/bags/bag.hpp>
#include <glidar/io/formats/cloud_layout.hpp>
#include <glidar/io/ros/cloud_message.hpp>
#include <glidar/io/ros/image_message.hpp>
#include <glidar/io/ros/laser_scan.hpp>
#include <glidar/io/ros/pose_message.hpp>
#include <glidar/motion/kinematics.hpp>

#include <algorithm>
#include <optional>
#include <utility>

namespace glidar::app {
namespace {

/// Names of coordinate frames: REP-105.
constexpr const char* kMapFrame = "map";
constexpr const char* kRigFrame = "base_link";

/// From one pose of the rig to the next in /tf, /odom and /clock: 100 Hz.
constexpr std::int64_t kPosePeriod_ns = 10'000'000;

/// The topics of a sensor, by their number in the bag.
struct SensorTopics {
  std::string frame_id;
  std::size_t cloud = 0;
  std::optional<std::size_t> scan;         ///< of scanners with one ring
  std::optional<std::size_t> depth;        ///< of cameras
  std::optional<std::size_t> camera_info;  ///< of cameras
};

bool is_camera(const ActiveSensor& active) {
  return std::holds_alternative<Pinhole>(active.sensor.optics);
}

bool is_planar_scanner(const ActiveSensor& active) {
  const bool is_scanner = std::holds_alternative<Spinning>(active.sensor.optics) ||
                          std::holds_alternative<LineScan>(active.sensor.optics);
  return is_scanner && active.beams.rows == active.beams.returns;
}

ros::Vector3 to_vector(const Eigen::Vector3d& v) {
  return {.x = v.x(), .y = v.y(), .z = v.z()};
}

class BagOutput final : public RecordingOutput {
 public:
  BagOutput(const std::string& path, const RenderFlags& flags, const PreparedScene& prepared)
      : path_(path), flags_(flags), prepared_(prepared), bag_(bags::create_bag(path)) {
    for (const ActiveSensor& active : prepared.sensors) topics_.push_back(add_topics(active));
    tf_ = bag_->add_topic(bags::bag_topic<ros::TFMessage>("/tf"));
    odometry_ = bag_->add_topic(bags::bag_topic<ros::Odometry>("/odom"));
    clock_ = bag_->add_topic(bags::bag_topic<ros::Clock>("/clock"));
    for (const RigImu& imu : prepared.imus) {
      imus_.push_back(bag_->add_topic(bags::bag_topic<ros::Imu>("/" + imu.name + "/data")));
    }
    write_static_transforms();
  }

  [[nodiscard]] std::vector<std::string> columns(const ActiveSensor& active) const override {
    std::vector<std::string> columns = cloud_columns(active);
    if (is_camera(active)) columns.emplace_back("depth");
    return columns;
  }

  void write(const ActiveSensor& active, const Frame& frame, const Beams& beams) override {
    const SensorTopics& topics = topics_of(active);
    const ros::CloudSource source{frame, active.sensor, beams};
    OutputFrame axes = output_frame("sensor", beams, frame.world_from_sensor);
    axes.deskew = flags_.output.deskew;
    make_point_cloud(frame, beams, prepared_.scene, axes, cloud_columns(active), cloud_);
    const std::int64_t stamp_ns = ros::first_firing_ns(frame, beams);
    const ros::CloudMessageOptions options{.layout = flags_.output.sink.layout,
                                           .frame_id = topics.frame_id};
    if (has_custom_msg()) {
      add(topics.cloud, stamp_ns, ros::to_custom_msg(cloud_, source, options));
    } else {
      add(topics.cloud, stamp_ns, ros::to_point_cloud2(cloud_, source, options));
    }
    if (topics.scan) {
      add(*topics.scan, stamp_ns, ros::laser_scan(source, ring_of(beams, 0), topics.frame_id));
    }
    if (topics.depth) {
      add(*topics.depth, stamp_ns,
          ros::depth_image(source, ros::DepthEncoding::metres_32fc1, topics.frame_id));
      add(*topics.camera_info, stamp_ns, ros::camera_info(source, topics.frame_id));
    }
    end_ns_ = std::max(end_ns_, frame_interval(active.sensor, frame.number).end_ns);
  }

  void finish() override {
    write_poses();
    for (std::size_t i = 0; i < imus_.size(); ++i) write_imu(i);
    bag_->finish();
  }

  [[nodiscard]] std::vector<std::filesystem::path> files() const override { return {path_}; }

 private:
  template <class Message>
  void add(std::size_t topic, std::int64_t time_ns, const Message& message) {
    bags::write_message(*bag_, topic, time_ns, message);
  }

  [[nodiscard]] bool has_custom_msg() const {
    return flags_.output.sink.layout == ros::kCustomMsgLayout;
  }

  [[nodiscard]] std::vector<std::string> cloud_columns(const ActiveSensor& active) const {
    if (!flags_.output.sink.layout.empty()) {
      std::vector<std::string> columns = find_layout(flags_.output.sink.layout).columns;
      if (std::find(columns.begin(), columns.end(), "time") == columns.end())
        columns.emplace_back("time");
      return columns;
    }
    if (!flags_.output.columns.empty()) return flags_.output.columns;
    if (is_camera(active)) return {"xyz", "intensity", "instance", "class"};
    return {"xyz", "intensity", "ring", "time", "range", "instance", "class"};
  }

  SensorTopics add_topics(const ActiveSensor& active) {
    const std::string name =
        active.name.empty() ? (is_camera(active) ? "camera" : "lidar") : active.name;
    const std::string base = "/" + name;
    SensorTopics topics;
    topics.frame_id = active.name.empty() ? active.beams.frame_id : name;
    topics.cloud =
        bag_->add_topic(has_custom_msg() ? bags::bag_topic<ros::CustomMsg>(base + "/points")
                                         : bags::bag_topic<ros::PointCloud2>(base + "/points"));
    if (is_planar_scanner(active)) {
      topics.scan = bag_->add_topic(bags::bag_topic<ros::LaserScan>(base + "/scan"));
    }
    if (is_camera(active)) {
      topics.depth = bag_->add_topic(bags::bag_topic<ros::Image>(base + "/depth/image_raw"));
      topics.camera_info =
          bag_->add_topic(bags::bag_topic<ros::CameraInfo>(base + "/depth/camera_info"));
    }
    return topics;
  }

  [[nodiscard]] const SensorTopics& topics_of(const ActiveSensor& active) const {
    return topics_[static_cast<std::size_t>(&active - prepared_.sensors.data())];
  }

  void write_static_transforms() {
    bags::BagTopic topic = bags::bag_topic<ros::TFMessage>("/tf_static");
    topic.qos = ros::kStaticTransformQos;
    ros::TFMessage message;
    for (std::size_t i = 0; i < topics_.size(); ++i) {
      message.transforms.push_back(ros::to_transform(prepared_.sensors[i].rig_from_sensor,
                                                     {kRigFrame, topics_[i].frame_id}, 0));
    }
    for (const RigImu& imu : prepared_.imus) {
      message.transforms.push_back(ros::to_transform(imu.rig_from_imu, {kRigFrame, imu.name}, 0));
    }
    add(bag_->add_topic(topic), 0, message);
  }

  /// The ground truth of the rig, from time 0 to the end of the last frame.
  void write_poses() {
    for (std::int64_t t_ns = 0; t_ns < end_ns_ + kPosePeriod_ns; t_ns += kPosePeriod_ns) {
      const KinematicState state = state_at(prepared_.motion.world_from_rig, t_ns);
      const Eigen::Matrix3d rig_from_world = state.pose.linear().transpose();
      ros::TFMessage message;
      message.transforms.push_back(ros::to_transform(state.pose, {kMapFrame, kRigFrame}, t_ns));
      add(tf_, t_ns, message);
      add(odometry_, t_ns,
          ros::to_odometry(state.pose,
                           {.linear_m_s = rig_from_world * state.velocity_m_s,
                            .angular_rad_s = state.angular_velocity_rad_s},
                           {kMapFrame, kRigFrame}, t_ns));
      add(clock_, t_ns, ros::to_clock(t_ns));
    }
  }

  void write_imu(std::size_t index) {
    const ImuSamples samples = rig_imu_samples(flags_, prepared_, index, 0, end_ns_ + 1);
    ros::Imu message;
    message.header.frame_id = prepared_.imus[index].name;
    message.orientation_covariance[0] = -1.0;  // no orientation: sensor_msgs/Imu
    for (std::size_t i = 0; i < samples.t_ns.size(); ++i) {
      message.header.stamp = ros::time_from_ns(samples.t_ns[i]);
      message.angular_velocity = to_vector(samples.angular_velocity_rad_s[i]);
      message.linear_acceleration = to_vector(samples.specific_force_m_s2[i]);
      add(imus_[index], samples.t_ns[i], message);
    }
  }

  std::string path_;
  const RenderFlags& flags_;
  const PreparedScene& prepared_;
  std::unique_ptr<bags::BagWriter> bag_;
  std::vector<SensorTopics> topics_;  ///< per sensor
  std::vector<std::size_t> imus_;     ///< per IMU
  std::size_t tf_ = 0;
  std::size_t odometry_ = 0;
  std::size_t clock_ = 0;
  std::int64_t end_ns_ = 0;  ///< of the last frame
  PointCloud cloud_;
};

}  // namespace

std::unique_ptr<RecordingOutput> make_bag_output(const std::string& path, const RenderFlags& flags,
                                                 const PreparedScene& prepared) {
  return std::make_unique<BagOutput>(path, flags, prepared);
}

}  // namespace glidar::app
