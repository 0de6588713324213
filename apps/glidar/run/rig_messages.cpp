// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/rig_messages.hpp>

#include <apps/glidar/run/imu_outputs.hpp>

#include <utility>

namespace glidar::app {

std::unique_ptr<ros::RigPublisher> make_rig_publisher(ros::MessageSink& sink,
                                                      const RenderFlags& flags,
                                                      const PreparedScene& prepared,
                                                      PoseOrigin origin, bool for_viewers) {
  ros::PublishedRig rig{.scene = prepared.scene, .sensors = {}};
  for (const ActiveSensor& active : prepared.sensors) {
    rig.sensors.push_back({.name = active.name,
                           .sensor = active.sensor,
                           .beams = active.beams,
                           .rig_from_sensor = active.rig_from_sensor});
  }
  if (origin == PoseOrigin::motion) {
    rig.world_from_rig = prepared.motion.world_from_rig;
    for (const RigImu& imu : prepared.imus) rig.imus.push_back({imu.name, imu.rig_from_imu});
    rig.imu_samples = imu_sampler(flags, prepared);
  }
  const OutputFlags& output = flags.output;
  return std::make_unique<ros::RigPublisher>(sink, std::move(rig),
                                             ros::RigPublisherOptions{.layout = output.sink.layout,
                                                                      .columns = output.columns,
                                                                      .deskew = output.deskew,
                                                                      .for_viewers = for_viewers});
}

}  // namespace glidar::app
