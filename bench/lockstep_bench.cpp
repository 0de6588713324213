// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Time that the lock-step link adds to a measurement: the request to the server and the reply with
// the cloud, over TCP on this machine. The server is a separate process, as in use.
#include "ratio_reporter.hpp"
#include "raw_opengl.hpp"

#include <apps/glidar/run/lockstep_run.hpp>
#include <glidar/simulate/simulator.hpp>

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>
#include <zmq.hpp>

#include <csignal>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <memory>
#include <numbers>
#include <span>

namespace glidar::bench {
namespace {

constexpr unsigned kThreads = 2;
constexpr std::size_t kPointBytes = 3 * sizeof(double) + sizeof(float);  // xyz, intensity

/// A free port, which no other process is expected to take before it is used.
std::string free_endpoint() {
  zmq::context_t context;
  zmq::socket_t socket(context, zmq::socket_type::rep);
  socket.bind("tcp://127.0.0.1:*");
  return socket.get(zmq::sockopt::last_endpoint);
}

/// A process that is terminated at the end of its scope.
class Process {
 public:
  explicit Process(const std::function<void()>& work) : id_(fork()) {
    if (id_ != 0) return;
    work();
    std::_Exit(0);
  }
  ~Process() {
    kill(id_, SIGTERM);
    waitpid(id_, nullptr, 0);
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

 private:
  pid_t id_;
};

void serve_lockstep(const std::string& model, std::uint32_t side, const std::string& endpoint) {
  app::StreamFlags flags;
  flags.render.input = model;
  flags.render.sensor.fov_deg = kFov_rad * 180.0 / std::numbers::pi;
  flags.render.sensor.width = flags.render.sensor.height = side;
  flags.render.renderer.threads = kThreads;
  flags.render.quiet = true;
  flags.lockstep = endpoint;
  app::Console console(true);
  app::LockstepRun(flags, console).run();
}

/// Answers every request with a cloud of the same frame: the cost of the link without the
/// measurement.
void serve_frame(const std::string& path, std::uint32_t side, const std::string& endpoint) {
  const Model model("model", path);
  Sensor sensor;
  sensor.optics = pinhole_from_fov(side, side, kFov_rad);
  Simulator simulator(model.scene, sensor, {.threads = kThreads});
  const Frame frame = simulator.simulate(model.world_from_sensor);
  link::Context context;
  const Report silent;
  link::ErrorLog errors(silent);
  lockstep::Server server(context, {.endpoint = link::parse_endpoint(endpoint)}, errors);
  link::CloudPool clouds;
  for (;;) {
    const std::optional<lockstep::Received> received = server.receive();
    if (!received) {
      link::wait_for({&server.socket()}, -1, std::chrono::milliseconds(1000));
      continue;
    }
    const std::shared_ptr<PointCloud> cloud = clouds.take();
    make_point_cloud(frame, *simulator.beams(), model.scene,
                     {.frame_id = "camera", .thread_pool = &simulator.renderer().thread_pool()},
                     std::get<lockstep::Measure>(received->request).columns, *cloud);
    const lockstep::CloudReply reply = {
        .head = {.rows = cloud->rows, .cols = cloud->cols, .frame_id = cloud->frame_id},
        .cloud = cloud};
    server.reply(received->to, std::span(&reply, 1));
  }
}

/// Answers every message with a fixed number of bytes, which are not copied.
void serve_echo(std::size_t bytes, const std::string& endpoint) {
  zmq::context_t context;
  zmq::socket_t socket(context, zmq::socket_type::rep);
  socket.bind(endpoint);
  std::vector<std::byte> answer(bytes, std::byte{1});
  for (;;) {
    zmq::message_t request;
    if (!socket.recv(request)) continue;
    socket.send(zmq::message_t(answer.data(), bytes, [](void*, void*) {}), zmq::send_flags::none);
  }
}

class Client {
 public:
  explicit Client(const std::string& endpoint) : socket_(context_, zmq::socket_type::req) {
    socket_.connect(endpoint);
  }
  /// The bytes of the answer.
  std::size_t ask(std::span<const std::byte> request) {
    socket_.send(zmq::buffer(request.data(), request.size()), zmq::send_flags::none);
    std::size_t bytes = 0;
    zmq::message_t part;
    do {
      if (socket_.recv(part)) bytes += part.size();
    } while (part.more());
    return bytes;
  }

 private:
  zmq::context_t context_;
  zmq::socket_t socket_;
};

/// The servers of one size; they start before this process has threads, because fork() does not
/// copy these.
struct Servers {
  Servers(const std::string& model, std::uint32_t side)
      : lockstep_at(free_endpoint()),
        echo_at(free_endpoint()),
        frame_at(free_endpoint()),
        lockstep([&] { serve_lockstep(model, side, lockstep_at); }),
        echo([&] { serve_echo(kPointBytes * side * side, echo_at); }),
        frame([&] { serve_frame(model, side, frame_at); }) {}

  std::string lockstep_at;
  std::string echo_at;
  std::string frame_at;
  Process lockstep;
  Process echo;
  Process frame;
};

/// A model at one size, by the link, by simulate() in this process, and by an echo.
class Ways {
 public:
  Ways(const Model& model, const Servers& servers, std::uint32_t side)
      : model_(model),
        servers_(servers),
        motion_(static_motion(model.scene, model.world_from_sensor)) {
    sensor_.optics = pinhole_from_fov(side, side, kFov_rad);
    lockstep::Moment moment{.t_ns = 0, .seed = 1, .number = 0, .sensor = {}, .objects = {}};
    moment.sensor.world_from_body = model.world_from_sensor;
    request_ = lockstep::encode(
        lockstep::Measure{.id = 1, .columns = {"xyz", "intensity"}, .moments = {moment}});
  }

  void by_link(benchmark::State& state) {
    Client client(servers_.lockstep_at);
    std::size_t bytes = client.ask(request_);
    for (auto _ : state) bytes = client.ask(request_);
    state.counters["MB"] = static_cast<double>(bytes) / 1e6;
  }

  /// A frame that is already measured.
  void by_link_alone(benchmark::State& state) {
    Client client(servers_.frame_at);
    client.ask(request_);
    for (auto _ : state) client.ask(request_);
  }

  /// The unavoidable part: the measurement, and the same bytes sent and received.
  void by_hand(benchmark::State& state) {
    Client client(servers_.echo_at);
    Simulator simulator(model_.scene, sensor_, {.threads = kThreads});
    for (auto _ : state) {
      simulator.simulate(motion_, {}, frame_);
      client.ask(request_);
    }
  }

  void by_echo(benchmark::State& state) {
    Client client(servers_.echo_at);
    std::size_t bytes = 0;
    for (auto _ : state) bytes = client.ask(request_);
    state.counters["MB"] = static_cast<double>(bytes) / 1e6;
  }

 private:
  const Model& model_;
  const Servers& servers_;
  Sensor sensor_;
  Motion motion_;
  Frame frame_;
  std::vector<std::byte> request_;
};

void add(const std::string& name, void (Ways::*way)(benchmark::State&), Ways* ways) {
  benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
    (ways->*way)(state);
  })->UseRealTime();
}

/// Runs all, by the model of a file.
int run_all(int argc, char** argv) {
  const char* data = std::getenv("GLIDAR_DATA");
  const std::string path =
      data == nullptr ? "builtin:asteroid" : std::string(data) + "/models/stanford/bun_zipper.ply";
  constexpr std::uint32_t kSmall = 64;
  constexpr std::uint32_t kLarge = 1024;
  const Servers small_servers(path, kSmall);
  const Servers large_servers(path, kLarge);
  const Model model("model", path);
  Ways small(model, small_servers, kSmall);
  Ways large(model, large_servers, kLarge);
  add("64x64 by lock-step", &Ways::by_link, &small);
  add("64x64 simulate + echo", &Ways::by_hand, &small);
  add("1024x1024 by lock-step", &Ways::by_link, &large);
  add("1024x1024 link alone", &Ways::by_link_alone, &large);
  add("1024x1024 echo", &Ways::by_echo, &large);
  add("1024x1024 simulate + echo", &Ways::by_hand, &large);
  constexpr double kGoal = 1.0 / 1.3;
  return run(argc, argv,
             {{"64x64: (simulate + echo) / lock-step", "64x64 simulate + echo",
               "64x64 by lock-step", kGoal},
              {"1024x1024: (simulate + echo) / lock-step", "1024x1024 simulate + echo",
               "1024x1024 by lock-step", kGoal},
              {"1024x1024: link's throughput / loopback's", "1024x1024 echo",
               "1024x1024 link alone", 0.5}});
}

}  // namespace
}  // namespace glidar::bench

int main(int argc, char** argv) {
  return glidar::bench::run_all(argc, argv);
}
