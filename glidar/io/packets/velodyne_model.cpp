// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/packets/velodyne_model.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/packets/firing_sequence.hpp>
#include <glidar/io/packets/velodyne_packet.hpp>

#include <array>
#include <cmath>
#include <span>
#include <string>

namespace glidar {
namespace {

// VLP-16 User Manual 63-9243, 9.3.2: 2.304 us from laser to laser.
double vlp16_time_ns(std::size_t laser, bool /*is_dual*/) {
  return 2304.0 * static_cast<double>(laser);
}

// VLP-32C User Manual 63-9325: two lasers at once.
double vlp32_time_ns(std::size_t laser, bool /*is_dual*/) {
  const std::size_t pair = laser / 2;
  return 2304.0 * static_cast<double>(pair);
}

// HDL-32E Application Note 63-9277: 1.152 us from laser to laser.
double hdl32_time_ns(std::size_t laser, bool /*is_dual*/) {
  return 1152.0 * static_cast<double>(laser);
}

// HDL-64E S2 and S3 User's Manuals, laser firing time tables: groups of four, both blocks at once.
double hdl64_time_ns(std::size_t laser, bool is_dual) {
  constexpr std::array<double, 4> kSingle_ns = {0.0, 1260.0, 2460.0, 3660.0};
  constexpr std::array<double, 4> kDual_ns = {0.0, 1300.0, 2500.0, 3700.0};
  const std::size_t group = laser % 32 / 4;
  const auto groups = static_cast<double>(group);
  return is_dual ? 7200.0 * groups + kDual_ns[laser % 4] : 6000.0 * groups + kSingle_ns[laser % 4];
}

// VLS-128 User Manual 63-9483, 9.3.1: eight lasers at once, an empty slot after the eighth group.
double vls128_time_ns(std::size_t laser, bool /*is_dual*/) {
  const std::size_t slot = laser / 8 + laser / 64;
  return 2665.0 * static_cast<double>(slot);
}

// Factory bytes: VLP-16 User Manual 63-9243, 9.3.1.7, and those of the other models. HDL-64E: its
// last two bytes are a status (63-HDL64ES3, appendix E). VLS-128: the time is that of the fourth
// group, 7 us after the first.
constexpr std::array<VelodyneModel, 6> kVelodyneModels = {{
    {"VLP-16", 16, 0.002, 55296.0, 55296.0, vlp16_time_ns, 0x22, 0.0},
    {"Puck Hi-Res", 16, 0.002, 55296.0, 55296.0, vlp16_time_ns, 0x24, 0.0},
    {"VLP-32C", 32, 0.004, 55296.0, 55296.0, vlp32_time_ns, 0x28, 0.0},
    {"HDL-32E", 32, 0.002, 46080.0, 46080.0, hdl32_time_ns, 0x21, 0.0},
    {"HDL-64E S3", 64, 0.002, 48000.0, 57600.0, hdl64_time_ns, 0, 0.0},
    {"VLS-128", 128, 0.004, 53300.0, 53300.0, vls128_time_ns, 0xA1, 7000.0},
}};

constexpr double kTimeTolerance_ns = 2.0;

[[noreturn]] void fail(const Sensor& sensor, std::string found, std::string allowed) {
  throw Error({"Velodyne packets of " + sensor.name, std::move(found), std::move(allowed),
               "use the preset of the model, or write clouds"});
}

void check_firings(const Sensor& sensor, const VelodyneLayout& layout) {
  const Spinning& spinning = spinning_optics(sensor, "Velodyne packets");
  const std::string model(layout.model.name);
  if (spinning.channels.size() != layout.model.lasers)
    fail(sensor, std::to_string(spinning.channels.size()) + " channels",
         std::to_string(layout.model.lasers) + ", as the " + model);
  if (spinning.rotation_direction != Spinning::RotationDirection::clockwise)
    fail(sensor, "counterclockwise rotation", "clockwise, as the " + model);
  if (std::abs(sequence_period_ns(spinning) - layout.period_ns()) > kTimeTolerance_ns)
    fail(sensor, "firing_period_us: " + number_text(sequence_period_ns(spinning) * 1e-3),
         number_text(layout.period_ns() * 1e-3) + ", as the " + model +
             (layout.is_dual() ? " with two returns" : ""));
  for (std::size_t laser = 0; laser < layout.model.lasers; ++laser) {
    const double fires_ns = layout.model.fire_time_ns(laser, layout.is_dual());
    const double found_ns = spinning.channels[laser].fire_time_ns;
    if (std::abs(found_ns - fires_ns) <= kTimeTolerance_ns) continue;
    fail(sensor, "fire_time_us[" + std::to_string(laser) + "]: " + number_text(found_ns * 1e-3),
         number_text(fires_ns * 1e-3) + ", as the " + model +
             (layout.is_dual() ? " with two returns" : ""));
  }
}

}  // namespace

const VelodyneModel* find_velodyne_model(const Sensor& sensor) {
  for (const VelodyneModel& model : kVelodyneModels)
    if (sensor.name.find(model.name) != std::string::npos) return &model;
  return nullptr;
}

VelodyneLayout velodyne_layout(const Sensor& sensor) {
  const VelodyneModel* model = find_velodyne_model(sensor);
  if (model == nullptr)
    fail(sensor, "no Velodyne model of this name",
         "VLP-16, Puck Hi-Res, VLP-32C, HDL-32E, HDL-64E S3, VLS-128");
  VelodyneLayout layout{
      .model = *model,
      .returns = select_packet_returns(sensor, "Velodyne packets of " + sensor.name)};
  check_firings(sensor, layout);
  const std::size_t points = kVelodyneBlocks * kVelodyneBlockPoints / (layout.is_dual() ? 2 : 1);
  layout.sequences = points / model->lasers;  // VLS-128, two returns: one, a third is empty
  return layout;
}

VelodyneSlot velodyne_slot(const VelodyneLayout& layout, std::size_t sequence, std::size_t laser,
                           bool is_last) {
  const std::size_t index = sequence * layout.model.lasers + laser;
  const std::size_t block = index / kVelodyneBlockPoints;
  const std::size_t point = index % kVelodyneBlockPoints;
  if (!layout.is_dual()) return {block, point};
  // HDL-64E: both banks of the strongest return, then both of the last (63-HDL64ES3, appendix E);
  // the others: a block of the last return, then the same of the strongest (63-9243, 9.3.3)
  if (layout.model.lasers == 64) return {4 * (block / 2) + block % 2 + (is_last ? 2U : 0U), point};
  return {2 * block + (is_last ? 0U : 1U), point};
}

std::size_t velodyne_bank(const VelodyneLayout& layout, std::size_t block) {
  if (layout.model.lasers == 64) return block % 2;
  if (layout.model.lasers == 128) return layout.is_dual() ? block / 2 % 4 : block % 4;
  return 0;
}

}  // namespace glidar
