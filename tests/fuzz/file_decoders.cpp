// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "file_decoders.hpp"

#include "demand.hpp"
#include "depth_decoders.hpp"
#include "model_decoders.hpp"
#include "packet_decoders.hpp"

#include <apps/glidar/options/option_values.hpp>
#include <glidar/core/error.hpp>
#include <glidar/io/bags/bag_contents.hpp>
#include <glidar/io/bags/bag_records.hpp>
#include <glidar/io/config/imu_file.hpp>
#include <glidar/io/config/scene_file.hpp>
#include <glidar/io/config/sensor_calibration.hpp>
#include <glidar/io/config/sensor_file.hpp>
#include <glidar/io/config/sensor_keys.hpp>
#include <glidar/io/files/content_hash.hpp>
#include <glidar/io/files/unique_fd.hpp>
#include <glidar/io/formats/grey_image_file.hpp>
#include <glidar/io/formats/ouster_file.hpp>
#include <glidar/io/formats/sidecar.hpp>
#include <glidar/io/formats/tof_image_file.hpp>
#include <glidar/io/formats/trajectory_file.hpp>
#include <glidar/io/model/mesh_blob.hpp>
#include <glidar/io/model/png_texture.hpp>
#include <glidar/io/packets/ouster.hpp>
#include <glidar/io/packets/packet_frames.hpp>
#include <glidar/io/ros/cloud_message.hpp>
#include <glidar/link/recording.hpp>

#include <fcntl.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <functional>
#include <iterator>
#include <stdexcept>
#include <string>

namespace glidar::testing {
namespace {

namespace fs = std::filesystem;

void read_scene(const fs::path& file) {
  ModelOptions options;
  options.use_cache = false;
  options.time_limit_s = 5.0;
  load_scene_file(file, options, {});
}

/// The file is a cloud's sidecar.
void read_sidecar_of_cloud(const fs::path& file) {
  read_sidecar(fs::path(file).replace_filename("cloud.pcd"));
}

void read_recording(const fs::path& file) {
  link::RecordingReader reader(file);
  while (reader.next()) {
  }
}

/// Puts the right checksum into a block: a fuzzer would not find it, and stay outside what it
/// guards.
void put_checksum(const fs::path& file) {
  std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(stream)), {});
  BlockHead head;
  if (bytes.size() < sizeof head) return;
  std::memcpy(&head, bytes.data(), sizeof head);
  ContentHash hash;
  hash.add(bytes.data() + sizeof head, bytes.size() - sizeof head);
  head.hash = hash.value();
  stream.clear();
  stream.seekp(0);
  stream.write(reinterpret_cast<const char*>(&head), sizeof head);
}

/// One block: a model, a failure or a file of the cache.
void read_block(const fs::path& file) {
  put_checksum(file);
  const UniqueFd fd(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
  BlockReader block(fd.get());
  if (block.kind() == BlockKind::model) {
    read_model(block);
  } else if (block.kind() == BlockKind::failure) {
    read_failure(block);
  } else {
    read_cached_file(block);
  }
}

/// Poses and numbers as the command line takes them.
void read_pose_text(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  const std::string text((std::istreambuf_iterator<char>(in)), {});
  if (std::count(text.begin(), text.end(), ',') == 2) {
    app::parse_position(text);
  } else {
    app::parse_quaternion(text);
    app::parse_angle_axis(text);
  }
}

template <class Message>
void read_ros_message(std::span<const std::byte> bytes, ros::Wire wire) {
  const auto message = ros::deserialize<Message>(bytes, wire);
  if constexpr (requires { ros::to_point_cloud(message); }) ros::to_point_cloud(message);
}

/// The first byte selects the type of the message in the rest.
void read_ros_message(const fs::path& file, ros::Wire wire) {
  using Read = void (*)(std::span<const std::byte>, ros::Wire);
  constexpr std::array<Read, 15> kReaders = {
      read_ros_message<ros::PointCloud2>,  read_ros_message<ros::LaserScan>,
      read_ros_message<ros::CameraInfo>,   read_ros_message<ros::TFMessage>,
      read_ros_message<ros::Odometry>,     read_ros_message<ros::CustomMsg>,
      read_ros_message<ros::VelodyneScan>, read_ros_message<ros::Image>,
      read_ros_message<ros::PoseStamped>,  read_ros_message<ros::Imu>,
      read_ros_message<ros::Clock>,        read_ros_message<ros::CompressedImage>,
      read_ros_message<ros::PacketMsg>,    read_ros_message<ros::String>,
      read_ros_message<ros::MarkerArray>};
  std::ifstream in(file, std::ios::binary);
  const std::string text((std::istreambuf_iterator<char>(in)), {});
  if (text.empty()) throw Error({"message", "no type", "at least one byte"});
  const auto bytes = std::as_bytes(std::span(text));
  kReaders[std::to_integer<std::size_t>(bytes[0]) % kReaders.size()](bytes.subspan(1), wire);
}

/// What a command does with a bag, which may lack the messages for it.
void try_contents(const std::function<void()>& read) {
  try {
    read();
  } catch (const Error&) {
  }
}

void read_clouds(const fs::path& bag) {
  bags::BagClouds clouds(bags::open_bag_unconfined(bag), bag, {});
  bags::BagCloud cloud;
  while (clouds.next(cloud)) {
  }
}

void read_packet_topics(const fs::path& bag) {
  const auto packets = packets_of(bags::open_bag_unconfined(bag), bag, {});
  UdpPacket packet;
  while (packets->next(packet)) {
  }
}

/// All messages; then clouds, poses, packets and metadata, as the commands read them.
void read_bag(const fs::path& file) {
  try_contents([&] { read_clouds(file); });
  try_contents([&] { bags::read_bag_poses(*bags::open_bag_unconfined(file), file, {}); });
  try_contents([&] { read_packet_topics(file); });
  try_contents([&] { ouster_metadata_of(*bags::open_bag_unconfined(file)); });
  const auto bag = bags::open_bag_unconfined(file);
  bags::BagMessage message;
  while (bag->next(message)) {
  }
}

/// The file is what the sandboxed process sends of a bag of the same size.
void read_bag_records(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  const std::string text((std::istreambuf_iterator<char>(in)), {});
  std::span<const std::byte> left = std::as_bytes(std::span(text));
  const auto source = [&](std::span<std::byte> to) {
    const std::size_t size = std::min(to.size(), left.size());
    std::copy_n(left.begin(), size, to.begin());
    left = left.subspan(size);
    return size;
  };
  constexpr std::uint64_t kMaxPayload = std::uint64_t{1} << 30U;
  const auto bag = bags::receive_bag(
      {RecordReader(source, file.string(), kMaxPayload), [](auto) {}, text.size()});
  bags::BagMessage message;
  while (bag->next(message)) demand(message.topic < bag->topics().size(), "a topic is known");
}

/// The file is the database of a bag of ROS 2, or its metadata.
void read_rosbag2(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(in)), {});
  in.close();
  fs::remove(fs::path(file).replace_filename("run.db3"));  // of the last input
  if (bytes.starts_with("SQLite format 3")) {
    std::ofstream(fs::path(file).replace_filename("run.db3"), std::ios::binary) << bytes;
    std::ofstream(file) << "rosbag2_bagfile_information: {storage_identifier: sqlite3, "
                           "relative_file_paths: [run.db3]}\n";
  }
  read_bag(file.parent_path());
}

/// A calibration of a LiDAR, firing times of one with two channels, or else of a camera.
void read_calibration(const fs::path& file) {
  for (const std::size_t channels : {0U, 2U}) {
    Sensor lidar;
    lidar.optics.emplace<Spinning>().channels.resize(channels);
    try {
      return apply_calibration(file, lidar);
    } catch (const Error&) {  // as below
    }
  }
  Sensor camera;
  apply_calibration(file, camera);
}

constexpr std::array<FileDecoder, 34> kDecoders = {{
    {"sensor", "sensor.yaml", [](const fs::path& file) { load_sensor_file(file); }},
    {"imu", "imu.yaml", [](const fs::path& file) { load_imu_file(file); }},
    {"scene", "scene.yaml", read_scene},
    {"beam_csv", "beams.csv", [](const fs::path& file) { load_scan_csv(file); }},
    {"beam_npy", "beams.npy", [](const fs::path& file) { load_ray_npy(file); }},
    {"ouster", "metadata.json", [](const fs::path& file) { load_ouster_metadata(file); }},
    {"calibration", "calibration.yaml", read_calibration},
    {"trajectory", "poses.txt", [](const fs::path& file) { load_trajectory_file(file); }},
    {"png", "texture.png", [](const fs::path& file) { read_png_texture_unconfined(file); }},
    {"grey_png", "image.png", [](const fs::path& file) { load_grey_image_unconfined(file); }},
    {"sidecar", "cloud.glidar.json", read_sidecar_of_cloud},
    {"recording", "stream.jsonl", read_recording},
    {"mesh_blob", "a.model", read_block},
    {"pose_text", "pose.txt", read_pose_text},
    {"cdr", "message.cdr", [](const fs::path& file) { read_ros_message(file, ros::Wire::cdr); }},
    {"ros1", "message.ros1", [](const fs::path& file) { read_ros_message(file, ros::Wire::ros1); }},
    {"mcap", "run.mcap", read_bag},
    {"rosbag1", "run.bag", read_bag},
    {"rosbag2", "metadata.yaml", read_rosbag2},
    {"bag_records", "bag.records", read_bag_records},
    {"ouster_source", "metadata.json", [](const fs::path& file) { load_ouster_source(file); }},
    {"packets", "packets.bin", read_packets},
    {"pcap", "scan.pcap", read_capture},
    {"tof", "raw.bin", read_raw_tof_images},
    {"stereo", "pair.bin", read_raw_stereo_pair},
    {"tof_npy", "raw.tof.npy", [](const fs::path& file) { load_tof_images(file); }},
    {"obj", "a.obj", read_model_file},
    {"ply", "a.ply", read_model_file},
    {"stl", "a.stl", read_model_file},
    {"off", "a.off", read_model_file},
    {"mtl", "a.mtl", read_mtl_file},
    {"image", "a.image", read_image_file},
    {"collada", "a.dae", read_mended_file},
    {"package", "a.3mf", read_mended_file},
}};

/// A folder in memory, where there is one, that lasts as long as the process.
const fs::path& scratch_folder() {
  static const fs::path folder = [] {
    const fs::path base = fs::is_directory("/dev/shm") ? "/dev/shm" : fs::temp_directory_path();
    std::string name = base / "glidar-decoders-XXXXXX";
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make a folder " + name);
    static const std::string made = name;
    std::atexit([] {
      std::error_code ignored;
      fs::remove_all(made, ignored);
    });
    return fs::path(made);
  }();
  return folder;
}

}  // namespace

std::span<const FileDecoder> file_decoders() {
  return kDecoders;
}

const FileDecoder& file_decoder(std::string_view name) {
  for (const FileDecoder& decoder : kDecoders) {
    if (decoder.name == name) return decoder;
  }
  throw std::out_of_range("no decoder " + std::string(name));
}

bool try_file_decoder(const FileDecoder& decoder, std::span<const std::byte> bytes) {
  const fs::path file = scratch_folder() / decoder.file_name;
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
  try {
    decoder.read(file);
    return true;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace glidar::testing
