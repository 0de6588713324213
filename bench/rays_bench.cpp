// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// The ray caster compared with raw Embree, on one thread, in that thread's processor time: rays of
// a camera and rays in unrelated directions, with range, normal and triangle of every hit. Also the
// time of building its trees.
#include "ratio_reporter.hpp"
#include "raw_rays.hpp"

#include <glidar/io/model/model.hpp>
#include <glidar/math/simd.hpp>
#include <glidar/render/rays/exact_test.hpp>
#include <glidar/render/rays/kernels.hpp>
#include <glidar/render/rays/mesh_tree.hpp>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <memory>
#include <random>

namespace glidar::bench {
namespace {

constexpr unsigned kSide = 512;
constexpr double kFov = 0.52;

/// Rays of a camera, tile by tile of 4 x 4, that a mesh fills.
RayList camera_rays(const Eigen::AlignedBox3d& box) {
  RayList list{true, {}};
  const double distance = 0.55 * box.sizes().maxCoeff() / std::tan(kFov / 2.0);
  const Eigen::Vector3d origin = box.center() + distance * Eigen::Vector3d(0.25, 0.2, 0.95);
  const Eigen::Vector3d ahead = (box.center() - origin).normalized();
  const Eigen::Vector3d right = ahead.cross(Eigen::Vector3d::UnitY()).normalized();
  const Eigen::Vector3d down = ahead.cross(right);
  for (unsigned tile = 0; tile < kSide * kSide / 16; ++tile) {
    for (unsigned i = 0; i < 16; ++i) {
      const double x = 2.0 * (tile % (kSide / 4) * 4 + i % 4 + 0.5) / kSide - 1.0;
      const unsigned row = tile / (kSide / 4) * 4 + i / 4;
      const double y = 2.0 * (row + 0.5) / kSide - 1.0;
      const Eigen::Vector3d d = ahead + std::tan(kFov / 2.0) * (x * right + y * down);
      list.rays.push_back({origin, d.normalized()});
    }
  }
  return list;
}

/// Rays from random points around to random points inside.
RayList random_rays(const Eigen::AlignedBox3d& box) {
  RayList list{false, {}};
  std::mt19937 engine(1);
  const auto point = [&] {
    const auto number = [&] { return static_cast<double>(engine()) * 0x1p-31 - 1.0; };
    return Eigen::Vector3d(number(), number(), number());
  };
  const double radius = 0.5 * box.sizes().norm();
  for (unsigned i = 0; i < 128 * 1024; ++i) {
    const Eigen::Vector3d origin = box.center() + 2.0 * radius * point().normalized();
    const Eigen::Vector3d target = box.center() + 0.3 * radius * point();
    list.rays.push_back({origin, (target - origin).normalized()});
  }
  return list;
}

/// Corners of the triangles that a packet hit, one after the other.
struct Gathered {
  alignas(64) float corner[9][rays::kPacketSize];
};

void gather(const TriangleBlock* blocks, const rays::RayPacket& packet, Gathered& gathered) {
  for (unsigned i = 0; i < rays::kPacketSize; ++i) {
    const std::uint32_t slot = packet.slot[i] == rays::kNoTriangle ? 0 : packet.slot[i];
    const TriangleBlock& block = blocks[slot / kBlockSize];
    const float* rows = &block.corner[0][0][slot % kBlockSize];
    for (unsigned row = 0; row < 9; ++row) {
      gathered.corner[row][i] = rows[std::size_t{kBlockSize} * row];
    }
  }
}

/// Range and normal of hits, from the plane in double.
GLIDAR_SIMD void measure(const rays::RayPacket& p, const Gathered& g, float* range_m,
                         float (*normal)[rays::kPacketSize]) {
  for (unsigned i = 0; i < rays::kPacketSize; ++i) {
    const double ax = g.corner[0][i];
    const double ay = g.corner[1][i];
    const double az = g.corner[2][i];
    const double px = g.corner[3][i] - ax;
    const double py = g.corner[4][i] - ay;
    const double pz = g.corner[5][i] - az;
    const double qx = g.corner[6][i] - ax;
    const double qy = g.corner[7][i] - ay;
    const double qz = g.corner[8][i] - az;
    const double nx = py * qz - pz * qy;
    const double ny = pz * qx - px * qz;
    const double nz = px * qy - py * qx;
    const double den =
        nx * p.exact_direction[0][i] + ny * p.exact_direction[1][i] + nz * p.exact_direction[2][i];
    const double num = nx * (ax - p.exact_origin[0][i]) + ny * (ay - p.exact_origin[1][i]) +
                       nz * (az - p.exact_origin[2][i]);
    const auto fx = static_cast<float>(nx);
    const auto fy = static_cast<float>(ny);
    const auto fz = static_cast<float>(nz);
    const float inverse = 1.0F / std::sqrt(fx * fx + fy * fy + fz * fz);
    range_m[i] = static_cast<float>(num / den);
    normal[0][i] = fx * inverse;
    normal[1][i] = fy * inverse;
    normal[2][i] = fz * inverse;
  }
}

/// The caster with one kernel.
class Caster {
 public:
  Caster(const rays::MeshTree& tree, const rays::Kernel& kernel, const RayList& list)
      : tree_(tree), kernel_(kernel), list_(list) {
    hits_.resize(list.rays.size());
  }

  void cast() {
    const rays::TreeView view = tree_.view();
    for (std::size_t first = 0; first < list_.rays.size(); first += rays::kPacketSize) {
      for (unsigned i = 0; i < rays::kPacketSize; ++i) {
        const RayList::Ray& ray = list_.rays[first + i];
        rays::set_ray(packet_, i, ray.origin, ray.direction);
      }
      kernel_.start(packet_, tree_.sphere, 0xFFFF);
      if (list_.is_coherent) {
        kernel_.trace(view, packet_);
      } else {
        kernel_.trace_single(view, packet_);
      }
      store(first);
    }
  }

 private:
  void store(std::size_t first) {
    gather(tree_.blocks.data(), packet_, gathered_);
    measure(packet_, gathered_, hits_.range_m.data() + first, normal_);
    for (unsigned i = 0; i < rays::kPacketSize; ++i) {
      hits_.normal[first + i] = {normal_[0][i], normal_[1][i], normal_[2][i]};
      hits_.primitive[first + i] = rays::primitive_of(tree_.blocks.data(), packet_, i);
      hits_.instance[first + i] = packet_.slot[i] == rays::kNoTriangle ? rays::kNoTriangle : 0;
    }
  }

  const rays::MeshTree& tree_;
  const rays::Kernel& kernel_;
  const RayList& list_;
  rays::RayPacket packet_;
  Gathered gathered_;
  alignas(64) float normal_[3][rays::kPacketSize];
  HitList hits_;
};

double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// A benchmark of caster->cast() in processor time, which other work on the machine hardly affects.
template <class Cast>
void add(const std::string& name, const std::shared_ptr<Cast>& caster, std::size_t count) {
  benchmark::RegisterBenchmark(name.c_str(), [caster, count](benchmark::State& state) {
    for (auto _ : state) {
      const double begin = thread_seconds();
      caster->cast();
      state.SetIterationTime(thread_seconds() - begin);
    }
    state.counters["rays/s"] =
        benchmark::Counter(static_cast<double>(state.iterations()) * static_cast<double>(count),
                           benchmark::Counter::kIsRate);
  })->UseManualTime();
}

struct Stage {
  std::string name;
  Mesh mesh;
  rays::MeshTree tree;
  RayList camera;
  RayList random;
};

rays::MeshTree build(const Mesh& mesh, unsigned threads) {
  ThreadPool thread_pool(threads);
  return rays::build_mesh_tree({mesh.positions_m, mesh.triangles}, {}, thread_pool);
}

std::unique_ptr<Stage> make_stage(const std::string& name, const std::string& model) {
  auto stage = std::make_unique<Stage>();
  stage->name = name;
  stage->mesh = load_model(model, {}, {}).mesh;
  stage->tree = build(stage->mesh, 2);
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3f& p : stage->mesh.positions_m) box.extend(p.cast<double>());
  stage->camera = camera_rays(box);
  stage->random = random_rays(box);
  const auto count = static_cast<double>(stage->mesh.triangles.size());
  std::printf("%s: %.0f triangles, %.1f bytes per triangle, %.2f triangles per cluster\n",
              name.c_str(), count, static_cast<double>(stage->tree.bytes()) / count,
              count / static_cast<double>(stage->tree.clusters.size()));
  return stage;
}

/// Compares every kernel with the faster of two ways to use Embree with the same instruction set.
void add_rays(const Stage& stage, const RayList& list, const std::string& kind,
              std::vector<Ratio>& ratios) {
  const std::vector<unsigned> sizes = list.is_coherent ? std::vector{16U, 8U} : std::vector{1U, 8U};
  for (const rays::Kernel* kernel : rays::usable_kernels()) {
    const std::string name = kernel->name;
    std::string at = stage.name;
    at.append(" ").append(kind).append(" ").append(name);
    const std::string isa = name == "baseline" ? "sse2" : name;
    for (const unsigned size : sizes) {
      const std::string packets = "raw" + std::to_string(size);
      std::string raw = at;
      raw += " " + packets;
      add(raw, std::make_shared<RawRays>(stage.mesh, list, size, isa), list.rays.size());
      std::string what = at;
      what += " / " + packets;
      ratios.push_back({what, raw, at, list.is_coherent ? 1.15 : 0.65});
    }
    add(at, std::make_shared<Caster>(stage.tree, *kernel, list), list.rays.size());
  }
}

void add_build(const Stage& stage) {
  for (const unsigned threads : {1U, 2U}) {
    const std::string name = stage.name + " build " + std::to_string(threads) + " threads";
    benchmark::RegisterBenchmark(name.c_str(),
                                 [&stage, threads](benchmark::State& state) {
                                   for (auto _ : state)
                                     benchmark::DoNotOptimize(build(stage.mesh, threads));
                                 })
        ->UseRealTime()
        ->Unit(benchmark::kMillisecond);
  }
}

}  // namespace
}  // namespace glidar::bench

int main(int argc, char** argv) {
  using glidar::bench::make_stage;
  const char* data = std::getenv("GLIDAR_DATA");
  std::vector<std::unique_ptr<glidar::bench::Stage>> stages;
  if (data != nullptr) {
    const std::string stanford = std::string(data) + "/models/stanford/";
    stages.push_back(make_stage("bunny", stanford + "bun_zipper.ply"));
    stages.push_back(make_stage("dragon", stanford + "dragon/dragon_vrip_binary.ply"));
  } else {
    std::puts("GLIDAR_DATA is not set: the built-in asteroid replaces the Stanford models");
    stages.push_back(make_stage("asteroid", "builtin:asteroid"));
  }
  std::vector<glidar::bench::Ratio> ratios;
  for (const auto& stage : stages) {
    glidar::bench::add_rays(*stage, stage->camera, "camera", ratios);
    glidar::bench::add_rays(*stage, stage->random, "random", ratios);
    glidar::bench::add_build(*stage);
  }
  return glidar::bench::run(argc, argv, ratios);
}
