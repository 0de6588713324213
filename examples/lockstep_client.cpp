// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// A client of `glidar stream builtin:asteroid --lockstep tcp://127.0.0.1:5600`, from the tables of
// docs/link/lockstep.md alone.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <limits>
#include <vector>
#include <zmq_addon.hpp>

struct Request {  // of one column, moment and object; little-endian as this machine is
  char magic[4] = {'G', 'L', 'D', 'R'};
  std::uint16_t version = 1, kind = 1;
  std::uint64_t id = 7;
  std::uint32_t sensor_number = 0, drop_invalid = 1, columns = 1, moments = 1, objects = 1,
                zero = 0;
  char column[24] = "xyz";
  std::int64_t t_ns = 0;
  std::uint64_t seed = 1;
  std::uint32_t frame = 0, zero_too = 0;
  double sensor[13] = {6, 0, 0, 0.5, -0.5, -0.5, 0.5};            // looks along -x, z is up
  double object[13] = {0, 0, 0, 1, 0, 0, 0, /*rate*/ 0, 0, 0.1};  // turns at 0.1 rad/s
};
static_assert(sizeof(Request) == 40 + 24 + 24 + 104 * 2);

int main(int argc, char** argv) {
  zmq::context_t context;
  zmq::socket_t socket(context, zmq::socket_type::req);
  socket.set(zmq::sockopt::rcvtimeo, 60'000);  // ms
  socket.set(zmq::sockopt::linger, 0);
  socket.connect(argc > 1 ? argv[1] : "tcp://127.0.0.1:5600");
  const Request request;
  socket.send(zmq::const_buffer(&request, sizeof(request)));
  std::vector<zmq::message_t> reply;
  if (!zmq::recv_multipart(socket, std::back_inserter(reply))) return std::puts("no answer"), 1;
  std::uint16_t kind = 0;
  std::memcpy(&kind, reply[0].data<char>() + 6, sizeof(kind));
  if (kind != 2) return std::puts(reply[1].to_string().c_str()), 1;  // the error in words
  std::vector<double> xyz(reply[1].size() / sizeof(double));         // f8, as reply[0] states
  std::memcpy(xyz.data(), reply[1].data(), reply[1].size());
  double nearest_m = std::numeric_limits<double>::infinity();
  for (std::size_t k = 2; k < xyz.size(); k += 3) nearest_m = std::min(nearest_m, xyz[k]);
  std::printf("%zu points, the nearest %.3f m ahead\n", xyz.size() / 3, nearest_m);
}
