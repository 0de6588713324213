// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Runs the fuzzers' corpora, in every build.
#include "fuzz/file_decoders.hpp"

#include <support/source_folder.hpp>

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <string>

namespace glidar {
namespace {

/// The valid files of a reader's corpus.
std::set<std::string> taken(const testing::FileDecoder& decoder, std::size_t& files) {
  std::set<std::string> names;
  const auto folder = std::filesystem::path(kCorpusFolder) / std::string(decoder.name);
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    std::ifstream file(entry.path(), std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(file)), {});
    ++files;
    if (testing::try_file_decoder(decoder, std::as_bytes(std::span(bytes)))) {
      names.insert(entry.path().filename().string());
    }
  }
  return names;
}

TEST(FileCorpus, EveryFileIsReadOrRefusedWithAnError) {
  const std::map<std::string_view, std::set<std::string>> expected = {
      {"sensor", {"pinhole", "fisheye", "spinning", "raster", "prism", "alias"}},
      {"imu", {"bmi088"}},
      {"scene", {"models", "rig"}},
      {"beam_csv", {"plain", "livox"}},
      {"beam_npy", {"rays", "floats"}},
      {"ouster", {"plain", "window"}},
      {"calibration", {"velodyne", "angles", "version", "times", "loops", "kalibr", "ros"}},
      {"trajectory", {"tum", "csv"}},
      {"png", {"RGB", "RGBA", "L", "LA", "P", "I16"}},
      {"grey_png", {"RGB", "RGBA", "L", "LA", "P", "I16"}},
      {"sidecar", {"camera"}},
      {"recording", {"two_frames"}},
      {"mesh_blob", {"triangle", "textured", "failure", "cached"}},
      {"pose_text", {"position", "quaternion"}},
      {"cdr", {"cloud", "transforms", "scan"}},
      {"ros1", {"cloud", "transforms", "scan"}},
      {"mcap", {"chunk", "plain", "lz4", "cloud_and_poses", "velodyne_packets", "ouster_packets"}},
      {"rosbag1", {"chunk", "lz4"}},
      {"rosbag2", {"database"}},
      {"bag_records", {"two_messages"}},
      {"ouster_source", {"plain"}},
      {"packets",
       {"vlp16", "vlp16_dual", "hdl32", "xt32", "qt64", "pandar64_dual", "ouster", "ouster_dual",
        "vlp32c", "vlp32c_dual", "hdl64", "vls128", "vls128_dual", "ouster_legacy", "ouster_rng15",
        "livox"}},
      {"pcap", {"two", "big_endian", "pcapng", "fragments", "cut"}},
      {"tof", {"two_frequencies", "eight_frequencies", "kinect", "infinite", "one_pixel"}},
      {"stereo", {"shifted", "paths_4", "flat", "narrow"}},
      {"tof_npy", {"floats", "doubles", "integers", "version_2"}},
      {"obj", {"quad", "numbers", "polygon", "materials"}},
      {"ply", {"ascii", "little", "big", "strips", "faces"}},
      {"stl", {"ascii", "binary", "colours"}},
      {"off", {"plain", "all", "binary"}},
      {"mtl", {"all", "odd"}},
      {"image",
       {"bmp", "gif", "hdr", "jpeg", "palette", "pnm", "png", "psd", "tga", "webp", "webp_alpha"}},
      {"collada", {"plain", "decorated"}},
      {"package", {"three_mf", "zae"}},
  };
  for (const testing::FileDecoder& decoder : testing::file_decoders()) {
    std::size_t files = 0;
    const std::set<std::string> names = taken(decoder, files);
    const auto found = expected.find(decoder.name);
    ASSERT_NE(found, expected.end()) << decoder.name;
    EXPECT_EQ(names, found->second) << decoder.name;
    EXPECT_GT(files, names.size()) << decoder.name << ": its corpus has files that are refused";
  }
}

}  // namespace
}  // namespace glidar
