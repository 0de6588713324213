// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/sensor_keys.hpp>

#include <glidar/core/field_visitor.hpp>
#include <glidar/io/formats/grey_image_file.hpp>

namespace glidar {
namespace {

constexpr double kDefaultLidarRate_hz = 10.0;

bool is_camera(const Sensor& sensor) {
  return std::holds_alternative<Pinhole>(sensor.optics);
}

void visit_optics(SensorKeys& keys, FieldVisitor& visitor) {
  const auto optics = [&](FieldVisitor& nested) { describe(keys.optics, nested); };
  const bool is_required = !keys.has_table;
  const bool is_present = !(keys.has_table && visitor.is_document());
  if (visitor.is_reading() && keys.has_table) {
    if (visitor.has("optics")) {
      visitor.reject("optics", "given beside a table of beams", "one of the two",
                     "remove one of them");
    }
    return;
  }
  visitor.object({"optics", "the rays, see [optics](optics.md)", kNoUnit, is_required}, is_present,
                 FieldVisitor::Describe(optics));
  if (!visitor.is_reading()) return;
  OpticsSources sources = sources_of(keys.optics);
  keys.sensor.files = std::move(sources.files);
  keys.sensor.notes = std::move(sources.notes);
  keys.sensor.optics = optics_of(std::move(keys.optics));
}

/// Defaults that depend on the optics.
void set_defaults(Sensor& sensor) {
  if (is_camera(sensor)) return;
  sensor.name = "lidar";
  sensor.limits.along = Limits::Along::range;
  const auto* spinning = std::get_if<Spinning>(&sensor.optics);
  sensor.rate_hz = spinning != nullptr ? spinning->rotation_hz : kDefaultLidarRate_hz;
}

/// Runs a check of the sensor. Its error gets the place of a key in the file, and `in` after what
/// was found.
template <class Check>
void check_in_file(const FieldVisitor& visitor, const char* key, const char* in,
                   const Check& check) {
  if (!visitor.is_reading()) return;
  try {
    check();
  } catch (const Error& error) {
    const ErrorParts& parts = error.parts();
    visitor.reject(key, parts.found + in, parts.allowed, parts.remedy);
  }
}

void visit_scan(Sensor& sensor, FieldVisitor& visitor) {
  visitor.number(
      {"rate_hz", "frames per second; of a spinning sensor turns, of a line scanner scans",
       kUnitHertz, false, "30 for cameras, 10 for others, `ouster`: as in its metadata"},
      kAboveZero, sensor.rate_hz);
  check_in_file(visitor, "rate_hz", "", [&] { set_rate(sensor, sensor.rate_hz); });
  visitor.number({"wavelength_nm", "of the light", kUnitNanometre, false, "unknown"},
                 {100.0, 20000.0, false, "nanometres from 100 to 20000"}, sensor.wavelength_m);
  visit_object(visitor, {"limits", "distances that are reported"}, sensor.limits);
}

/// Continuous light, or pulses with what only they have.
void visit_light(Sensor& sensor, FieldVisitor& visitor) {
  visitor.at_most_one({{"lidar_equation", "light"}, "one of light, lidar_equation"});
  for (const char* key : {"footprint", "receiver"}) {
    visitor.needs({key, "lidar_equation", "together with lidar_equation",
                   "add lidar_equation, the range equation, which computes the received signal"});
  }
  const bool is_pulsed = sensor.lidar_equation.has_value();
  const auto light = [&](FieldVisitor& nested) { describe(sensor.light, nested); };
  visitor.object({"light", "Phong light source at the sensor"},
                 !(is_pulsed && visitor.is_document()), FieldVisitor::Describe(light));
  visit_object(visitor, {"lidar_equation", "pulsed light", kNoUnit, false, "none"},
               sensor.lidar_equation);
  visit_object(
      visitor,
      {"footprint", "cross-section of the beam", kNoUnit, false, "an infinitely thin beam"},
      sensor.footprint);
  const auto receiver = [&](FieldVisitor& nested) { describe(sensor.receiver, nested); };
  visitor.object({"receiver", "echoes of pulses"}, is_pulsed, FieldVisitor::Describe(receiver));
}

void visit_weather(Sensor& sensor, FieldVisitor& visitor) {
  visitor.needs({"weather", "lidar_equation", "weather for a sensor with pulsed light",
                 "add 'lidar_equation: ...'"});
  visit_object(visitor, {"weather", "fog, rain and snow", kNoUnit, false, "clear air"},
               sensor.weather);
  const bool is_foggy = sensor.weather && sensor.weather->visibility_m > 0.0;
  if (visitor.is_reading() && is_foggy && !(sensor.wavelength_m > 0.0)) {
    visitor.reject("weather",
                   "a visibility without 'wavelength_nm', on which fog's extinction depends",
                   "fog for light of a known wavelength", "add 'wavelength_nm: ...'");
  }
}

void visit_doppler(Sensor& sensor, FieldVisitor& visitor) {
  visit_object(visitor,
               {"doppler",
                "radial velocity of every return, see [Doppler](../doppler.md); `{}`: without "
                "errors",
                kNoUnit, false, "it is not measured"},
               sensor.doppler);
}

void visit_projector(Sensor& sensor, FieldVisitor& visitor) {
  visitor.at_most_one(
      {{"lidar_equation", "projector_origin_m"}, "a projector of continuous light"});
  Eigen::Vector3d origin_m = sensor.projector_origin_m.value_or(Eigen::Vector3d::Zero());
  const bool is_present =
      visitor.vector({"projector_origin_m", "origin of structured light in the sensor frame",
                      kUnitMetre, false, "none"},
                     {-1e3, 1e3, false, "metres from -1000 to 1000"},
                     sensor.projector_origin_m.has_value(), origin_m);
  if (visitor.is_reading() && is_present) sensor.projector_origin_m = origin_m;
}

/// Loads the picture of a projector.
void load_pattern(Sensor& sensor) {
  auto* stereo = std::get_if<ActiveStereo>(&*sensor.depth_camera);
  if (stereo == nullptr || stereo->projector.picture.empty()) return;
  stereo->projector.pattern = load_grey_image(stereo->projector.picture);
  sensor.files.push_back(stereo->projector.picture);
}

void visit_depth_camera(Sensor& sensor, FieldVisitor& visitor) {
  DepthModel model = sensor.depth_model;
  visit_depth_model(model, visitor);
  visit_object(visitor,
               {"depth_camera",
                "how raw images are measured and depths decoded from them, see "
                "[depth cameras](depth-cameras.md)",
                kNoUnit, false, "none"},
               sensor.depth_camera);
  if (!visitor.is_reading()) return;
  try {
    set_depth_model(model, "depth_model", sensor);
    check_depth_camera(sensor);
  } catch (const Error& error) {
    const ErrorParts& parts = error.parts();
    visitor.reject(visitor.has("depth_camera") ? "depth_camera" : "depth_model", parts.found,
                   parts.allowed, parts.remedy);
  }
  if (sensor.depth_camera) load_pattern(sensor);
}

/// Documents have what was reported when the sensor was read from other files.
void visit_notes(Sensor& sensor, FieldVisitor& visitor) {
  if (visitor.is_report()) return;
  visitor.texts(
      {"notes", "what the program reports when it loads the sensor", kNoUnit, false, "none"},
      sensor.notes);
}

/// Readers of files merge these keys before; only a map inside another file still has them.
void visit_family(FieldVisitor& visitor) {
  const auto visit = [&](const FieldInfo& field, FamilyKey key) {
    if (visitor.is_reading() && visitor.has(field.key)) {
      visitor.reject(field.key, "a family of sensors inside another file",
                     "a sensor file of its own", "write it to a file, and name the file here");
    }
    visitor.family(field, key);
  };
  visit({"variants", "[sensors of a family](sensor-families.md): overrides of the other keys"},
        FamilyKey::overrides);
  visit({"modes", "[settings of the sensor](sensor-families.md): overrides of the other keys"},
        FamilyKey::overrides);
  visit({"default_mode", "the mode that is used if none is chosen"}, FamilyKey::name);
  visit({"aliases", "further names of a preset"}, FamilyKey::names);
}

}  // namespace

SensorKeys sensor_keys(const Sensor& sensor) {
  SensorKeys keys = {.sensor = sensor,
                     .optics = optics_keys(sensor.optics),
                     .has_table = std::holds_alternative<RayTable>(sensor.optics)};
  keys.sensor.optics = {};  // a table can be large, and keys are copied
  return keys;
}

void describe(SensorKeys& keys, FieldVisitor& visitor) {
  Sensor& sensor = keys.sensor;
  if (!visitor.is_reading()) {
    visitor.text(
        {"name", "of the sensor", kNoUnit, false, "`depth camera` for cameras, else `lidar`"},
        sensor.name);
  }
  visit_optics(keys, visitor);
  if (visitor.is_reading()) {
    set_defaults(sensor);
    visitor.text({"name", ""}, sensor.name);
  }
  visit_scan(sensor, visitor);
  visit_light(sensor, visitor);
  check_in_file(visitor, "lidar_equation", " in channel_range_m",
                [&] { check_channel_ranges(sensor); });
  visit_weather(sensor, visitor);
  visit_projector(sensor, visitor);
  visit_doppler(sensor, visitor);
  visit_list(visitor,
             {"noise",
              "noise steps in the order in which the sensor applies them, see "
              "[noise](../noise.md)",
              kNoUnit, false, "none"},
             {0, kMaxNoiseSteps}, "at most 224 steps", sensor.noise);
  check_in_file(visitor, "doppler", "", [&] { check_doppler(sensor); });
  visit_depth_camera(sensor, visitor);
  visitor.boolean(
      {"cull_back_faces", "`true`: beams pass through triangles that are seen from behind"},
      sensor.cull_back_faces);
  visitor.provenance({"source", "where the numbers come from: text for keys of this file"}, true);
  visitor.provenance(
      {"unverified", "keys that were not checked against the manufacturer's documents"}, false);
  visit_notes(sensor, visitor);
  visit_family(visitor);
}

}  // namespace glidar
