// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/ros/point_order.hpp>

#include <glidar/io/packets/hesai_packet.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>
#include <variant>

namespace glidar::ros {

std::size_t columns_per_packet(const Sensor& sensor, const Beams& beams) {
  constexpr std::size_t kPacketPoints = 384;  // of all models of Velodyne
  if (const HesaiModel* model = find_hesai_model(sensor))
    return model->blocks / std::max<std::size_t>(1, beams.returns);
  return std::max<std::size_t>(1, kPacketPoints / std::max<std::size_t>(1, beams.rows));
}

std::int64_t packet_time_offset_ns(const Sensor& sensor, const Beams& beams) {
  const HesaiModel* model = find_hesai_model(sensor);
  const auto* spinning = std::get_if<Spinning>(&sensor.optics);
  if (model == nullptr || spinning == nullptr || spinning->channels.empty()) return 0;
  const auto earliest = std::min_element(
      spinning->channels.begin(), spinning->channels.end(),
      [](const auto& a, const auto& b) { return a.fire_time_ns < b.fire_time_ns; });
  const double start_ns = sequence_start_ns(*model, 0, columns_per_packet(sensor, beams));
  return -std::llround(start_ns + earliest->fire_time_ns);
}

std::vector<std::size_t> row_shifts(const Sensor& sensor, const Beams& beams) {
  std::vector<std::size_t> shifts(beams.rows, 0);
  const auto* spinning = std::get_if<Spinning>(&sensor.optics);
  if (spinning == nullptr || spinning->columns_per_turn != beams.cols) return shifts;
  const auto columns = static_cast<long>(beams.cols);
  std::vector<const SpinningChannel*> by_row;
  for (const SpinningChannel& channel : spinning->channels) by_row.push_back(&channel);
  std::stable_sort(by_row.begin(), by_row.end(), [](const auto* a, const auto* b) {
    return a->elevation_rad > b->elevation_rad;
  });
  for (std::size_t row = 0; row < shifts.size(); ++row) {
    const SpinningChannel& channel = *by_row[row % by_row.size()];
    const double turns = -channel.azimuth_offset_rad / (2.0 * std::numbers::pi);
    const long shift = std::lround(turns * static_cast<double>(columns));
    shifts[row] = static_cast<std::size_t>((shift % columns + columns) % columns);
  }
  return shifts;
}

std::vector<std::uint32_t> ordered_entries(const Sensor& sensor, const Beams& beams,
                                           PointOrder order) {
  std::vector<std::uint32_t> entries;
  entries.reserve(beams.size());
  const auto entry = [&](std::size_t row, std::size_t col) {
    entries.push_back(static_cast<std::uint32_t>(row * beams.cols + col));
  };
  if (order == PointOrder::destaggered) {
    const std::vector<std::size_t> shifts = row_shifts(sensor, beams);
    for (std::size_t row = 0; row < beams.rows; ++row)
      for (std::size_t col = 0; col < beams.cols; ++col)
        entry(row, (col + beams.cols - shifts[row]) % beams.cols);
    return entries;
  }
  std::vector<std::size_t> rows(beams.rows);
  std::iota(rows.begin(), rows.end(), std::size_t{0});
  const std::size_t channels = beams.rows / beams.returns;
  if (order == PointOrder::rings) {
    std::stable_sort(rows.begin(), rows.end(), [&](std::size_t a, std::size_t b) {
      return std::pair(a / channels, ring_of(beams, a * beams.cols)) <
             std::pair(b / channels, ring_of(beams, b * beams.cols));
    });
  }
  for (std::size_t col = 0; col < beams.cols; ++col)
    for (const std::size_t row : rows) entry(row, col);
  return entries;
}

}  // namespace glidar::ros
