// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/bags/frame_bag.hpp>

#include <glidar/io/bags/bag.hpp>
#include <glidar/io/ros/rig_publisher.hpp>

#include <utility>

namespace glidar {
namespace {

ros::RigPublisherOptions publisher_options(const FrameBagOptions& options) {
  return {.layout = options.layout,
          .columns = options.columns,
          .deskew = options.deskew,
          .has_colour = false};
}

ros::PublishedRig rig_of(const Scene& scene, const Sensor& sensor, const Beams& beams) {
  ros::PublishedRig rig{.scene = scene, .sensors = {}};
  rig.sensors.push_back({.name = {}, .sensor = sensor, .beams = beams});
  return rig;
}

}  // namespace

bool is_frame_bag_name(const std::filesystem::path& path) {
  return bags::is_bag_name(path);
}

struct FrameBag::Parts {
  Parts(const std::filesystem::path& path, ros::PublishedRig rig,
        const ros::RigPublisherOptions& options)
      : bag(bags::create_bag(path)), publisher(*bag, std::move(rig), options) {}
  std::unique_ptr<bags::BagWriter> bag;
  ros::RigPublisher publisher;
};

FrameBag::FrameBag(const std::filesystem::path& path, const Scene& scene, const Sensor& sensor,
                   const Beams& beams, const FrameBagOptions& options)
    : parts_(std::make_unique<Parts>(path, rig_of(scene, sensor, beams),
                                     publisher_options(options))) {}

FrameBag::~FrameBag() = default;

void FrameBag::write(const Frame& frame, const Beams& beams) {
  parts_->publisher.publish(0, frame, beams);
}

void FrameBag::finish() {
  parts_->publisher.finish();
  parts_->bag->finish();
}

}  // namespace glidar
