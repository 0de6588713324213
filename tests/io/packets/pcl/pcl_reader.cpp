// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Reads packets with the grabbers of PCL and writes the points of complete sweeps:
//   pcl_reader vlp16|hdl32 CAPTURE|PORT SWEEPS OUT
// CAPTURE is a file; PORT receives datagrams on the loopback interface. OUT: x y z intensity of
// every point as floats. Prints "ready" when it listens, and "timeout" when sweeps are missing.

#include <pcl/io/hdl_grabber.h>
#include <pcl/io/vlp_grabber.h>
#include <pcl/point_types.h>

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <fstream>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZI>;
using SweepCallback = void(const Cloud::ConstPtr&);

std::unique_ptr<pcl::HDLGrabber> make_grabber(bool is_vlp, const std::string& source) {
  const bool is_port = source.find_first_not_of("0123456789") == std::string::npos;
  if (!is_port && is_vlp) return std::make_unique<pcl::VLPGrabber>(source);
  if (!is_port) return std::make_unique<pcl::HDLGrabber>("", source);
  const auto loopback = boost::asio::ip::address::from_string("127.0.0.1");
  const auto port = static_cast<std::uint16_t>(std::stoul(source));
  if (is_vlp) return std::make_unique<pcl::VLPGrabber>(loopback, port);
  return std::make_unique<pcl::HDLGrabber>(loopback, port);
}

/// The first sweeps; fewer if the others do not come.
std::vector<Cloud::ConstPtr> read_sweeps(pcl::HDLGrabber& grabber, std::size_t count) {
  constexpr std::chrono::minutes kMaxWait{2};
  std::mutex mutex;
  std::condition_variable arrived;
  std::vector<Cloud::ConstPtr> sweeps;
  const std::function<SweepCallback> keep = [&](const Cloud::ConstPtr& sweep) {
    const std::lock_guard lock(mutex);
    if (sweeps.size() < count) sweeps.push_back(sweep);
    arrived.notify_one();
  };
  grabber.registerCallback(keep);
  grabber.start();
  std::puts("ready");
  std::fflush(stdout);
  {
    std::unique_lock lock(mutex);
    arrived.wait_for(lock, kMaxWait, [&] { return sweeps.size() == count; });
  }
  grabber.stop();
  return sweeps;
}

int run(const std::vector<std::string>& arguments) {
  if (arguments.size() != 4) return 2;
  const auto grabber = make_grabber(arguments[0] == "vlp16", arguments[1]);
  const std::size_t count = std::stoul(arguments[2]);
  const auto sweeps = read_sweeps(*grabber, count);
  std::ofstream file(arguments[3], std::ios::binary);
  for (const Cloud::ConstPtr& sweep : sweeps) {
    for (const pcl::PointXYZI& point : *sweep) {
      const float row[4] = {point.x, point.y, point.z, point.intensity};
      file.write(reinterpret_cast<const char*>(row), sizeof row);
    }
  }
  if (sweeps.size() < count) std::puts("timeout");
  return sweeps.size() < count ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run({argv + 1, argv + argc});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
