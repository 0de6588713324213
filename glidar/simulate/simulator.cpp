// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/simulate/simulator.hpp>

#include <glidar/core/error.hpp>
#include <glidar/simulate/mirrors.hpp>
#include <glidar/simulate/object_boxes.hpp>
#include <glidar/simulate/simulate.hpp>

#include <algorithm>
#include <deque>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace glidar {

struct Simulator::State {
  const Scene& scene;
  std::shared_ptr<const BeamCache> beam_cache;
  Renderer& renderer;
  PreparedSensor prepared;
  bool restricts_visibility = false;  ///< some instance is not seen by all sensors
  /// For frames whose sensor sees no mirror of the scene; empty: `prepared` is.
  std::optional<PreparedSensor> prepared_without_mirrors = {};
  std::unique_ptr<Renderer> own_renderer = {};  ///< empty: shared
  ReturnReplacement replace_returns = {};
  BoxedClasses boxed_classes = {};
  std::deque<Workspace> workspaces = {};  ///< of frames that are simulated together
};

namespace {

void require_motions(std::size_t motions, std::size_t frames) {
  if (motions == frames) return;
  throw Error(
      {.where = "batch",
       .found = std::to_string(motions) + " motions for " + std::to_string(frames) + " frames",
       .allowed = "one motion per frame",
       .remedy = ""});
}

bool has_hidden_instances(const Scene& scene) {
  return std::any_of(scene.instances.begin(), scene.instances.end(), [](const Instance& instance) {
    return !instance.visible_to.empty() || !instance.hidden_from.empty();
  });
}

}  // namespace

Simulator::Simulator(const Scene& scene, const std::shared_ptr<const BeamCache>& beam_cache,
                     Renderer& renderer)
    : state_(std::make_unique<State>(
          State{.scene = scene,
                .beam_cache = beam_cache,
                .renderer = renderer,
                .prepared = prepare_sensor(beam_cache->sensor(), has_mirrors(scene)),
                .restricts_visibility = has_hidden_instances(scene)})) {
  const std::optional<PulseModel>& pulses = state_->prepared.pulse_model;
  if (state_->restricts_visibility && pulses && pulses->has_mirrors) {
    state_->prepared_without_mirrors.emplace(prepare_sensor(beam_cache->sensor(), false));
  }
}

Simulator::Simulator(const Scene& scene, Sensor sensor, Renderer& renderer)
    : Simulator(scene, std::make_shared<const BeamCache>(std::move(sensor)), renderer) {}

Simulator::Simulator(const Scene& scene, Sensor sensor, std::unique_ptr<Renderer> renderer)
    : Simulator(scene, std::move(sensor), *renderer) {
  state_->own_renderer = std::move(renderer);
}

Simulator::Simulator(const Scene& scene, Sensor sensor, const RendererOptions& options)
    : Simulator(scene, std::move(sensor), make_renderer(scene, options)) {}

Simulator::Simulator(Simulator&&) noexcept = default;
Simulator& Simulator::operator=(Simulator&&) noexcept = default;
Simulator::~Simulator() = default;

Frame Simulator::simulate(const Pose& world_from_sensor, const HitColumnMask& hit_columns,
                          std::uint64_t seed) {
  Frame frame;
  frame.seed = seed;
  simulate(static_motion(state_->scene, world_from_sensor), hit_columns, frame);
  return frame;
}

void Simulator::simulate(const Motion& motion, const HitColumnMask& hit_columns, Frame& frame,
                         const ProgressCallback& progress) {
  const std::shared_ptr<const Beams> beams = state_->beam_cache->beams(frame.number);
  Simulation simulation = prepare(*beams, motion, hit_columns, frame, progress);
  glidar::simulate({&simulation, 1});
}

void Simulator::simulate_batch(std::span<const Motion> motions, const HitColumnMask& hit_columns,
                               std::span<Frame> frames, const ProgressCallback& progress) {
  require_motions(motions.size(), frames.size());
  std::vector<std::shared_ptr<const Beams>> beams;
  std::vector<Simulation> together;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    beams.push_back(state_->beam_cache->beams(frames[i].number));
    Simulation one =
        prepare(*beams.back(), motions[i], hit_columns, frames[i], progress, together.size());
    if (takes_one_cast(one)) {
      together.push_back(one);
    } else {
      glidar::simulate({&one, 1});
    }
  }
  if (!together.empty()) glidar::simulate(together);
}

std::vector<ObjectBox> Simulator::find_boxes(const Motion& motion, Frame& frame,
                                             BoxSelection selection) {
  const std::shared_ptr<const Beams> beams = state_->beam_cache->beams(frame.number);
  std::vector<ObjectBox> boxes;
  glidar::find_boxes(prepare(*beams, motion, {}, frame, {}), selection, boxes);
  return boxes;
}

Simulation Simulator::prepare(const Beams& beams, const Motion& motion,
                              const HitColumnMask& hit_columns, Frame& frame,
                              const ProgressCallback& progress, std::size_t slot) {
  State& state = *state_;
  while (state.workspaces.size() <= slot) state.workspaces.emplace_back();
  state.workspaces[slot].boxes.classes = state.boxed_classes;
  std::vector<std::uint8_t>& visible = state.workspaces[slot].visible;
  visible.clear();
  for (std::size_t i = 0; state.restricts_visibility && i < state.scene.instances.size(); ++i) {
    visible.push_back(
        static_cast<std::uint8_t>(is_visible(state.scene.instances[i], frame.sensor_id)));
  }
  const bool lacks_mirrors = state.prepared_without_mirrors && !has_mirrors(state.scene, visible);
  return {.scene = state.scene,
          .prepared = lacks_mirrors ? *state.prepared_without_mirrors : state.prepared,
          .renderer = state.renderer,
          .beams = beams,
          .motion = motion,
          .hit_columns = hit_columns | state.prepared.required_hit_columns,
          .workspace = state.workspaces[slot],
          .frame = frame,
          .progress = progress,
          .replace_returns = state.replace_returns,
          .instance_enabled = visible};
}

void Simulator::set_boxed_classes(BoxedClasses classes) {
  const std::size_t count = state_->scene.class_names.size();
  if (!classes.empty() && classes.size() != count) {
    throw Error({"classes with boxes", std::to_string(classes.size()) + " values",
                 std::to_string(count) + ", one for each class of the scene",
                 "make them with boxed_classes()"});
  }
  state_->boxed_classes = std::move(classes);
}

void Simulator::set_return_replacement(ReturnReplacement replacement) {
  state_->replace_returns = std::move(replacement);
}

const Scene& Simulator::scene() const {
  return state_->scene;
}

const Sensor& Simulator::sensor() const {
  return state_->beam_cache->sensor();
}

Renderer& Simulator::renderer() const {
  return state_->renderer;
}

std::shared_ptr<const Beams> Simulator::beams(std::uint32_t frame) const {
  return state_->beam_cache->beams(frame);
}

}  // namespace glidar
