// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Memory of a scene and its renderer, relative to the mesh as stored in the scene and to Embree's
// structures over the same triangles. Each is measured in a separate process, so that results are
// independent.
#include "embree_api.hpp"
#include "ratio_reporter.hpp"

#include <glidar/io/model/model.hpp>
#include <glidar/render/renderer.hpp>

#include <malloc.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

namespace glidar::bench {
namespace {

constexpr double kMaxRatio = 1.5;

/// All in bytes.
struct Memory {
  double mesh = 0;  ///< arrays of the mesh
  double embree =
      0;  ///< Embree's structures over the same triangles, vertices and indices not copied
  double scene = 0;     ///< growth of the process by loading the model
  double renderer = 0;  ///< growth by the renderer
  double peak = 0;      ///< maximum growth while loading or building
};

template <class T>
double bytes_of(const std::vector<T>& values) {
  return static_cast<double>(values.size() * sizeof(T));
}

double mesh_bytes(const Mesh& mesh) {
  double bytes = bytes_of(mesh.positions_m) + bytes_of(mesh.triangles) + bytes_of(mesh.normals) +
                 bytes_of(mesh.tangents) + bytes_of(mesh.colours) + bytes_of(mesh.material_slots);
  for (const auto& uvs : mesh.uvs) bytes += bytes_of(uvs);
  return bytes;
}

/// A line of /proc/self/status in bytes.
double status_bytes(const std::string& name) {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    double kib = 0.0;
    if (word == name + ":" && status >> kib) return 1024.0 * kib;
  }
  return 0.0;
}

/// Anonymous pages: the heap and other private mappings, without the code of libraries.
double held_bytes() {
  malloc_trim(0);  // what was freed must not count
  return status_bytes("RssAnon");
}

bool count_embree(void* total, ssize_t bytes, bool /*after*/) {
  *static_cast<std::atomic<ssize_t>*>(total) += bytes;
  return true;
}

double embree_bytes(const Mesh& mesh) {
  std::atomic<ssize_t> total{0};
  const RTCDevice device = rtcNewDevice(nullptr);
  rtcSetDeviceMemoryMonitorFunction(device, count_embree, &total);
  const RTCScene scene = rtcNewScene(device);
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  std::vector<Eigen::Vector3f> vertices = mesh.positions_m;
  vertices.emplace_back();  // Embree reads 16 bytes of the last one
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                             vertices.data(), 0, sizeof(Eigen::Vector3f), mesh.positions_m.size());
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                             mesh.triangles.data(), 0, sizeof(Triangle), mesh.triangles.size());
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene);
  const auto bytes = static_cast<double>(total.load());
  rtcReleaseScene(scene);
  rtcReleaseDevice(device);
  return bytes;
}

/// Runs `measure` in a separate process and writes its result into `found`.
template <class Measure>
bool apart(const Measure& measure, Memory& found) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) return false;
  const pid_t child = fork();
  if (child == 0) {
    Memory memory = found;
    measure(memory);
    const bool sent = write(ends[1], &memory, sizeof(memory)) == ssize_t{sizeof(memory)};
    _exit(sent ? 0 : 1);
  }
  close(ends[1]);
  const bool got = read(ends[0], &found, sizeof(found)) == ssize_t{sizeof(found)};
  close(ends[0]);
  waitpid(child, nullptr, 0);
  return got;
}

void measure_ours(const std::string& model, Memory& memory) {
  const double before = held_bytes();
  const double peak_before = status_bytes("VmHWM");
  Scene scene;
  add_model(scene, load_model(model, {}, {}));
  const double with_scene = held_bytes();
  const auto renderer = make_renderer(scene, {.kind = "rays"});
  memory.mesh = mesh_bytes(scene.meshes[0]);
  memory.scene = with_scene - before;
  memory.renderer = held_bytes() - with_scene;
  memory.peak = status_bytes("VmHWM") - peak_before;
}

void report(const std::string& name, const std::string& model) {
  Memory memory;
  const bool done =
      apart([&](Memory& m) { m.embree = embree_bytes(load_model(model, {}, {}).mesh); }, memory) &&
      apart([&](Memory& m) { measure_ours(model, m); }, memory);
  if (!done) {
    std::printf("%s: could not be measured\n", name.c_str());
    return;
  }
  constexpr double kMiB = 1024.0 * 1024.0;
  std::printf(
      "%s: mesh %.1f MiB, Embree's own %.1f MiB; scene %.1f MiB, renderer %.1f MiB, "
      "peak %.1f MiB\n",
      name.c_str(), memory.mesh / kMiB, memory.embree / kMiB, memory.scene / kMiB,
      memory.renderer / kMiB, memory.peak / kMiB);
  const double needed = memory.mesh + memory.embree;
  print_at_most(name + " scene and renderer / mesh and Embree's own",
                (memory.scene + memory.renderer) / needed, kMaxRatio);
}

}  // namespace
}  // namespace glidar::bench

int main() {
  const char* data = std::getenv("GLIDAR_DATA");
  if (data == nullptr) {
    std::puts("GLIDAR_DATA is not set: the built-in asteroid replaces the Stanford models");
    glidar::bench::report("asteroid", "builtin:asteroid");
    return 0;
  }
  const std::string stanford = std::string(data) + "/models/stanford/";
  glidar::bench::report("bunny", stanford + "bun_zipper.ply");
  glidar::bench::report("dragon", stanford + "dragon/dragon_vrip_binary.ply");
}
