// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/packet_setup.hpp>

#include <apps/glidar/run/imu_outputs.hpp>

namespace glidar::app {

ros::PublishedPackets packet_setup(const RenderFlags& flags, const PreparedScene& prepared,
                                   PoseOrigin origin, const ActiveSensor& active) {
  ros::PublishedPackets setup;
  setup.options.ouster.profile = flags.output.ouster_profile;
  if (flags.output.livox_type) setup.options.livox_type = *flags.output.livox_type;
  if (origin != PoseOrigin::motion || prepared.imus.empty()) return setup;
  setup.options.ouster.sensor_from_imu =
      active.rig_from_sensor.inverse() * prepared.imus.front().rig_from_imu;
  setup.imu_samples = [sample = imu_sampler(flags, prepared)](std::int64_t from_ns,
                                                              std::int64_t until_ns) {
    return sample(0, from_ns, until_ns);
  };
  return setup;
}

}  // namespace glidar::app
