// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/imu_outputs.hpp>

#include <apps/glidar/run/printing.hpp>
#include <glidar/core/error.hpp>
#include <glidar/io/formats/imu_samples_file.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace glidar::app {
namespace {

ImuRun run_of(const RenderFlags& flags, const PreparedScene& prepared, std::size_t imu) {
  return {.seed = flags.seed,
          .imu = static_cast<std::uint32_t>(imu),
          .start_ns = prepared.start_ns,
          .gravity_m_s2 = prepared.gravity_m_s2};
}

}  // namespace

std::int64_t imu_end_ns(const PreparedScene& prepared) {
  std::int64_t end = std::llround(prepared.duration_s.value_or(0.0) * 1e9);
  for (const ActiveSensor& active : prepared.sensors) {
    end = std::max(end, frame_interval(active.sensor, active.frames - 1).end_ns);
  }
  return prepared.start_ns + end;
}

namespace {

std::string labelled(const std::string& path, const std::string& label) {
  std::string result = path;
  constexpr std::size_t kSuffix = 8;  // of .imu.csv and .imu.npz
  result.insert(result.size() - kSuffix, "_" + label);
  return result;
}

void print_samples(const RenderFlags& flags, const RigImu& imu, std::size_t samples,
                   const std::string& file) {
  if (flags.quiet) return;
  print(writes_standard_output(flags.output) ? stderr : stdout, "{} samples of {}\nwrote {}\n",
        samples, imu.imu.name, file);
}

}  // namespace

void check_imu_outputs(const RenderFlags& flags) {
  if (flags.output.imu_paths.empty() || is_sequence(flags)) return;
  throw Error({"--output, " + flags.output.imu_paths.front(), "samples of IMUs without a duration",
               "this output with --duration", "add --duration 1, for example"});
}

RigImuSampler imu_sampler(const RenderFlags& flags, const PreparedScene& prepared) {
  struct MountedImu {
    Imu imu;
    Trajectory world_from_imu;
    ImuRun run;
  };
  std::vector<MountedImu> imus;
  for (std::size_t i = 0; i < prepared.imus.size(); ++i) {
    const RigImu& on_rig = prepared.imus[i];
    imus.push_back({on_rig.imu,
                    compose_extrinsic(prepared.motion.world_from_rig, on_rig.rig_from_imu),
                    run_of(flags, prepared, i)});
  }
  return [imus = std::move(imus)](std::size_t imu, std::int64_t from_ns, std::int64_t until_ns) {
    const MountedImu& mounted = imus.at(imu);
    return simulate_imu(mounted.imu, mounted.world_from_imu, mounted.run, from_ns, until_ns);
  };
}

void check_imus(const RenderFlags& flags, const PreparedScene& prepared) {
  if (!flags.output.imu_paths.empty() && prepared.imus.empty()) {
    throw Error({"--output, " + flags.output.imu_paths.front(), "there is no IMU",
                 "a scene file with 'imus', or --imu", "add --imu BMI088, for example"});
  }
}

void write_imu_outputs(const RenderFlags& flags, const PreparedScene& prepared, std::int64_t end_ns,
                       Console& console, std::vector<std::filesystem::path>& written) {
  if (flags.output.imu_paths.empty()) return;
  check_imus(flags, prepared);
  warn_linear_interpolation(prepared.motion.world_from_rig, prepared.imus.front().name,
                            console.report());
  const RigImuSampler sample = imu_sampler(flags, prepared);
  for (std::size_t i = 0; i < prepared.imus.size(); ++i) {
    const RigImu& on_rig = prepared.imus[i];
    const ImuSamples samples = sample(i, prepared.start_ns, end_ns + 1);
    const ImuDescription description{.name = on_rig.name,
                                     .imu = on_rig.imu,
                                     .run = run_of(flags, prepared, i),
                                     .rig_from_imu = on_rig.rig_from_imu};
    for (const std::string& path : flags.output.imu_paths) {
      const std::string file = prepared.imus.size() > 1 ? labelled(path, on_rig.name) : path;
      write_imu_samples(samples, description, file, prepared.files);
      written.emplace_back(file);
      print_samples(flags, on_rig, samples.t_ns.size(), file);
    }
  }
}

}  // namespace glidar::app
