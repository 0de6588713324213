// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/bags/bag_contents.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/text.hpp>
#include <glidar/io/ros/cloud_message.hpp>
#include <glidar/io/ros/pose_message.hpp>
#include <glidar/io/ros/published_rig.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <utility>

namespace glidar::bags {
namespace {

std::string type_names(std::span<const ros::MessageType* const> types) {
  std::vector<std::string_view> names;
  for (const ros::MessageType* type : types) names.push_back(type->ros1_name);
  return fmt::format("a topic of {}", fmt::join(names, ", "));
}

}  // namespace

const ros::MessageType* type_of(const StoredTopic& topic) {
  return topic.is_ros ? ros::find_message_type(topic.type.bytes()) : nullptr;
}

std::size_t find_topic(const BagReader& bag, const std::string& name,
                       std::span<const ros::MessageType* const> types,
                       const std::filesystem::path& path) {
  const std::span<const StoredTopic> topics = bag.topics();
  std::vector<std::string> fitting;
  for (const ros::MessageType* type : types) {
    for (std::size_t i = 0; i < topics.size(); ++i) {
      if (type_of(topics[i]) != type) continue;
      if (name.empty() || topics[i].name == name) return i;
      fitting.push_back(topics[i].name.shown(60));
    }
  }
  const std::string found =
      name.empty() ? "no topic that fits" : fmt::format("no topic '{}' that fits", excerpt(name));
  const std::string near = closest_match(name, fitting);
  if (fitting.empty()) throw Error({path.string(), found, type_names(types)});
  constexpr std::size_t kMaxListed = 20;
  fitting.resize(std::min(fitting.size(), kMaxListed));
  throw Error({path.string(), found,
               fmt::format("{}: {}", type_names(types), fmt::join(fitting, " ")),
               near.empty() ? "" : fmt::format("did you mean '{}'?", near)});
}

namespace {

template <class Message>
void convert(const BagMessage& from, ros::Wire wire, BagCloud& to) {
  const auto message = ros::deserialize<Message>(from.data, wire);
  to.stamp_ns = ros::to_ns(message.header.stamp);
  to.time_ns = from.time_ns;
  to.cloud = ros::to_point_cloud(message);
}

}  // namespace

BagClouds::BagClouds(std::unique_ptr<BagReader> bag, const std::filesystem::path& path,
                     const std::string& topic)
    : bag_(std::move(bag)) {
  const ros::MessageType* custom = &ros::message_type<ros::CustomMsg>();
  const std::array types = {&ros::message_type<ros::PointCloud2>(), custom};
  const std::size_t found = find_topic(*bag_, topic, types, path);
  topic_ = bag_->topics()[found];
  is_custom_ = type_of(topic_) == custom;
  bag_->select({&found, 1});
}

bool BagClouds::next(BagCloud& cloud) {
  BagMessage message;
  if (!bag_->next(message)) return false;
  if (is_custom_) {
    convert<ros::CustomMsg>(message, topic_.wire, cloud);
  } else {
    convert<ros::PointCloud2>(message, topic_.wire, cloud);
  }
  return true;
}

namespace {

/// As many as a trajectory file can have.
constexpr std::size_t kMaxPoses = 5'000'000;
constexpr std::size_t kMaxPairs = 1000;

struct PairPoses {
  ros::FramePair frames;
  std::vector<TimedPose> poses;
};

/// Collects the poses of each pair of frames, in the order in which the pairs appear.
class PoseCollector {
 public:
  PoseCollector(const std::filesystem::path& path, const PoseSelection& selection)
      : path_(path),
        parent_(ros::received_frame(selection.parent_frame)),
        child_(ros::received_frame(selection.child_frame)) {}

  void add(const ros::FramePair& frames, const TimedPose& pose) {
    // GLIDAR's ground truth is a child of the body: ros::TransformMode::ground_truth
    const bool is_truth =
        parent_.empty() && child_.empty() && frames.child.ends_with(ros::kGroundTruthFrame);
    if (!is_truth && fits(frames.parent, frames.child)) return put(frames, pose);
    const bool is_named = !parent_.empty() && !child_.empty();
    if (!is_truth && (!is_named || !fits(frames.child, frames.parent))) return;
    TimedPose inverse = pose;
    inverse.orientation = pose.orientation.conjugate();
    inverse.position_m = -(inverse.orientation * pose.position_m);
    put({frames.child, frames.parent}, inverse);
  }

  /// The poses of the first pair with several of different times, else of the first pair.
  std::vector<TimedPose> chosen() {
    for (PairPoses& pair : pairs_) {
      const std::int64_t first_ns = pair.poses.front().t_ns;
      if (std::any_of(pair.poses.begin(), pair.poses.end(),
                      [&](const TimedPose& pose) { return pose.t_ns != first_ns; }))
        return std::move(pair.poses);
    }
    if (!pairs_.empty()) return std::move(pairs_.front().poses);
    throw Error({path_.string(), "no pose " + wanted(), "frames: " + seen(), "name others"});
  }

 private:
  [[nodiscard]] bool fits(const std::string& parent, const std::string& child) {
    if (seen_.size() < 20) remember(parent + " > " + child);
    return (parent_.empty() || parent == parent_) && (child_.empty() || child == child_);
  }

  void remember(const std::string& pair) {
    const std::string text = excerpt(pair, 80);
    if (std::find(seen_.begin(), seen_.end(), text) == seen_.end()) seen_.push_back(text);
  }

  void put(const ros::FramePair& frames, const TimedPose& pose) {
    auto pair = std::find_if(pairs_.begin(), pairs_.end(),
                             [&](const PairPoses& known) { return known.frames == frames; });
    if (pair == pairs_.end()) {
      if (pairs_.size() == kMaxPairs)
        reject(fmt::format("more than {} pairs of frames", kMaxPairs));
      pair = pairs_.insert(pair, {frames, {}});
    }
    if (++poses_ > kMaxPoses) reject(fmt::format("more than {} poses", kMaxPoses));
    pair->poses.push_back(pose);
  }

  [[noreturn]] void reject(const std::string& found) const {
    throw Error({path_.string(), found, "fewer", "name the topic and the frames"});
  }

  [[nodiscard]] std::string wanted() const {
    return fmt::format("of {} in {}", child_.empty() ? "any frame" : child_,
                       parent_.empty() ? "any frame" : parent_);
  }
  [[nodiscard]] std::string seen() const {
    return seen_.empty() ? "none" : fmt::format("{}", fmt::join(seen_, ", "));
  }

  std::filesystem::path path_;
  std::string parent_;
  std::string child_;
  std::vector<PairPoses> pairs_;
  std::vector<std::string> seen_;  ///< for errors
  std::size_t poses_ = 0;
};

void add_message(const ros::MessageType* type, std::span<const std::byte> data, ros::Wire wire,
                 PoseCollector& collector) {
  if (type == &ros::message_type<ros::TFMessage>()) {
    for (const auto& transform : ros::deserialize<ros::TFMessage>(data, wire).transforms) {
      collector.add({ros::received_frame(transform.header.frame_id),
                     ros::received_frame(transform.child_frame_id)},
                    ros::timed_pose(transform));
    }
  } else if (type == &ros::message_type<ros::Odometry>()) {
    const auto odometry = ros::deserialize<ros::Odometry>(data, wire);
    collector.add({ros::received_frame(odometry.header.frame_id),
                   ros::received_frame(odometry.child_frame_id)},
                  ros::timed_pose(odometry));
  } else {
    const auto pose = ros::deserialize<ros::PoseStamped>(data, wire);
    collector.add({ros::received_frame(pose.header.frame_id), ""}, ros::timed_pose(pose));
  }
}

/// Without an explicit name, /tf is preferred to other transforms, which may be static.
std::size_t pose_topic(const BagReader& bag, const PoseSelection& selection,
                       const std::filesystem::path& path) {
  const ros::MessageType* transforms = &ros::message_type<ros::TFMessage>();
  const std::array types = {transforms, &ros::message_type<ros::Odometry>(),
                            &ros::message_type<ros::PoseStamped>()};
  if (!selection.topic.empty()) return find_topic(bag, selection.topic, types, path);
  const std::span<const StoredTopic> topics = bag.topics();
  for (std::size_t i = 0; i < topics.size(); ++i) {
    if (topics[i].name == "/tf" && type_of(topics[i]) == transforms) return i;
  }
  const std::array others = {types[1], types[2], types[0]};
  return find_topic(bag, "", others, path);
}

}  // namespace

std::vector<TimedPose> read_bag_poses(const std::filesystem::path& path,
                                      const PoseSelection& selection) {
  return read_bag_poses(*open_bag(path), path, selection);
}

std::vector<TimedPose> read_bag_poses(BagReader& bag, const std::filesystem::path& path,
                                      const PoseSelection& selection) {
  const std::size_t topic = pose_topic(bag, selection, path);
  const StoredTopic stored = bag.topics()[topic];
  const ros::MessageType* type = type_of(stored);
  bag.select({&topic, 1});
  PoseCollector collector(path, selection);
  BagMessage message;
  while (bag.next(message)) add_message(type, message.data, stored.wire, collector);
  std::vector<TimedPose> poses = collector.chosen();
  std::ranges::stable_sort(poses, {}, [](const TimedPose& pose) { return pose.t_ns; });
  const auto same_time = [](const TimedPose& a, const TimedPose& b) { return a.t_ns == b.t_ns; };
  poses.erase(std::unique(poses.begin(), poses.end(), same_time), poses.end());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const auto error = find_error(i == 0 ? nullptr : &poses[i - 1], poses[i]);
    if (error)
      throw Error({fmt::format("{}, topic {}, pose {}", path.string(), stored.name.shown(), i + 1),
                   error->found, error->allowed});
  }
  return poses;
}

}  // namespace glidar::bags
