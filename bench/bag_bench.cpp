// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Bags of an OS1-128 in a street: frames written while the next one is measured, relative to frames
// measured alone; the bytes of frames that are ready, relative to the same bytes written to a
// plain file; and bags read by the sandboxed process, relative to bags read in this one.
// GLIDAR_BENCH_FOLDER selects the disk [the current folder].
#include "ratio_reporter.hpp"

#include <apps/glidar/run/delivery.hpp>
#include <glidar/io/bags/bag_contents.hpp>
#include <glidar/io/bags/bag_records.hpp>
#include <glidar/io/config/scene_file.hpp>
#include <glidar/io/config/sensor_file.hpp>
#include <glidar/io/config/sensor_presets.hpp>
#include <glidar/io/files/atomic_file.hpp>
#include <glidar/output/output.hpp>
#include <glidar/simulate/simulator.hpp>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace glidar::bench {
namespace {

constexpr std::uint32_t kFrames = 20;  // of a bag
const std::vector<std::string> kColumns = {"xyz",   "intensity", "ring", "time",
                                           "range", "instance",  "class"};

/// The street with a sensor at its middle, as `glidar render examples/street.yaml` sees it.
struct Street {
  SceneFile loaded;
  Sensor sensor;
  Motion motion;
  std::unique_ptr<Simulator> simulator;
  std::shared_ptr<const Beams> beams;
  std::filesystem::path folder;

  Street(unsigned threads, std::filesystem::path disk)
      : loaded(load_scene_file(GLIDAR_EXAMPLES "/street.yaml", {}, {})),
        sensor(load_sensor_file(find_sensor_file("OS1-128"))),
        folder(std::move(disk)) {
    motion = static_motion(loaded.scene, Pose(Eigen::Translation3d(0.0, 0.0, 1.8)));
    simulator =
        std::make_unique<Simulator>(loaded.scene, sensor, RendererOptions{.threads = threads});
    beams = simulator->beams(0);
  }
  void measure(std::uint32_t number, Frame& frame) const {
    frame.number = number;
    frame.stamp_ns = frame_interval(sensor, number).start_ns;
    simulator->simulate(motion, hit_columns_for(kColumns), frame);
  }
  [[nodiscard]] std::filesystem::path bag() const { return folder / "bag_bench.mcap"; }
  /// A new bag.
  [[nodiscard]] std::unique_ptr<Output> open_bag() const {
    OutputRig rig{.scene = loaded.scene, .sensors = {}};
    rig.sensors.push_back({.sensor = sensor, .beams = *beams});
    return open_output(bag().string(), rig);
  }
};

void measure_alone(benchmark::State& state, const Street& street) {
  Frame frame;
  for (auto _ : state) {
    for (std::uint32_t number = 0; number < kFrames; ++number) street.measure(number, frame);
  }
  state.SetItemsProcessed(state.iterations() * kFrames);
}

void write_bag(benchmark::State& state, const Street& street) {
  for (auto _ : state) {
    const auto bag = street.open_bag();
    app::Delivery delivery([&](const app::MeasuredFrame& slot) { bag->write(slot.view()); }, [] {},
                           [] {});
    for (std::uint32_t number = 0; number < kFrames; ++number) {
      app::MeasuredFrame& slot = delivery.next_slot();
      slot.beams = street.beams;
      street.measure(number, slot.frame);
      delivery.submit();
    }
    delivery.finish();
    bag->finish();
  }
  state.SetItemsProcessed(state.iterations() * kFrames);
}

/// Frames that are ready.
void write_ready(benchmark::State& state, const Street& street) {
  Frame frame;
  street.measure(0, frame);
  for (auto _ : state) {
    const auto bag = street.open_bag();
    for (std::uint32_t number = 0; number < kFrames; ++number) {
      frame.number = number;
      frame.stamp_ns = frame_interval(street.sensor, number).start_ns;
      bag->write({.frame = frame, .beams = *street.beams});
    }
    bag->finish();
  }
  const auto bytes = static_cast<std::int64_t>(std::filesystem::file_size(street.bag()));
  state.SetBytesProcessed(state.iterations() * bytes);
  state.SetItemsProcessed(state.iterations() * kFrames);
}

void write_plain(benchmark::State& state, const Street& street) {
  Frame frame;
  street.measure(0, frame);
  {
    const auto bag = street.open_bag();
    bag->write({.frame = frame, .beams = *street.beams});
    bag->finish();
  }
  const std::vector<std::byte> bytes(std::filesystem::file_size(street.bag()), std::byte{7});
  for (auto _ : state) {
    AtomicFile file(street.folder / "bag_bench.plain");
    for (std::uint32_t number = 0; number < kFrames; ++number) file.write(bytes);
    file.commit();
  }
  state.SetBytesProcessed(state.iterations() * kFrames * static_cast<std::int64_t>(bytes.size()));
}

enum class Input : std::uint8_t { mcap, mcap_zstd, sqlite };

/// A bag of the street in this format. Returns its path.
std::filesystem::path write_input(const Street& street, Input input) {
  const auto plain = street.open_bag();
  Frame frame;
  for (std::uint32_t number = 0; number < kFrames; ++number) {
    street.measure(number, frame);
    plain->write({.frame = frame, .beams = *street.beams});
  }
  plain->finish();
  if (input == Input::mcap) return street.bag();
  const bool is_sqlite = input == Input::sqlite;
  const std::filesystem::path path =
      street.folder / (is_sqlite ? "bag_bench.rosbag2" : "bag_bench_packed.mcap");
  const auto compression = is_sqlite ? bags::Compression::none : bags::Compression::zstd;
  const auto from = bags::open_bag_unconfined(street.bag());
  const auto to = bags::create_bag(path, {.compression = compression});
  for (const bags::StoredTopic& topic : from->topics())
    to->add_topic({topic.name.bytes(), bags::type_of(topic), bags::type_of(topic)->qos});
  for (bags::BagMessage message; from->next(message);)
    to->write(message.topic, message.time_ns, message.data);
  to->finish();
  return path;
}

using OpenBag = std::unique_ptr<bags::BagReader> (*)(const std::filesystem::path&);

void read_messages(benchmark::State& state, const std::filesystem::path& path, OpenBag open) {
  for (auto _ : state) {
    const auto bag = open(path);
    for (bags::BagMessage message; bag->next(message);) benchmark::DoNotOptimize(message.data);
  }
  state.SetItemsProcessed(state.iterations() * kFrames);
}

void read_clouds(benchmark::State& state, const std::filesystem::path& path, OpenBag open) {
  for (auto _ : state) {
    bags::BagClouds clouds(open(path), path, {});
    for (bags::BagCloud cloud; clouds.next(cloud);) benchmark::DoNotOptimize(cloud.cloud);
  }
  state.SetItemsProcessed(state.iterations() * kFrames);
}

struct Reading {
  std::string title;
  void (*read)(benchmark::State&, const std::filesystem::path&, OpenBag);
  OpenBag open;
  Input input;
};

void enter_reading(const std::shared_ptr<const Street>& street, const Reading& reading) {
  benchmark::RegisterBenchmark(reading.title.c_str(),
                               [street, reading](benchmark::State& state) {
                                 reading.read(state, write_input(*street, reading.input),
                                              reading.open);
                               })
      ->UseRealTime()
      ->Unit(benchmark::kMillisecond);
}

void add_reading(const std::filesystem::path& folder, std::vector<Ratio>& ratios) {
  const auto street = std::make_shared<const Street>(1, folder);
  constexpr std::array<std::pair<Input, const char*>, 3> kInputs = {
      {{Input::mcap, " of a bag"},
       {Input::mcap_zstd, " of a zstd bag"},
       {Input::sqlite, " of a SQLite bag"}}};
  for (const auto& [input, title] : kInputs) {
    for (const auto read : {read_messages, read_clouds}) {
      std::string name = read == read_messages ? "messages" : "clouds";
      name += title;
      const Reading here{name + ", in this process", read, bags::open_bag_unconfined, input};
      const Reading there{name + ", sandboxed", read, bags::open_bag, input};
      enter_reading(street, here);
      enter_reading(street, there);
      constexpr double kGoal = 1.0 / 1.2;
      ratios.push_back({name + ": sandboxed / in this process", here.title, there.title, kGoal});
    }
  }
}

void add(unsigned threads, const std::filesystem::path& folder, std::vector<Ratio>& ratios) {
  const auto street = std::make_shared<const Street>(threads, folder);
  const std::string end = ", " + std::to_string(threads) + (threads == 1 ? " thread" : " threads");
  const auto enter = [](const std::string& title, const auto& body) {
    benchmark::RegisterBenchmark(title.c_str(), body)->UseRealTime()->Unit(benchmark::kMillisecond);
  };
  const auto named = [&](const char* what) { return what + end; };
  enter(named("measured"), [street](benchmark::State& s) { measure_alone(s, *street); });
  enter(named("written"), [street](benchmark::State& s) { write_bag(s, *street); });
  constexpr double kGoal = 0.9;
  ratios.push_back(
      {named("OS1-128 to MCAP: written / measured"), named("measured"), named("written"), kGoal});
  if (threads > 1) return;
  enter("ready frames to a bag", [street](benchmark::State& s) { write_ready(s, *street); });
  enter("the same bytes to a file", [street](benchmark::State& s) { write_plain(s, *street); });
  constexpr double kDiskGoal = 0.5;
  ratios.push_back({"ready frames: bag / plain file", "the same bytes to a file",
                    "ready frames to a bag", kDiskGoal});
}

}  // namespace
}  // namespace glidar::bench

int main(int argc, char** argv) {
  const char* chosen = std::getenv("GLIDAR_BENCH_FOLDER");
  const std::filesystem::path folder = chosen == nullptr ? "." : chosen;
  std::vector<glidar::bench::Ratio> ratios;
  for (const unsigned threads : {1U, 2U}) glidar::bench::add(threads, folder, ratios);
  glidar::bench::add_reading(folder, ratios);
  const int result = glidar::bench::run(argc, argv, ratios);
  std::filesystem::remove(folder / "bag_bench.mcap");
  std::filesystem::remove(folder / "bag_bench_packed.mcap");
  std::filesystem::remove_all(folder / "bag_bench.rosbag2");
  std::filesystem::remove(folder / "bag_bench.plain");
  return result;
}
