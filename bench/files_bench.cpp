// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Writing clouds compared with plain writing, and loading models compared with Assimp alone.
#include "ratio_reporter.hpp"

#include <glidar/io/formats/file_sink.hpp>
#include <glidar/io/model/model.hpp>

#include <assimp/postprocess.h>
#include <fcntl.h>
#include <unistd.h>
#include <assimp/Importer.hpp>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>

namespace glidar::bench {
namespace {

constexpr std::uint32_t kRows = 1000;
constexpr std::uint32_t kCols = 1000;
constexpr std::size_t kBytes = std::size_t{kRows} * kCols * 16;  // x y z intensity as float32

/// A million points in memory.
struct Cloud {
  Scene scene;
  Sensor sensor;
  Beams beams;
  Frame frame;
  PointCloud cloud;

  Cloud() {
    const std::size_t size = std::size_t{kRows} * kCols;
    frame.rows = kRows;
    frame.cols = kCols;
    resize(frame, size);
    frame.status.assign(size, Status::hit);
    beams.rows = kRows;
    beams.cols = kCols;
    beams.directions.assign(size, Eigen::Vector3d::UnitZ());
    std::vector<double> xyz(3 * size);
    for (std::size_t i = 0; i < xyz.size(); ++i) xyz[i] = 1e-6 * static_cast<double>(i);
    cloud = {kRows, kCols, "camera_optical_frame", Pose::Identity(), {}};
    cloud.columns.push_back({"xyz", {"x", "y", "z"}, std::move(xyz)});
    cloud.columns.push_back({"intensity", {"intensity"}, std::vector<float>(size, 0.5F)});
  }
};

std::filesystem::path scratch(const char* name) {
  return std::filesystem::temp_directory_path() / (std::to_string(getpid()) + name);
}

/// The destination of written bytes when the time is taken.
enum class Reach { page_cache, disk };

/// Waits until a file's bytes are on the disk.
void sync(const std::filesystem::path& path) {
  const int file = open(path.c_str(), O_RDONLY);
  if (file < 0 || fdatasync(file) != 0) throw std::runtime_error("cannot sync " + path.string());
  close(file);
}

void write_plainly(benchmark::State& state, Reach reach) {
  const std::vector<char> bytes(kBytes, 'x');
  const std::filesystem::path path = scratch("plain.bin");
  for (auto _ : state) {
    const int file = open(path.c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0600);
    if (file < 0 || write(file, bytes.data(), bytes.size()) != static_cast<ssize_t>(kBytes)) {
      throw std::runtime_error("cannot write " + path.string());
    }
    close(file);
    if (reach == Reach::disk) sync(path);
    state.PauseTiming();
    std::filesystem::remove(path);
    state.ResumeTiming();
  }
}

void write_pcd(benchmark::State& state, Reach reach) {
  const Cloud made;
  const std::filesystem::path path = scratch("cloud.pcd");
  const auto sink =
      make_file_sink(path, {.sidecar = false}, {made.scene, made.sensor, made.beams, "none"});
  for (auto _ : state) {
    sink->write(made.cloud, made.frame);
    if (reach == Reach::disk) sync(path);
    state.PauseTiming();
    std::filesystem::remove(path);
    state.ResumeTiming();
  }
}

void register_writing(Reach reach, const std::string& where, double goal,
                      std::vector<Ratio>& ratios) {
  const auto add = [&](const char* what, void (*body)(benchmark::State&, Reach)) {
    std::string name = "a million points " + where + what;
    benchmark::RegisterBenchmark(name.c_str(), [body, reach](benchmark::State& state) {
      body(state, reach);
    })->UseRealTime();
    return name;
  };
  const std::string plain = add(", plain write", write_plainly);
  const std::string pcd = add(", PCD", write_pcd);
  ratios.push_back({"binary PCD / plain write " + where, plain, pcd, goal});
}

constexpr unsigned kAssimpSteps =
    aiProcess_Triangulate | aiProcess_SortByPType | aiProcess_JoinIdenticalVertices;

void load_by_assimp(benchmark::State& state, const std::string& path) {
  for (auto _ : state) {
    Assimp::Importer importer;
    if (importer.ReadFile(path, kAssimpSteps) == nullptr) {
      throw std::runtime_error(importer.GetErrorString());
    }
  }
}

void load_first(benchmark::State& state, const std::string& path) {
  ModelOptions options;
  options.cache_folder = scratch("cache");
  for (auto _ : state) {
    benchmark::DoNotOptimize(load_model(path, options, {}));
    state.PauseTiming();
    std::filesystem::remove_all(options.cache_folder);
    state.ResumeTiming();
  }
}

void load_again(benchmark::State& state, const std::string& path) {
  ModelOptions options;
  options.cache_folder = scratch("cache_kept");
  benchmark::DoNotOptimize(load_model(path, options, {}));
  for (auto _ : state) benchmark::DoNotOptimize(load_model(path, options, {}));
  std::filesystem::remove_all(options.cache_folder);
}

void register_model(const std::string& name, const std::string& path, std::vector<Ratio>& ratios) {
  const auto add = [&](const char* what, void (*body)(benchmark::State&, const std::string&)) {
    benchmark::RegisterBenchmark((name + what).c_str(),
                                 [body, path](benchmark::State& state) { body(state, path); })
        ->UseRealTime()
        ->Unit(benchmark::kMillisecond)
        ->Iterations(1);
  };
  add(" assimp", load_by_assimp);
  add(" first load", load_first);
  add(" cached load", load_again);
  ratios.push_back({name + " first load: Assimp's time / ours", name + " assimp",
                    name + " first load", 1.0 / 1.3});
  ratios.push_back(
      {name + " cached load against the first", name + " first load", name + " cached load", 5.0});
}

}  // namespace
}  // namespace glidar::bench

int main(int argc, char** argv) {
  using glidar::bench::Ratio;
  std::vector<Ratio> ratios;
  using glidar::bench::Reach;
  glidar::bench::register_writing(Reach::disk, "to the disk", 0.5, ratios);
  glidar::bench::register_writing(Reach::page_cache, "to the page cache", 0.0, ratios);
  const char* data = std::getenv("GLIDAR_DATA");
  if (data == nullptr) {
    std::puts("GLIDAR_DATA is not set: loading is measured on models/asteroid only");
  } else {
    const std::string stanford = std::string(data) + "/models/stanford/";
    glidar::bench::register_model("bunny", stanford + "bun_zipper.ply", ratios);
    glidar::bench::register_model("dragon", stanford + "dragon/dragon_vrip_binary.ply", ratios);
  }
  glidar::bench::register_model("asteroid", GLIDAR_MODELS "/asteroid/asteroid.glb", ratios);
  return glidar::bench::run(argc, argv, ratios);
}
