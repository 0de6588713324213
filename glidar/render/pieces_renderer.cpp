// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/pieces_renderer.hpp>

#include <glidar/core/mesh.hpp>

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace glidar {
namespace {

/// A scene with one instance per piece of every instance.
class PiecesScene {
 public:
  explicit PiecesScene(const Scene& whole) : whole_(whole) {
    validate(whole);
    scene_.materials = whole.materials;
    scene_.textures = whole.textures;
    scene_.class_names = whole.class_names;
    for (std::size_t i = 0; i < whole.meshes.size(); ++i) add(whole.meshes[i], whole.sources[i]);
    for (std::uint32_t i = 0; i < whole.instances.size(); ++i) place(whole.instances[i], i);
  }

  [[nodiscard]] const Scene& scene() const { return scene_; }
  [[nodiscard]] const Scene& whole() const { return whole_; }

  /// Per-instance arrays of a request, one entry per piece.
  struct Arrays {
    std::vector<Pose> poses;
    std::vector<std::uint8_t> instance_enabled;
    std::vector<InstanceRange> targets;  ///< per beam
  };

  /// The request for the pieces. Throws Error unless it fits the whole scene.
  [[nodiscard]] CastRequest for_pieces(const CastRequest& request, Arrays& arrays) const {
    check(request, whole_);
    arrays.poses.clear();
    arrays.instance_enabled.clear();
    arrays.targets.clear();
    for (const std::uint32_t instance : instance_of_) {
      arrays.poses.push_back(request.world_from_instance.empty()
                                 ? whole_.instances[instance].world_from_object
                                 : request.world_from_instance[instance]);
      if (!request.instance_enabled.empty())
        arrays.instance_enabled.push_back(request.instance_enabled[instance]);
    }
    for (const InstanceRange& target : request.targets) {
      arrays.targets.push_back({first_piece_[target.begin], first_piece_[target.end]});
    }
    CastRequest pieces = request;
    pieces.world_from_instance = arrays.poses;
    pieces.instance_enabled = arrays.instance_enabled;
    pieces.targets = arrays.targets;
    pieces.needed_of_others = {};  // hits have the ids of pieces while they are cast
    return pieces;
  }

  /// Replaces pieces and their triangles by those of the whole scene.
  void rename(BeamRange range, Hits& hits) const {
    for (std::size_t i = range.begin; i < range.end; ++i) {
      const std::uint32_t piece = hits.instance[i];
      if (piece == kInvalidId) continue;
      const std::vector<std::uint32_t>& triangles = triangles_[scene_.instances[piece].mesh];
      if (!triangles.empty()) hits.primitive[i] = triangles[hits.primitive[i]];
      hits.instance[i] = instance_of_[piece];
    }
  }

 private:
  void add(const Mesh& mesh, const MeshSource& source) {
    std::vector<std::uint32_t>& pieces = pieces_of_mesh_.emplace_back();
    const auto add_piece = [&](Mesh piece, std::vector<std::uint32_t> triangles) {
      pieces.push_back(static_cast<std::uint32_t>(scene_.meshes.size()));
      scene_.meshes.push_back(std::move(piece));
      scene_.sources.push_back(source);
      triangles_.push_back(std::move(triangles));
    };
    if (mesh.origins.empty()) return add_piece(mesh, {});
    for (MeshPiece& piece : cut_at_origins(mesh)) {
      add_piece(std::move(piece.mesh), std::move(piece.triangles));
    }
  }

  void place(const Instance& instance, std::uint32_t index) {
    for (const std::uint32_t mesh : pieces_of_mesh_[instance.mesh]) {
      scene_.instances.push_back(instance);
      scene_.instances.back().mesh = mesh;
      instance_of_.push_back(index);
    }
    first_piece_.push_back(static_cast<std::uint32_t>(instance_of_.size()));
  }

  const Scene& whole_;
  Scene scene_;
  std::vector<std::vector<std::uint32_t>> pieces_of_mesh_;
  std::vector<std::vector<std::uint32_t>> triangles_;  ///< per piece; empty: as in the mesh
  std::vector<std::uint32_t> instance_of_;             ///< per piece that is placed
  std::vector<std::uint32_t> first_piece_ = {0};       ///< per instance, and the end of the last
};

class PiecesRenderer final : public Renderer {
 public:
  PiecesRenderer(const Scene& scene, const MakeRenderer& make)
      : pieces_(scene), renderer_(make(pieces_.scene())) {}

  [[nodiscard]] std::string_view name() const override { return renderer_->name(); }
  [[nodiscard]] ThreadPool& thread_pool() override { return renderer_->thread_pool(); }

  void cast(const CastRequest& request, Hits& hits) override {
    Hits* const one = &hits;
    cast_batch({&request, 1}, {&one, 1});
  }

  void cast_batch(std::span<const CastRequest> requests, std::span<Hits* const> hits) override {
    check_batch(requests, hits);
    if (arrays_.size() < requests.size()) arrays_.resize(requests.size());
    renamings_.clear();
    renamings_.reserve(requests.size());  // references to them are handed out: they must not move
    requests_.clear();
    requests_.reserve(requests.size());
    for (std::size_t i = 0; i < requests.size(); ++i) {
      const Renaming& renaming = renamings_.emplace_back(Renaming{pieces_, *hits[i], requests[i]});
      requests_.push_back(pieces_.for_pieces(requests[i], arrays_[i]));
      requests_.back().on_tile_done = FunctionRef<void(BeamRange)>(renaming);
    }
    renderer_->cast_batch(requests_, hits);
  }

 private:
  /// Renames what a run of beams hit before anybody else sees it.
  struct Renaming {
    const PiecesScene& pieces;
    Hits& hits;
    const CastRequest& request;
    void operator()(BeamRange range) const {
      pieces.rename(range, hits);
      if (request.on_tile_done) request.on_tile_done(range);
    }
  };

  PiecesScene pieces_;
  std::unique_ptr<Renderer> renderer_;
  // Kept, so that a later cast allocates nothing.
  std::vector<PiecesScene::Arrays> arrays_;
  std::vector<Renaming> renamings_;
  std::vector<CastRequest> requests_;
};

class PiecesCamera final : public Woods2016Camera {
 public:
  PiecesCamera(const Scene& scene, const MakeWoods2016Camera& make)
      : pieces_(scene), camera_(make(pieces_.scene())) {}

  void draw(const CastRequest& request, const PhongHeadlight& light,
            const std::optional<Woods2016DepthPlanes>& planes,
            Woods2016Framebuffer& framebuffer) override {
    camera_->draw(pieces_.for_pieces(request, arrays_), light, planes, framebuffer);
  }

 private:
  PiecesScene pieces_;
  std::unique_ptr<Woods2016Camera> camera_;
  PiecesScene::Arrays arrays_;
};

}  // namespace

bool has_pieces(const Scene& scene) {
  return std::any_of(scene.meshes.begin(), scene.meshes.end(),
                     [](const Mesh& mesh) { return !mesh.origins.empty(); });
}

std::unique_ptr<Renderer> make_pieces_renderer(const Scene& scene, const MakeRenderer& make) {
  return std::make_unique<PiecesRenderer>(scene, make);
}

std::unique_ptr<Woods2016Camera> make_pieces_camera(const Scene& scene,
                                                    const MakeWoods2016Camera& make) {
  return std::make_unique<PiecesCamera>(scene, make);
}

}  // namespace glidar
