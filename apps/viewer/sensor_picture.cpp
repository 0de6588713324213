// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/viewer/sensor_picture.hpp>

#include <cmath>
#include <limits>
#include <map>

namespace glidar::app {
namespace {

double value_of(const Frame& frame, const Beams& beams, Quantity quantity, std::size_t i) {
  if (frame.status[i] != Status::hit) return std::numeric_limits<double>::quiet_NaN();
  if (quantity == Quantity::intensity) return double{frame.intensity[i]};
  if (quantity == Quantity::depth) return depth_m(beams, i, frame.range_m[i]);
  return frame.range_m[i] + beams.range_offset_m;
}

void colour_by_scale(const Frame& frame, const Beams& beams, Quantity quantity, ColourMap map,
                     SensorPicture& picture) {
  const std::size_t size = frame.status.size();
  const bool is_near_bright = quantity != Quantity::intensity;
  std::vector<double> values;
  values.reserve(size);
  for (std::size_t i = 0; i < size; ++i) values.push_back(value_of(frame, beams, quantity, i));
  picture.scale =
      make_colour_scale(values, quantity == Quantity::intensity ? ColourScale::Start::zero
                                                                : ColourScale::Start::lowest);
  for (std::size_t i = 0; i < size; ++i) {
    if (!std::isfinite(values[i])) continue;
    const double t = picture.scale.fraction(values[i]);
    picture.colours[i] = colour_of(map, is_near_bright ? 1.0 - t : t);
  }
}

/// All returns, one below the other if they have the same width; else the first.
BeamPicture layout_of(const Frame& frame, const Beams& beams) {
  BeamPicture all = make_beam_picture(beams, frame.range_m);
  if (all.kind == BeamPicture::Kind::image) {
    all.rows = beams.rows;  // the beams are in this order already
    return all;
  }
  for (std::uint32_t k = 1; k < beams.returns; ++k) {
    const BeamPicture next = make_beam_picture(beams, frame.range_m, k);
    if (next.cols != all.cols) continue;
    all.beams.insert(all.beams.end(), next.beams.begin(), next.beams.end());
    all.rows += next.rows;
  }
  return all;
}

void colour_by_normal(const Frame& frame, const Beams& beams, SensorPicture& picture) {
  const SensorAxes axes = axes_of(beams);
  Eigen::Matrix3f seen_from_sensor;
  seen_from_sensor << -axes.left.cast<float>().transpose(), axes.up.cast<float>().transpose(),
      -axes.ahead.cast<float>().transpose();
  for (std::size_t i = 0; i < frame.status.size(); ++i) {
    const Eigen::Vector3f& normal = frame.ground_truth.normal[i];
    if (frame.status[i] != Status::hit || std::isnan(normal.x())) continue;
    const Eigen::Vector3f seen = 255.0F * (0.5F * (seen_from_sensor * normal).array() + 0.5F);
    picture.colours[i] = {static_cast<std::uint8_t>(seen.x()), static_cast<std::uint8_t>(seen.y()),
                          static_cast<std::uint8_t>(seen.z())};
  }
  picture.legend = {{{255, 127, 127}, "to the right"},
                    {{127, 255, 127}, "up"},
                    {{127, 127, 255}, "towards the sensor"}};
}

void colour_by_instance(const Frame& frame, const Scene& scene, SensorPicture& picture) {
  std::map<std::uint32_t, bool> seen;
  for (std::size_t i = 0; i < frame.status.size(); ++i) {
    const std::uint32_t instance = frame.ground_truth.instance[i];
    if (frame.status[i] != Status::hit || instance == kInvalidId) continue;
    picture.colours[i] = category_colour(instance);
    seen[instance] = true;
  }
  for (const auto& [instance, is_seen] : seen) {
    const Instance& it = scene.instances[instance];
    picture.legend.push_back(
        {category_colour(instance), it.name + " (id " + std::to_string(it.id) + ")"});
  }
}

void colour_by_status(const Frame& frame, SensorPicture& picture) {
  std::map<Status, std::size_t> counts;
  for (std::size_t i = 0; i < frame.status.size(); ++i) {
    picture.colours[i] = colour_of(frame.status[i]);
    ++counts[frame.status[i]];
  }
  for (const auto& [status, count] : counts) {
    picture.legend.push_back(
        {colour_of(status), std::string(name(status)) + ": " + std::to_string(count)});
  }
}

}  // namespace

bool has_scale(Quantity quantity) {
  return quantity == Quantity::depth || quantity == Quantity::range ||
         quantity == Quantity::intensity;
}

std::string_view unit_of(Quantity quantity) {
  return quantity == Quantity::depth || quantity == Quantity::range ? "m" : "";
}

Colour colour_of(Status status) {
  if (status == Status::hit) return {225, 225, 230};
  if (status == Status::miss) return kNoReturn;
  return category_colour(static_cast<std::uint32_t>(status));
}

void make_sensor_picture(const Frame& frame, const Beams& beams, const Scene& scene,
                         Quantity quantity, ColourMap map, SensorPicture& picture) {
  picture.colours.assign(frame.status.size(), kNoReturn);
  picture.legend.clear();
  picture.layout = layout_of(frame, beams);
  switch (quantity) {
    case Quantity::depth:
    case Quantity::range:
    case Quantity::intensity:
      return colour_by_scale(frame, beams, quantity, map, picture);
    case Quantity::normals:
      return colour_by_normal(frame, beams, picture);
    case Quantity::instance:
      return colour_by_instance(frame, scene, picture);
    case Quantity::status:
      return colour_by_status(frame, picture);
  }
}

}  // namespace glidar::app
