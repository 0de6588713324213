// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/options/stream_options.hpp>
#include <apps/glidar/run/console.hpp>
#include <apps/glidar/run/interrupt.hpp>
#include <glidar/woods2016/cloud_publisher.hpp>
#include <glidar/woods2016/pose_receiver.hpp>

namespace glidar::app {

/// The peers of a stream by the protocol of 2016; nullptr: none of this kind.
struct Peers {
  woods2016::CloudPublisher* publisher = nullptr;
  woods2016::PoseReceiver* receiver = nullptr;
};

enum class PeerWaitResult {
  complete,  ///< all have shaken hands
  stopped,   ///< by a signal
  timed_out  ///< the simulator has not shaken hands within --pose-timeout
};

/// Waits for the handshakes of the simulator and of --subscribers; the console shows progress.
PeerWaitResult wait_for_peers(const Peers& peers, const StreamFlags& flags, const StopRequest& stop,
                              Console& console);

}  // namespace glidar::app
