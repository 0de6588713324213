// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// A program beside another one in a domain of DDS (ROS_DOMAIN_ID), for tests in Python:
//   samples BAG        writes the samples of all messages for every line "write" of its input,
//                      and the same to a bag
//   clouds N BYTES HZ  writes N clouds, at HZ or (0) each after the acknowledgement of the last
//   count N BYTES      reads until N clouds have come or its input ends
//   newest BYTES       reads a line, then clouds until the last one of `clouds`
//   poses TOPIC        prints poses
//   read TOPIC TYPE N  prints N messages
//   write TOPIC TYPE   writes the messages of its input
#include "cloud_peers.hpp"
#include "message_peers.hpp"
#include "sample_peers.hpp"

#include <cstdio>
#include <exception>
#include <span>
#include <string>

namespace {

int run(std::span<char*> words) {
  using namespace glidar::testing;  // NOLINT(google-build-using-namespace)
  const std::string command = words.empty() ? "" : words[0];
  const auto number = [&](std::size_t index) { return std::stoul(words[index]); };
  if (command == "samples" && words.size() == 2) return write_samples(words[1]);
  if (command == "clouds" && words.size() == 4)
    return write_clouds({number(1), number(2), std::stod(words[3])});
  if (command == "count" && words.size() == 3) return count_clouds(number(1), number(2));
  if (command == "newest" && words.size() == 2) return read_newest(number(1));
  if (command == "poses" && words.size() == 2) return print_poses(words[1]);
  if (command == "read" && words.size() == 4) return read_messages(words[1], words[2], number(3));
  if (command == "write" && words.size() == 3) return write_messages(words[1], words[2]);
  std::fprintf(stderr, "unknown command\n");
  return 2;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(std::span(argv, static_cast<std::size_t>(argc)).subspan(1));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
